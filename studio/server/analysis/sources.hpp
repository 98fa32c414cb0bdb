#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "language/language.hpp"
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
  /// specification: the name of the file, which may be written together with others.
  explicit Sources(std::filesystem::path project, std::string specification = {})
      : project_(std::move(project)), specification_(std::move(specification)) {}

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

  /// The files with names of the specification (project::user_sources), with their names in the project.
  [[nodiscard]] std::vector<language::Source> all() const;

  struct Renamed {
    std::vector<std::string> files;  ///< that were changed, relative to the project
    std::optional<Problem> problem;  ///< why none was written; nullopt: all of them were
  };
  /// Renames the function `from` to the present name of its behaviour, wherever src/ and test/ use it. text:
  /// the specification. The rest of each file stays as it is.
  [[nodiscard]] Renamed rename(const std::string& text, const language::Grammar& grammar,
                               const std::string& subsystem, const std::string& from,
                               const std::string& function) const;

  struct Written {
    std::string file;  ///< the specification, params.yaml, or C++ in src/ or test/
    std::string text;
    std::string revision;  ///< of the text that it replaces
  };
  /// Writes all of the files or none. Returns why none was written; nullopt: all were.
  [[nodiscard]] std::optional<std::string> write_together(const std::vector<Written>& files) const;

  /// The file, if there may be one of that name: "src/control.cpp", "test/control_test.cpp", "params.yaml".
  /// nullopt: it is no source of this project.
  [[nodiscard]] std::optional<SpecFile::Content> read(const std::string& file) const;
  /// Writes C++ in src/.
  [[nodiscard]] std::optional<SpecFile::Outcome> write(const std::string& file, const std::string& text,
                                                       const std::string& revision) const;

 private:
  /// nullopt: the name leads out of src/, through a symbolic link or to something that is no source.
  [[nodiscard]] std::optional<std::filesystem::path> path_of(const std::string& file) const;

  /// The same for every file that a rename changes.
  [[nodiscard]] std::optional<std::filesystem::path> path_of_any(const std::string& file) const;
  [[nodiscard]] std::optional<std::filesystem::path> path_without_links(
      const std::filesystem::path& name) const;

  std::filesystem::path project_;
  std::string specification_;
};

}  // namespace tessera::server
