#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace tessera::server {

/// The identity of a text: 32 hexadecimal digits.
[[nodiscard]] std::string revision_of(std::string_view text);

/// The file that is edited. No symbolic link is followed to read or write it, so nothing outside its
/// folder is read or written.
///
/// Threads: any.
class SpecFile {
 public:
  /// file: absolute, canonical. Throws std::runtime_error if its folder cannot be opened.
  explicit SpecFile(std::filesystem::path file);
  ~SpecFile();
  SpecFile(const SpecFile&) = delete;
  SpecFile& operator=(const SpecFile&) = delete;

  struct Content {
    std::string text;
    std::string revision;  ///< empty: the file is there, but cannot be read
    std::string error;     ///< why the file cannot be read; empty: it was read
  };
  /// The content on disk now.
  [[nodiscard]] Content read() const;

  enum class Written : std::uint8_t { yes, conflict, failed };
  struct Outcome {
    Written written = Written::failed;
    Content now;  ///< on disk after the write; if it failed, with the reason
  };
  /// Replaces the file as a whole if the content on disk still has `revision`. A reader sees either the old
  /// text or the new one. A missing file has the revision of the empty text.
  [[nodiscard]] Outcome write(std::string_view text, std::string_view revision);
  /// The same for a text that a page made of what it was told. JSON cannot tell bytes that are not UTF-8, so a
  /// file with such bytes is not written.
  [[nodiscard]] Outcome write_shown(std::string_view text, std::string_view revision);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path folder() const { return path_.parent_path(); }

  static constexpr std::size_t largest = std::size_t{8} << 20U;

 private:
  std::filesystem::path path_;
  std::string name_;
  int folder_ = -1;
  std::mutex writing_;
};

}  // namespace tessera::server
