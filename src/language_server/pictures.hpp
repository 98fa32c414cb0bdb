#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "language/language.hpp"
#include "net/net.hpp"

namespace tessera::language_server {

/// How an editor gets a picture inside of Markdown.
enum class PictureForm : std::uint8_t {
  none,
  embedded,  ///< as a data: URI, which VS Code shows
  file       ///< as the URI of a file, which other editors show or open
};

/// Draws pages of the specifications that were checked last, and keeps the pictures.
///
/// Threads: any.
class Pictures {
 public:
  Pictures() = default;
  ~Pictures();
  Pictures(const Pictures&) = delete;
  Pictures& operator=(const Pictures&) = delete;

  /// The pages of a text; nullptr: it has none.
  void keep(const std::string& uri, const std::string& text,
            std::shared_ptr<const net::HierarchicalNet> pages);
  void forget(const std::string& uri);

  /// "![page robot.control](...)". Empty: that text was not checked yet or has mistakes, the page is too large to be
  /// read, graphviz is missing, or the picture is not ready after `patience`: then it is the next time.
  [[nodiscard]] std::string markdown(const std::string& uri, const std::string& text,
                                     const language::PageName& page, PictureForm form,
                                     std::chrono::milliseconds patience);

 private:
  struct Kept {
    std::string text;
    std::shared_ptr<const net::HierarchicalNet> pages;
    std::map<std::uint32_t, std::shared_future<std::string>>
        drawn;  ///< SVG by page; empty: it cannot be drawn
  };

  /// The URI of a file with that picture.
  [[nodiscard]] std::string file_of(const std::string& svg);

  std::mutex mutex_;
  std::map<std::string, Kept> kept_;
  std::shared_future<std::string> last_;  ///< one picture is drawn at a time
  std::filesystem::path folder_;          ///< of the files; made when it is needed, removed at the end
  std::deque<std::filesystem::path> files_;
  std::size_t made_ = 0;
};

}  // namespace tessera::language_server
