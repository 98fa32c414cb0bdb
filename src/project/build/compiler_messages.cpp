#include "project/build/compiler_messages.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

namespace tessera::project {

namespace {

constexpr std::size_t most_notes = 10;

/// "FILE:LINE:COLUMN" and what follows it.
struct PlacedText {
  SourcePlace place;
  std::string_view rest;
};

std::optional<std::uint32_t> take_number(std::string_view& text) {
  std::uint32_t number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// The first "FILE:LINE:COLUMN:" or "FILE:LINE" of a line. A file may have colons in its name.
std::optional<PlacedText> placed(std::string_view line) {
  for (std::size_t colon = line.find(':'); colon != std::string_view::npos;
       colon = line.find(':', colon + 1)) {
    std::string_view rest = line.substr(colon + 1);
    const auto number = take_number(rest);
    if (!number || colon == 0) continue;
    PlacedText result{{std::string(line.substr(0, colon)), *number, 1}, rest};
    if (rest.starts_with(':')) {
      std::string_view behind = rest.substr(1);
      if (const auto column = take_number(behind)) {
        result.place.column = *column;
        result.rest = behind;
      }
    }
    if (result.rest.empty() || result.rest.front() == ':' || result.rest.front() == ',') return result;
  }
  return std::nullopt;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// Without " {aka ...}", whose braces may be nested.
void remove_other_names(std::string& text) {
  for (std::size_t at = text.find(" {aka "); at != std::string::npos; at = text.find(" {aka ", at)) {
    int depth = 0;
    std::size_t end = at + 1;
    for (; end < text.size(); ++end) {
      depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0;
      if (depth == 0) break;
    }
    text.erase(at, std::min(end + 1, text.size()) - at);
  }
}

std::string plain(std::string_view text) {
  std::string result(text);
  replace_all(result, "\u2018", "'");
  replace_all(result, "\u2019", "'");
  remove_other_names(result);
  return result;
}

/// Reads line by line.
class Reader {
 public:
  void read(std::string_view line) {
    constexpr std::string_view included = "In file included from ";
    if (line.starts_with(included) || line.starts_with("                 from ")) {
      if (line.starts_with(included)) open_ = false;
      if (const auto from = placed(line.substr(line.find("from ") + 5))) context_.push_back(from->place);
      return;
    }
    if (read_underline(line)) return;
    const auto at = placed(line);
    if (!at) return;
    std::string_view rest = at->rest;
    while (rest.starts_with(':') || rest.starts_with(' ')) rest.remove_prefix(1);
    for (const std::string_view kind : {"fatal error: ", "error: "})
      if (rest.starts_with(kind)) return begin(at->place, rest.substr(kind.size()));
    if (rest.starts_with("note: ")) return note(at->place, rest.substr(6));
    if (rest.starts_with("warning: ")) {
      open_ = false;
      context_.clear();
    } else if (rest.starts_with("required ") || rest.starts_with("in \u2018constexpr\u2019") ||
               rest.starts_with("in 'constexpr'") || rest.starts_with("recursively required")) {
      context_.push_back(at->place);
    }
  }

  std::vector<CompilerError> finish() { return std::move(errors_); }

 private:
  void begin(const SourcePlace& at, std::string_view text) {
    errors_.push_back({at, plain(text), std::exchange(context_, {}), {}, 1});
    open_ = true;
    wants_underline_ = true;
  }

  void note(const SourcePlace& at, std::string_view text) {
    if (!open_ || errors_.empty()) return;
    CompilerError& error = errors_.back();
    error.reached.push_back(at);
    if (error.notes.size() < most_notes) error.notes.push_back(plain(text));
    wants_underline_ = false;
  }

  /// "      |          ^~~": how much is meant.
  bool read_underline(std::string_view line) {
    const std::size_t bar = line.find('|');
    if (bar == std::string_view::npos || bar > 12 ||
        line.substr(0, bar).find_first_not_of(" 0123456789") != std::string_view::npos)
      return false;
    const std::size_t caret = line.find('^');
    if (wants_underline_ && caret != std::string_view::npos &&
        line.find_first_not_of(" |^~") == std::string_view::npos) {
      std::size_t end = caret + 1;
      while (end < line.size() && line[end] == '~') ++end;
      errors_.back().length = static_cast<std::uint32_t>(end - caret);
      wants_underline_ = false;
    }
    return true;
  }

  std::vector<CompilerError> errors_;
  std::vector<SourcePlace> context_;
  bool open_ = false;
  bool wants_underline_ = false;
};

}  // namespace

std::vector<CompilerError> read_compiler_errors(std::string_view output) {
  Reader reader;
  for (std::size_t start = 0; start < output.size();) {
    const std::size_t end = std::min(output.find('\n', start), output.size());
    reader.read(output.substr(start, end - start));
    start = end + 1;
  }
  return reader.finish();
}

}  // namespace tessera::project
