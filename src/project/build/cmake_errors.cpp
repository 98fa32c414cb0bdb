#include "project/build/cmake_errors.hpp"

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
  std::string message;  ///< without the place and the calls
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

std::vector<CMakeError> errors_in(const std::string& text, const std::string& file) {
  std::vector<CMakeError> errors;
  bool in_calls = false, in_error = false;
  for (const std::string& line : text_lines(text)) {
    const bool begins = line.starts_with("CMake Error");
    if (begins) errors.push_back({line + "\n", {}, line_in(line, file)});
    if (begins || line.starts_with("-- ") || line.starts_with("CMake ") || line.starts_with("See also")) {
      in_error = begins;
      in_calls = false;
      continue;
    }
    if (!in_error) continue;
    CMakeError& error = errors.back();
    error.whole += line + "\n";
    in_calls = in_calls || line.starts_with("Call Stack");
    if (!in_calls && !line.empty()) error.message += line + "\n";
    if (in_calls && error.line == 0) error.line = line_in(line, file);
  }
  return errors;
}

/// The command of an error in that file. Line 0: the error is elsewhere.
diagnostics::Span span_of(const CMakeError& error, const diagnostics::Diagnostics& source) {
  if (error.line == 0) return {0, 0, 1};
  const std::string_view quoted = source.line(error.line);
  const std::size_t first = std::min(quoted.find_first_not_of(" \t"), quoted.size());
  return {error.line, static_cast<std::uint32_t>(first + 1),
          static_cast<std::uint32_t>(std::max<std::size_t>(1, quoted.find_first_of(" (", first) - first))};
}

}  // namespace

std::string explain_cmake_errors(const std::string& text, const fs::path& project) {
  const fs::path file = project / user_build_file;
  const std::vector<CMakeError> errors = errors_in(text, file.string());
  const std::string text_of_file = content_of(file);
  const diagnostics::Diagnostics source(user_build_file, text_of_file);
  std::string shown, rest;
  std::set<std::uint32_t> lines;
  for (const CMakeError& error : errors) {
    // "include could not load requested file" follows a mistake that was told.
    const bool repeats = error.whole.find(file.string() + "\n") != std::string::npos && !shown.empty();
    const diagnostics::Span span = span_of(error, source);
    if (span.line == 0) {
      if (!repeats) rest += error.whole;
      continue;
    }
    if (!lines.insert(span.line).second) continue;
    shown += diagnostics::render(
        {diagnostics::Severity::error, "E511", span, "CMake refuses this command", {}}, source);
    shown += error.message;
  }
  return shown.empty() ? shown : shown + rest;
}

}  // namespace tessera::project
