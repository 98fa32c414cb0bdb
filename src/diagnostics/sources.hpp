#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::diagnostics {

/// A line of one of the files of a source text.
struct SourceLine {
  std::string_view file;   ///< empty: the file that was given; else the included one, relative to its folder
  std::uint32_t line = 0;  ///< of that file, from 1; 0: of no line
};

/// The files of which a source text consists: the given one and those that it includes. Their lines are numbered
/// one after the other, so that the number of a line names its file too. The lines of the given file keep their
/// numbers. The views of its answers are valid as long as it is.
///
/// Threads: const members from any thread.
class Sources {
 public:
  /// Appends a file that `given` includes, whose first line has the number `before` + 1. The numbers ascend.
  void add(std::string given, std::string file, std::uint32_t before);

  [[nodiscard]] SourceLine at(std::uint32_t number) const;
  /// The line if it is one of the given file, else 0: programs may look it up there.
  [[nodiscard]] std::uint32_t own_line(std::uint32_t number) const;
  /// "parts/docking.yaml:3" for a line of an included file, else "".
  [[nodiscard]] std::string included_line(std::uint32_t number) const;
  /// "line 8"; if files are included "line 8 of spec.yaml" or "line 3 of parts/docking.yaml".
  [[nodiscard]] std::string words(std::uint32_t number) const;
  /// "line 8", or "parts/docking.yaml:3", where space is short.
  [[nodiscard]] std::string short_words(std::uint32_t number) const;
  /// The names of the included files, relative to the folder of the given one.
  [[nodiscard]] std::vector<std::string> included() const;

 private:
  struct Included {
    std::string file;
    std::uint32_t before = 0;
  };
  std::string given_;  ///< without folder; empty if no file is included
  std::vector<Included> included_;
};

}  // namespace tessera::diagnostics
