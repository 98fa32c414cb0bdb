#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "spec/document/document.hpp"
#include "tessera/nearest.hpp"

/// Types and templates that stand in files of their own: `include: parts/docking.yaml`.
namespace tessera::spec {

/// The additions of the files of `include` to a specification. They outlive the nodes that they give.
///
/// Threads: one at a time.
class Includes {
 public:
  /// The root of `main`, whose `types` and `templates` hold also those of the included files, which come first. A
  /// file that is included several times is read once.
  ///
  /// Errors: E356 a path that is none, is absolute, or leaves the folder of the specification; E357 a file that
  ///         cannot be read; E358 files that include each other in a circle; E359 a key that does not belong in an
  ///         included file; E360 a type or template that two files define; E361 a text without a folder; and those
  ///         of read_document in the included files.
  [[nodiscard]] const Node& whole(const Document& main, Diagnostics& out);
  /// false: a file could not be read, so that names of it are not known.
  [[nodiscard]] bool complete() const { return complete_; }

 private:
  using Path = std::filesystem::path;
  /// The types or templates of all files.
  struct Collected {
    std::vector<Entry> entries;
    std::map<std::string, Span> spans;
  };

  void refuse(std::string code, Span at, std::string message, Hint hint, Diagnostics& out);
  void read_list(const Entry& include, const Path& from, Diagnostics& out);
  void read_file(const Node& name, const Path& from, Diagnostics& out);
  void read_part(const Node& root, const Path& file, Diagnostics& out);
  void collect(const Entry& section, Diagnostics& out);

  std::deque<Document> documents_;
  std::deque<Node> nodes_;
  std::map<std::string, Collected> collected_;  ///< per key of the specification
  std::set<Path> read_;
  std::vector<std::string> chain_;  ///< files that are being read, each of which includes the next
  std::size_t bytes_ = 0;           ///< of the included files
  bool complete_ = true;
};

/// `tessera: 1`. Errors: E108 another version.
void check_version(const Entry& version, Diagnostics& out);

}  // namespace tessera::spec
