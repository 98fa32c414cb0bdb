#include "cli/outputs.hpp"

#include <fmt/core.h>

#include <array>
#include <fstream>
#include <stdexcept>

#include "report/report.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

namespace {

/// The first bytes of a regular file; empty: it does not exist, or is empty.
std::string beginning_of(const fs::path& file, std::size_t count) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return {};
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(count, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

[[noreturn]] void refuse(const fs::path& file, std::string_view what) {
  throw std::runtime_error(
      fmt::format("{} is there already and is no {}: remove it, or name another", file.string(), what));
}

}  // namespace

void check_replaceable(const std::string& file, std::string_view text) {
  constexpr std::size_t told_apart_by = 4;
  const std::string there = file == "-" ? std::string() : beginning_of(file, told_apart_by);
  if (there.empty() || text.empty()) return;
  constexpr std::string_view json = "{[";
  const bool same = json.find(text.front()) != json.npos ? json.find(there.front()) != json.npos
                                                         : text.substr(0, told_apart_by) == there;
  if (!same) refuse(file, "earlier output of this kind");
}

void check_recording(const std::string& file) {
  const std::string there = file.empty() ? std::string() : beginning_of(file, recording_magic.size());
  if (!there.empty() && there != recording_magic) refuse(file, "recording");
}

void check_report(const std::string& folder) {
  if (folder.empty()) return;
  constexpr std::size_t head = 400;
  const fs::path page = fs::path(folder) / "index.html", picture = fs::path(folder) / "path.png";
  if (fs::exists(folder) && !fs::is_directory(folder)) refuse(folder, "folder");
  const std::string there = beginning_of(page, head);
  if (there.find(report::generator_tag) != there.npos) return;
  if (!there.empty()) refuse(page, "report of a run");
  if (fs::exists(picture)) refuse(picture, "picture of a report");
}

}  // namespace tessera::cli
