#include "project/build/cmake_errors.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "project/files/files.hpp"
#include "tessera/nearest.hpp"

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

/// The file of a target_sources(...) that does not exist.
std::string missing_source(const CMakeError& error) {
  return between(error.whole, "Cannot find source file:\n\n    ", "\n");
}

/// The commands that a file such as project.cmake has most.
const std::vector<std::string> usual_commands{"target_link_libraries",
                                              "target_link_options",
                                              "target_link_directories",
                                              "target_compile_options",
                                              "target_compile_definitions",
                                              "target_compile_features",
                                              "target_include_directories",
                                              "target_sources",
                                              "find_package",
                                              "find_library",
                                              "find_path",
                                              "pkg_check_modules",
                                              "pkg_search_module",
                                              "add_library",
                                              "add_compile_options",
                                              "include",
                                              "set",
                                              "message",
                                              "list"};

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
  if (const std::string command = between(error.message, "Unknown CMake command \"", "\"");
      !command.empty()) {
    const std::string near = did_you_mean(command, usual_commands).text;
    return {fmt::format("CMake has no command {}", command),
            near.empty() ? "the file or package that defines it has to be included before this line" : near};
  }
  if (const std::string file = between(error.whole, "requested file:\n\n    ", "\n"); !file.empty())
    return {fmt::format("there is no file {}", file), "correct the path"};
  if (error.message.find("INTERFACE keyword") != std::string::npos)
    return {error.message, "write INTERFACE instead of PUBLIC or PRIVATE"};
  if (error.message.starts_with("Parse error"))
    return {error.message, "each command is NAME(...): close its brackets and quotes"};
  if (const std::string source = missing_source(error); !source.empty())
    return {fmt::format("there is no file {}", source),
            "name it by its whole path: ${CMAKE_CURRENT_LIST_DIR}/..."};
  return {error.message, {}};
}

/// A word that a line of the file may have, and why it was refused.
struct Refused {
  std::vector<std::string> words;  ///< as it may be written
  Explained explained;
};

/// The text behind `before`: in quotes, or up to a blank.
std::string word_behind(std::string_view line, std::string_view before) {
  const std::size_t at = line.find(before);
  if (at == std::string_view::npos) return {};
  std::string_view rest = line.substr(at + before.size());
  const bool in_quotes = rest.starts_with('\'');
  if (in_quotes) rest.remove_prefix(1);
  return std::string(rest.substr(0, rest.find_first_of(in_quotes ? "'" : " :;,\"")));
}

Refused no_library(const std::string& name) {
  return {{name, "-l" + name},
          {fmt::format("the linker finds no library {}", name),
           fmt::format(
               "install its development package, or correct the name: lib{0}.so or lib{0}.a is looked for; "
               "libraries of find_package(...) are called PACKAGE::NAME",
               name)}};
}

/// The message of a line of compiler or linker about a library or an option. No words: there is none.
Refused refused_in(std::string_view line) {
  for (const std::string_view before : {"cannot find -l", "unable to find library -l", "library not found: "})
    if (const std::string name = word_behind(line, before); !name.empty()) return no_library(name);
  for (const std::string_view before :
       {"error: unrecognized command-line option ", "error: unrecognized argument in option ",
        "error: unknown argument: ", "error: unsupported option ", "error: unknown argument "})
    if (const std::string option = word_behind(line, before); option.starts_with('-')) {
      const std::string near = word_behind(line, "did you mean ");
      return {{option},
              {fmt::format("the compiler has no option {}", option),
               near.empty() ? "correct it, or remove it" : proposing(near).text}};
    }
  if (const std::string value = word_behind(line, "error: bad value "); !value.empty()) {
    const std::string option = word_behind(line, " for ");
    return {{option + value},
            {fmt::format("the option {} of the compiler has no value {}", option, value),
             "correct it, or remove it"}};
  }
  for (const std::string_view before : {"ld: unrecognized option ", "lld: error: unknown argument ",
                                        "mold: fatal: unknown command line option: "})
    if (const std::string option = word_behind(line, before); option.starts_with('-'))
      return {{"-Wl," + option, option, "LINKER:" + option},
              {fmt::format("the linker has no option {}", option), "correct it, or remove it"}};
  if (line.find("missing and no known rule to make it") != std::string_view::npos)
    if (const std::string file = word_behind(line, "error: "); !file.empty())
      return {{file, fs::path(file).filename().string()},
              {fmt::format("there is no file {}", file), "correct the path, or build that library first"}};
  return {};
}

bool is_part_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '+' || c == '.';
}

/// The first place of a word in the commands of the file. Line 0: none.
diagnostics::Span place_in(const std::string& text, const std::string& word) {
  std::uint32_t number = 0;
  for (const std::string& line : text_lines(text)) {
    ++number;
    const std::size_t end = std::min(line.find('#'), line.size());
    for (std::size_t at = line.find(word); at < end; at = line.find(word, at + 1)) {
      const bool begins = at == 0 || !is_part_of_word(line[at - 1]);
      const bool ends = at + word.size() == line.size() || !is_part_of_word(line[at + word.size()]);
      if (begins && ends)
        return {number, static_cast<std::uint32_t>(at + 1), static_cast<std::uint32_t>(word.size())};
    }
  }
  return {0, 0, 1};
}

/// With the quotes of ASCII.
std::string with_plain_quotes(std::string_view text) {
  std::string plain(text);
  for (const std::string_view quote : {"\u2018", "\u2019"})
    for (std::size_t at = plain.find(quote); at != std::string::npos; at = plain.find(quote, at))
      plain.replace(at, quote.size(), "'");
  return plain;
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
    diagnostics::Span span = span_of(error, source);
    if (span.line == 0)
      if (const std::string file_name = missing_source(error); !file_name.empty())
        span = place_in(text_of_file, file_name);
    if (span.line == 0) {
      if (!repeats) rest += error.whole;
      continue;
    }
    if (!lines.insert(span.line).second) continue;
    Explained explained = explain(error);
    shown += diagnostics::render(
        {diagnostics::Severity::error, "E511", span, std::move(explained.message), std::move(explained.hint)},
        source);
  }
  return shown.empty() ? shown : shown + rest;
}

std::string explain_refused_words(std::string_view output, const fs::path& project) {
  const std::string text = content_of(project / user_build_file);
  if (text.empty()) return {};
  const diagnostics::Diagnostics source(user_build_file, text);
  std::set<std::string> told;
  std::string shown;
  for (const std::string& line : text_lines(with_plain_quotes(output))) {
    Refused refused = refused_in(line);
    if (refused.words.empty() || !told.insert(refused.words.front()).second) continue;
    diagnostics::Span span{0, 0, 1};
    for (const std::string& word : refused.words)
      if (span.line == 0) span = place_in(text, word);
    if (span.line == 0)
      refused.explained.hint +=
          "; no line of this file has it: the environment may (CXXFLAGS, LDFLAGS), or a file that it "
          "includes";
    shown += diagnostics::render({diagnostics::Severity::error, "E511", span,
                                  std::move(refused.explained.message), std::move(refused.explained.hint)},
                                 source);
  }
  return shown;
}

}  // namespace tessera::project
