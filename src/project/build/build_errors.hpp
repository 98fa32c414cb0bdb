#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "project/build/generated_folder.hpp"
#include "project/build/transition_functions.hpp"
#include "project/verification/pipeline.hpp"

namespace tessera::project {

/// The facts that explain the errors of a build.
struct BuildContext {
  const Specification& specification;
  const TransitionFunctions& functions;
  const GeneratedLines& lines;
  std::filesystem::path log;  ///< where the whole output is; named in the text; in the folder of the build
};

/// Explains what compiler and linker have printed, in at most one screen: one message for each mistake, at the
/// line of the user's file or of the specification, with a hint.
///
/// Codes: E501 - E509 and E511 of docs/reference/diagnostics.md.
[[nodiscard]] std::string explain_build(std::string_view output, const BuildContext& context);

/// The same for a CMake that could not configure the build: E510.
[[nodiscard]] std::string explain_configuration(std::string_view output, const std::filesystem::path& log);

}  // namespace tessera::project
