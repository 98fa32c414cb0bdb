#include "diagnostics/source.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "tessera/nearest.hpp"

namespace tessera::diagnostics {
namespace {

namespace fs = std::filesystem;

Diagnostics failed(const fs::path& path, std::string message, Hint hint = {}) {
  Diagnostics result(path.string(), {});
  result.error("E001", {}, std::move(message), std::move(hint));
  return result;
}

/// The files beside `path`, to guess which one was meant.
std::vector<std::string> neighbours(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end; it.increment(ignored)) {
    names.push_back(it->path().filename().string());
  }
  return names;
}

/// The specifications that the folder may hold.
std::string hint_for_folder(const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code ignored;
  for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end; it.increment(ignored))
    if (const fs::path& file = it->path(); file.extension() == ".yaml" || file.extension() == ".yml")
      found.push_back(file.string());
  std::ranges::sort(found);
  if (found.empty()) return "`tessera new NAME` makes a project";
  constexpr std::size_t shown = 3;
  std::string text = "name the file: " + found.front();
  for (std::size_t at = 1; at < std::min(shown, found.size()); ++at) text += ", " + found[at];
  return text + (found.size() > shown ? ", ..." : "");
}

}  // namespace

Diagnostics load(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status) && error == std::errc::permission_denied) return failed(path, "permission denied");
  if (!fs::exists(status)) {
    return failed(path, "no such file", did_you_mean(path.filename().string(), neighbours(path)));
  }
  if (fs::is_directory(status)) {
    return failed(path, "this is a folder without a spec.yaml", hint_for_folder(path));
  }
  if (!fs::is_regular_file(status) && !fs::is_fifo(status) && !fs::is_character_file(status)) {
    return failed(path, "this is not a file that can be read");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return failed(path, "the file cannot be opened (" + std::generic_category().message(errno) + ")");
  // Read up to the limit, not to the size on disk: pipes and devices have none.
  std::string text;
  constexpr std::size_t block = 1U << 16U;
  while (in && text.size() <= largest_source) {
    const std::size_t used = text.size();
    text.resize(used + block);
    in.read(text.data() + used, block);
    text.resize(used + static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) return failed(path, "the file cannot be read");
  if (text.size() > largest_source) return failed(path, "the file is larger than 64 MB");
  return {path.string(), std::move(text), path.has_parent_path() ? path.parent_path() : fs::path(".")};
}

bool is_xml(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos || text[begin] != '<' || begin + 1 == text.size()) return false;
  const char next = text[begin + 1];
  return next == '?' || next == '!' || next == '_' || (next >= 'a' && next <= 'z') ||
         (next >= 'A' && next <= 'Z');
}

bool is_xml_file(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::ifstream in(path, std::ios::binary);
  std::string begin(4096, '\0');
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(in.gcount()));
  return is_xml(begin);
}

}  // namespace tessera::diagnostics
