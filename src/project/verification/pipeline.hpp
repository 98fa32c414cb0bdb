#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"
#include "net/property.hpp"
#include "project/process/listener.hpp"
#include "spec/model/model.hpp"
#include "verify/verify.hpp"

/// The way of the data: specification -> Model -> hierarchical net -> flat net -> verified net. Every stage
/// reports its messages to a listener.
namespace tessera::project {

/// A specification that was read without errors.
struct Specification {
  std::filesystem::path file;     ///< absolute
  std::filesystem::path project;  ///< its folder
  diagnostics::Diagnostics diagnostics;
  spec::Model model;
};

/// The file that `given` means: `given` itself, or the spec.yaml of a folder.
[[nodiscard]] std::filesystem::path spec_file(const std::filesystem::path& given);

/// given: a file, or a folder that holds spec.yaml. nullopt after its diagnostics have been reported.
[[nodiscard]] std::optional<Specification> read(const std::filesystem::path& given, Listener& listener);

/// Judges every communication model of the specification by itself. false: one is not
/// sound, which has been reported.
bool judge_models(const spec::Model& model, diagnostics::Diagnostics& out);
/// The same, with the diagnostics reported to the listener.
[[nodiscard]] bool models_are_sound(const Specification& specification, Listener& listener);

/// check_files (src/project/files/assets.hpp), with the diagnostics reported to the listener.
[[nodiscard]] bool files_are_there(const Specification& specification, Listener& listener);

struct Nets {
  net::HierarchicalNet pages;
  net::Net flat;
  std::vector<net::Property> properties;  ///< from the specification
};
/// Errors: those of layers::build, net::flatten and layers::properties; E106 a property of the
///         specification with the name of a default one. nullopt after an error.
[[nodiscard]] std::optional<Nets> build(const spec::Model& model, diagnostics::Diagnostics& out);
/// The same, with the diagnostics reported to the listener.
[[nodiscard]] std::optional<Nets> build(const Specification& specification, Listener& listener);

/// "holds", "violated", "unknown"
[[nodiscard]] const char* name_of(verify::Verdict verdict);

/// The conditions under which a net may be generated.
struct Gate {
  std::string timeout = "10s";     ///< for the verdicts
  bool accept_violations = false;  ///< a violated net may pass, too
};

/// Runs read, judge_models, build and verify. Only a net without violations passes, unless the gate accepts
/// violations. Unknown verdicts are reported and pass. Moves the nets into the result.
struct Verified {
  Specification specification;
  verify::VerifiedNet net;
};
[[nodiscard]] std::optional<Verified> walk(const std::filesystem::path& given, const Gate& gate,
                                           Listener& listener);

}  // namespace tessera::project
