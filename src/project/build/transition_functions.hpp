#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "codegen/codegen.hpp"
#include "project/build/source_scan.hpp"

namespace tessera::project {

/// Facts about the user's transition functions before they are compiled. They come from the text of
/// every source in src/, and of the files that these include by "...".
///
/// Threads: one at a time.
class TransitionFunctions {
 public:
  /// wanted: all transition functions. sources: files to be read instead of all in src/. Reads them; a
  /// project without src/ has none.
  TransitionFunctions(std::filesystem::path project, std::vector<codegen::Stub> wanted,
                      const std::vector<std::filesystem::path>& sources = {});
  [[nodiscard]] const std::vector<codegen::Stub>& wanted() const { return wanted_; }

  enum class Presence : std::uint8_t {
    defined,  ///< it is defined
    unclear,  ///< the text does not tell; the linker will
    missing   ///< no function can be it
  };
  [[nodiscard]] Presence presence(const codegen::Stub& stub) const;

  struct Definition {
    std::filesystem::path file;  ///< relative to the project, where it is in it
    std::uint32_t line = 0;
    std::string space;
    std::string name, heading;
  };
  /// The position of its definition.
  [[nodiscard]] std::vector<Definition> definitions(const codegen::Stub& stub) const;
  /// Definitions of functions of its name in namespaces of no subsystem: most likely one was meant there.
  [[nodiscard]] std::vector<Definition> definitions_elsewhere(const codegen::Stub& stub) const;
  /// Names of functions in its namespace that no behaviour has: most likely those of behaviours that had other names.
  [[nodiscard]] std::vector<std::string> leftovers(const codegen::Stub& stub) const;
  /// Functions of its name in its namespace whose arguments are not those of a transition function.
  [[nodiscard]] std::vector<Definition> definitions_with_other_arguments(const codegen::Stub& stub) const;
  /// A function in its namespace that no behaviour or condition has, and whose name is nearly its.
  [[nodiscard]] std::optional<Definition> nearly(const codegen::Stub& stub) const;
  /// The file where it would be added: where the others of its subsystem are, else that of the stub.
  [[nodiscard]] std::filesystem::path file_for(const codegen::Stub& stub) const;
  /// It is one of the sources.
  [[nodiscard]] bool knows(const std::filesystem::path& file) const;

  /// A hash of all sources.
  [[nodiscard]] std::string identity() const;

  /// Adds the function to that file, in its namespace; makes the file if it does not exist. Returns the
  /// file. Throws std::runtime_error if it cannot be written.
  std::filesystem::path add(const codegen::Stub& stub);

 private:
  void read(const std::filesystem::path& file);
  [[nodiscard]] std::filesystem::path shown(const std::filesystem::path& file) const;

  [[nodiscard]] bool is_wanted(const ScannedFunction& function) const;
  /// Those functions of a list that `is_one` accepts.
  template <class Predicate>
  [[nodiscard]] std::vector<Definition> those(std::vector<ScannedFunction> SourceScan::*list,
                                              Predicate is_one) const;
  std::filesystem::path project_;
  std::vector<codegen::Stub> wanted_;
  std::map<std::filesystem::path, SourceScan> scans_;
  std::map<std::filesystem::path, std::string> hashes_;
};

/// A source with the function added to it, in its namespace. text: of the source; empty: a new one.
[[nodiscard]] std::string with_function(std::string text, const codegen::Stub& stub);

/// "src/control.cpp: error: robot.control has no function 'rest'", with what to write
/// there and what may be meant: a function with nearly that name, or one in another namespace.
[[nodiscard]] std::string missing_text(const codegen::Stub& stub, const TransitionFunctions& functions);

/// Functions that may be in the wrong namespace; one line each.
[[nodiscard]] std::string misplaced_functions(const TransitionFunctions& functions);

/// Explains messages of compiler and linker in terms of the project: transition functions that are
/// missing, that are defined twice, that have other parameters, and that may be in the wrong namespace. Messages that say more
/// than that follow unchanged.
[[nodiscard]] std::string explain_build_errors(const std::string& text, const TransitionFunctions& functions);

}  // namespace tessera::project
