#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "language/schema/grammar.hpp"
#include "server/analysis/analysis.hpp"
#include "server/analysis/spec_file.hpp"
#include "tessera/result.hpp"

namespace tessera::server {

/// The C++ sources of a project, src/**: the transition functions of the user. No symbolic link is followed
/// to read or write them.
///
/// Threads: any.
class Sources {
 public:
  explicit Sources(std::filesystem::path project) : project_(std::move(project)) {}

  /// [{"subsystem", "function", "state", "file", "line", "stub", "leftovers"}]: one for each behaviour of each
  /// definition. "state" is "defined", "missing", or "unclear" (only the linker can tell). "line" is null if it
  /// is not known. "leftovers": functions of the same namespace that no behaviour has.
  [[nodiscard]] nlohmann::json functions(const spec::Model& model) const;

  struct Added {
    std::string file;                ///< relative to the project
    std::optional<Problem> problem;  ///< nullopt: it was added, or was there already
  };
  /// Adds the function of a behaviour to its file, in its namespace, if it is missing.
  [[nodiscard]] Added add(const spec::Model& model, const std::string& subsystem,
                          const std::string& function) const;

  struct Renamed {
    std::vector<std::string> files;  ///< that were changed, relative to the project
    std::optional<Problem> problem;  ///< nullopt: all of them were written
  };
  /// Renames the function `from` to the present name of its behaviour, wherever src/ and test/ use it. text:
  /// the specification. The rest of each file stays as it is.
  [[nodiscard]] Renamed rename(const std::string& text, const language::Grammar& grammar,
                               const std::string& subsystem, const std::string& from,
                               const std::string& function) const;

  /// The file, if there may be one of that name: "src/control.cpp". nullopt: it is no source of this project.
  [[nodiscard]] std::optional<SpecFile::Content> read(const std::string& file) const;
  [[nodiscard]] std::optional<SpecFile::Outcome> write(const std::string& file, const std::string& text,
                                                       const std::string& revision) const;

 private:
  /// nullopt: the name leads out of src/, through a symbolic link or to something that is no source.
  [[nodiscard]] std::optional<std::filesystem::path> path_of(const std::string& file) const;

  std::filesystem::path project_;
};

}  // namespace tessera::server
