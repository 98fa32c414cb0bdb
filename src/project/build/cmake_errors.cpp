#include "project/build/cmake_errors.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "project/files/files.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// "CMake Error at FILE:LINE (command):", the text below it, and the calls that led there.
struct CMakeError {
  std::string whole;
  std::string message;  ///< in one line
  std::uint32_t line = 0;
};

std::vector<std::string> text_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    lines.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return lines;
}

/// The line that a place names ("/robots/rover/project.cmake:3 (find_package)"), if it is in that file; 0: it is not.
std::uint32_t line_in(std::string_view place, const std::string& file) {
  const std::size_t at = place.find(file + ":");
  if (at == std::string_view::npos) return 0;
  return static_cast<std::uint32_t>(
      std::strtoul(std::string(place.substr(at + file.size() + 1)).c_str(), nullptr, 10));
}

/// The first paragraph, joined.
std::string first_paragraph(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) {
      if (!text.empty()) break;
      continue;
    }
    text += (text.empty() ? "" : " ") + line.substr(begin);
  }
  while (text.ends_with('.') || text.ends_with(' ')) text.pop_back();
  return text;
}

std::string between(const std::string& text, std::string_view before, std::string_view after) {
  const std::size_t begin = text.find(before);
  if (begin == std::string::npos) return {};
  const std::size_t from = begin + before.size(), end = text.find(after, from);
  return end == std::string::npos ? std::string() : text.substr(from, end - from);
}

std::vector<CMakeError> errors_in(const std::string& text, const std::string& file) {
  std::vector<CMakeError> errors;
  std::vector<std::string> body;
  bool in_calls = false, in_error = false;
  const auto close = [&] {
    if (in_error) errors.back().message = first_paragraph(body);
    body.clear();
    in_error = in_calls = false;
  };
  for (const std::string& line : text_lines(text)) {
    if (line.starts_with("CMake Error")) {
      close();
      in_error = true;
      errors.push_back({line + "\n", {}, line_in(line, file)});
      // "CMake Error: The source directory ... does not exist."
      if (const std::size_t colon = line.find("Error: "); colon != std::string::npos)
        body.push_back(line.substr(colon + 7));
      continue;
    }
    if (!in_error) continue;
    if (line.starts_with("-- ") || line.starts_with("CMake ") || line.starts_with("See also")) {
      close();
      continue;
    }
    errors.back().whole += line + "\n";
    if (line.starts_with("Call Stack"))
      in_calls = true;
    else if (!in_calls)
      body.push_back(line);
    else if (errors.back().line == 0)
      errors.back().line = line_in(line, file);
  }
  close();
  return errors;
}

struct Explained {
  std::string message, hint;
};

Explained explain(const CMakeError& error) {
  if (std::string package = between(error.whole, "package configuration file provided by\n  \"", "\"");
      !package.empty() ||
      !(package = between(error.whole, "configuration file provided by \"", "\"")).empty())
    return {fmt::format("CMake does not find the package {}", package),
            fmt::format("install its development package, or set {}_DIR or CMAKE_PREFIX_PATH", package)};
  if (error.message.starts_with("Could NOT find"))
    return {error.message, "install the development package of this library, in that version"};
  if (std::string target = between(error.whole, "contains:\n\n    ", "\n"); !target.empty())
    return {fmt::format("there is no library {}", target),
            "find_package(...) of its package has to stand before this line; or its name has a typo"};
  if (error.message.find("which is not built by this project") != std::string::npos)
    return {error.message, "name the target `project`: target_link_libraries(project INTERFACE ...)"};
  return {error.message, {}};
}

}  // namespace

std::string explain_cmake_errors(const std::string& text, const fs::path& project) {
  const fs::path file = project / user_build_file;
  const std::vector<CMakeError> errors = errors_in(text, file.string());
  const diagnostics::Diagnostics source(user_build_file, content_of(file));
  std::string shown, rest;
  std::set<std::uint32_t> lines;
  for (const CMakeError& error : errors) {
    // "include could not load requested file" follows a mistake that was told.
    const bool repeats = error.whole.find(file.string() + "\n") != std::string::npos && !shown.empty();
    if (error.line == 0) {
      if (!repeats) rest += error.whole;
      continue;
    }
    if (!lines.insert(error.line).second) continue;
    const std::string_view quoted = source.line(error.line);
    const std::size_t first = std::min(quoted.find_first_not_of(" \t"), quoted.size());
    const diagnostics::Span span{
        error.line, static_cast<std::uint32_t>(first + 1),
        static_cast<std::uint32_t>(std::max<std::size_t>(1, quoted.find_first_of(" (", first) - first))};
    Explained explained = explain(error);
    shown += diagnostics::render(
        {diagnostics::Severity::error, "E511", span, std::move(explained.message), std::move(explained.hint)},
        source);
  }
  return shown.empty() ? shown : shown + rest;
}

}  // namespace tessera::project
