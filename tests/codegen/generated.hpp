#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/codegen.hpp"
#include "net/net.hpp"
#include "spec/model/model.hpp"

/// From a specification to generated files, and what tests do with them.
namespace tessera::test {

inline const std::filesystem::path source_folder = TESSERA_SOURCE_DIR;
inline const std::filesystem::path features_spec = source_folder / "tests/codegen/features/spec.yaml";
inline const std::filesystem::path line_follower_spec = source_folder / "examples/01_line_follower/spec.yaml";
inline const std::filesystem::path gap_spec = source_folder / "examples/02_gap/spec.yaml";

struct Generated {
  spec::Model model;
  net::HierarchicalNet pages;
  net::Net net;
  std::string net_hash;
  std::vector<codegen::File> files;

  /// The text of the file with that path; throws if there is none.
  [[nodiscard]] const std::string& operator[](const std::string& path) const;
};

/// All stages. Throws std::runtime_error with the diagnostics if one fails. spec_path is the path in #line.
Generated generate(const std::string& text, const std::string& spec_path = "spec.yaml",
                   codegen::Lines lines = codegen::Lines::marked);
Generated generate_file(const std::filesystem::path& spec);

std::string read_file(const std::filesystem::path& path);

/// A folder that lives as long as the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void write(const std::string& path, const std::string& text) const;
  void write(const std::vector<codegen::File>& files) const;

 private:
  std::filesystem::path path_;
};

struct Ran {
  int exit_code = 0;
  std::string output;  ///< standard output and standard error
};

/// Runs a command of the shell.
Ran run(const std::string& command);

}  // namespace tessera::test
