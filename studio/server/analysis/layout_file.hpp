#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "project/files/file_names.hpp"
#include "server/analysis/spec_file.hpp"
#include "tessera/result.hpp"

namespace tessera::server {

/// The place where a user has put the box of an agent or subsystem in the drawing of the structure: its upper left corner, for a
/// subsystem from that of its agent.
struct BoxPosition {
  int x = 0;
  int y = 0;
  auto operator<=>(const BoxPosition&) const = default;
};

/// By path: "robot", "robot.sensor".
using BoxPositions = std::map<std::string, BoxPosition>;

/// The text of a layout file: a JSON object with one line for each box, sorted, so that version control shows which box
/// was moved.
[[nodiscard]] std::string layout_text(const BoxPositions& boxes);
/// The opposite; or why the text is no layout, with the line.
[[nodiscard]] Result<BoxPositions> read_layout(std::string_view text);

/// `.tessera-layout.json` beside the specification. No symbolic link is followed to read or write it.
///
/// Threads: any.
class LayoutFile {
 public:
  static constexpr const char* name = project::file_names::layout;
  static constexpr std::size_t largest = std::size_t{1} << 20U;

  explicit LayoutFile(const std::filesystem::path& folder) : file_(folder / name) {}

  struct Content {
    BoxPositions boxes;
    std::string revision;  ///< empty: the file is there, but cannot be read
    std::string error;     ///< why the file is not understood; empty: it is, or there is none
  };
  [[nodiscard]] Content read() const;

  /// Writes all boxes if the file on disk still has `revision`. Without boxes, the file goes.
  [[nodiscard]] SpecFile::Outcome write(const BoxPositions& boxes, std::string_view revision);

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  SpecFile file_;
};

}  // namespace tessera::server
