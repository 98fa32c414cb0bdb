#include "server/analysis/layout_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

namespace tessera::server {
namespace {

using nlohmann::json;

/// Units of the drawing: no screen shows more.
constexpr double farthest = 1e6;
constexpr std::size_t longest_name = 200;

/// "robot" or "robot.sensor".
bool names_a_box(std::string_view path) {
  const auto is_of_name = [](char one) {
    return one == '_' || (one >= '0' && one <= '9') || (one >= 'a' && one <= 'z') ||
           (one >= 'A' && one <= 'Z');
  };
  const std::size_t dot = path.find('.');
  const auto is_name = [&](std::string_view part) {
    return !part.empty() && std::ranges::all_of(part, is_of_name);
  };
  return path.size() <= longest_name && is_name(path.substr(0, dot)) &&
         (dot == std::string_view::npos || is_name(path.substr(dot + 1)));
}

std::optional<BoxPosition> position_in(const json& given) {
  if (!given.is_array() || given.size() != 2) return std::nullopt;
  for (const json& one : given)
    if (!one.is_number() || !(std::abs(one.get<double>()) <= farthest)) return std::nullopt;
  return BoxPosition{static_cast<int>(std::lround(given[0].get<double>())),
                     static_cast<int>(std::lround(given[1].get<double>()))};
}

}  // namespace

std::string layout_text(const BoxPositions& boxes) {
  std::string text = "{";
  for (const auto& [path, at] : boxes)
    text += fmt::format("{}\n  \"{}\": [{}, {}]", text.size() == 1 ? "" : ",", path, at.x, at.y);
  return text + "\n}\n";
}

Result<BoxPositions> read_layout(std::string_view text) {
  json given;
  try {
    given = json::parse(text);
  } catch (const json::parse_error& error) {
    const std::size_t byte = std::min(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
    return Problem{fmt::format("line {} is no JSON", line)};
  }
  if (!given.is_object()) return Problem{"it is no object of boxes"};
  BoxPositions boxes;
  for (const auto& [path, value] : given.items()) {
    const std::optional<BoxPosition> at = position_in(value);
    if (!names_a_box(path)) return Problem{fmt::format("'{}' is no path of an agent or subsystem", path)};
    if (!at) return Problem{fmt::format("the position of '{}' is not [x, y]", path)};
    boxes[path] = *at;
  }
  return boxes;
}

LayoutFile::Content LayoutFile::read() const {
  SpecFile::Content content = file_.read();
  if (content.revision.empty()) return {{}, {}, std::move(content.error)};
  if (content.text.empty()) return {{}, std::move(content.revision), {}};
  if (content.text.size() > largest) return {{}, std::move(content.revision), "it is larger than 1 MB"};
  Result<BoxPositions> boxes = read_layout(content.text);
  if (!boxes) return {{}, std::move(content.revision), boxes.problem()};
  return {std::move(*boxes), std::move(content.revision), {}};
}

SpecFile::Outcome LayoutFile::write(const BoxPositions& boxes, std::string_view revision) {
  if (!boxes.empty()) return file_.write(layout_text(boxes), revision);
  SpecFile::Content now = file_.read();
  if (now.revision.empty()) return {SpecFile::Written::failed, std::move(now)};
  if (now.revision != revision) return {SpecFile::Written::conflict, std::move(now)};
  std::error_code problem;
  std::filesystem::remove(path(), problem);
  if (problem) return {SpecFile::Written::failed, {{}, {}, problem.message()}};
  return {SpecFile::Written::yes, {{}, revision_of({}), {}}};
}

}  // namespace tessera::server
