#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "language/language.hpp"

namespace tessera::language_server {

/// "/home/me/spec.yaml" of "file:///home/me/spec.yaml"; empty: it is no file.
[[nodiscard]] std::filesystem::path path_of(const std::string& uri);
/// With %20 for a blank: what is no letter, digit or one of "/-._~" as its bytes.
[[nodiscard]] std::string escaped(std::string_view text);
[[nodiscard]] std::string uri_of(const std::filesystem::path& path);

/// The texts that the editor has open, and the files of their projects.
///
/// Threads: one.
class Workspace {
 public:
  explicit Workspace(const language::Grammar& grammar) : grammar_(grammar) {}

  struct Open {
    std::string uri;
    std::string text;
    std::int64_t version = 0;
  };
  void open(Open document);
  void close(const std::string& uri) { open_.erase(uri); }
  /// nullptr: it is not open.
  [[nodiscard]] Open* find(const std::string& uri);
  [[nodiscard]] const std::map<std::string, Open>& all() const { return open_; }

  /// Whether a text is a specification, or is about to become one: a line of its beginning starts with `tessera:`, or
  /// its file is called spec.yaml and begins with a key of a specification. Other programs have a spec.yaml too. A file
  /// that has only parts for specifications that include it is none.
  [[nodiscard]] bool is_specification(const std::filesystem::path& file, const std::string& text) const;

  /// A file as the editor shows it, or as it is on disk.
  [[nodiscard]] std::string text_of(const std::filesystem::path& file) const;

  /// A specification with its names, and how the editor calls it.
  struct Specification {
    std::string uri;
    std::filesystem::path project;
    std::shared_ptr<const language::Document> document;
  };
  /// The specification that `uri` is, or that its project has: the next spec.yaml in a folder above it.
  [[nodiscard]] std::optional<Specification> specification_of(const std::string& uri);

  /// The files of a project with names of its specification (project::files_with_names); their paths are URIs.
  [[nodiscard]] std::vector<language::Source> sources_of(const std::filesystem::path& folder) const;

 private:
  [[nodiscard]] std::shared_ptr<const language::Document> analysed(const std::string& uri, std::string text);

  const language::Grammar& grammar_;
  std::map<std::string, Open> open_;
  std::map<std::string, std::shared_ptr<const language::Document>> analysed_;  ///< the last one of each file
};

}  // namespace tessera::language_server
