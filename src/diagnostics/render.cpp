#include <algorithm>
#include <array>

#include "diagnostics/diagnostics.hpp"
#include "diagnostics/utf8.hpp"

namespace tessera::diagnostics {
namespace {

constexpr std::size_t widest_line = 120;  // bytes of a source line that are quoted; a longer one is cut
constexpr std::size_t kept_before = 40;   // bytes kept before the span of a line that is cut
constexpr unsigned tab_width = 4;
constexpr std::string_view cut = "...";

class Paint {
 public:
  explicit Paint(bool colour) : colour_(colour) {}
  [[nodiscard]] std::string operator()(std::string_view code, std::string_view text) const {
    if (!colour_ || text.empty()) return std::string(text);
    return "\x1b[" + std::string(code) + "m" + std::string(text) + "\x1b[0m";
  }

 private:
  bool colour_;
};

constexpr std::string_view bold = "1";
constexpr std::string_view cyan = "36";
constexpr std::string_view green = "1;32";

struct Style {
  std::string_view word, colour;
};

Style style(Severity severity) {
  switch (severity) {
    case Severity::error:
      return {"error", "1;31"};
    case Severity::warning:
      return {"warning", "1;35"};
    case Severity::note:
      break;
  }
  return {"note", "1;36"};
}

/// The part of a source line that is shown, in bytes.
struct Window {
  std::size_t begin = 0, end = 0;
};

bool continues(std::string_view line, std::size_t position) {
  return position < line.size() && (static_cast<unsigned char>(line[position]) & 0xC0U) == 0x80U;
}

Window window(std::string_view line, std::size_t column) {
  if (line.size() <= widest_line) return {0, line.size()};
  Window shown;
  if (column > widest_line - kept_before) shown.begin = std::min(column, line.size()) - kept_before;
  shown.end = std::min(line.size(), shown.begin + widest_line);
  // At most three bytes continue a character; more is not UTF-8 and may be cut anywhere.
  for (int i = 0; i < 3 && continues(line, shown.begin); ++i) ++shown.begin;
  for (int i = 0; i < 3 && continues(line, shown.end); ++i) ++shown.end;
  return shown;
}

/// The quoted line and, below it, the caret line.
struct Quote {
  std::string text, caret;
};

Quote quote(std::string_view line, const Span& span) {
  const std::size_t first = span.column == 0 ? 0 : span.column - 1;
  const std::size_t last = first + std::max<std::size_t>(span.length, 1);
  const Window shown = window(line, first);
  Quote result;
  unsigned column = 0;
  const auto put = [&](std::string_view text, unsigned columns, bool marked) {
    result.text += text;
    column += columns;
    if (marked) result.caret.resize(column, result.caret.find('^') == std::string::npos ? ' ' : '~');
  };
  if (shown.begin > 0) put(cut, cut.size(), false);
  for (std::size_t i = shown.begin; i < shown.end;) {
    const CodePoint point = decode(line, i);
    Glyph seen = glyph(point);
    if (point.code == '\t') {
      seen.columns = tab_width - column % tab_width;
      seen.text.assign(seen.columns, ' ');
    }
    const bool marked = i >= first && i < last;
    if (marked && result.caret.empty()) result.caret = std::string(column, ' ') + "^";
    put(seen.text, seen.columns, marked);
    i += point.length;
  }
  if (result.caret.empty()) result.caret = std::string(column, ' ') + "^";
  if (shown.end < line.size()) put(cut, cut.size(), false);
  return result;
}

/// A message or hint, which may quote a name of any length.
std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 400;
  if (text.size() <= longest) return visible(text);
  std::size_t end = longest;
  for (int i = 0; i < 3 && continues(text, end); ++i) --end;
  return visible(std::string_view(text).substr(0, end)) + std::string(cut);
}

std::string location(const Diagnostic& diagnostic, const Diagnostics& source) {
  std::string result = visible(source.file_of(diagnostic.span.line)) + ":";
  if (diagnostic.span.line == 0) return result;
  return result + std::to_string(source.sources().at(diagnostic.span.line).line) + ":" +
         std::to_string(diagnostic.span.column) + ":";
}

std::string margin(const std::string& number) {
  constexpr std::size_t width = 5;
  return std::string(width - std::min(width, number.size()), ' ') + number + " | ";
}

std::string counted(std::size_t count, std::string_view word) {
  return std::to_string(count) + " " + std::string(word) + (count == 1 ? "" : "s");
}

std::string summary(const std::vector<Diagnostic>& all) {
  std::string result;
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    const auto count = std::count_if(all.begin(), all.end(),
                                     [severity](const Diagnostic& one) { return one.severity == severity; });
    if (count == 0) continue;
    if (!result.empty()) result += ", ";
    result += counted(static_cast<std::size_t>(count), style(severity).word);
  }
  return result.empty() ? result : result + "\n";
}

}  // namespace

std::string render(const Diagnostic& diagnostic, const Diagnostics& source, bool colour) {
  const Paint paint(colour);
  const Style shown = style(diagnostic.severity);
  std::string result = paint(bold, location(diagnostic, source)) + " " +
                       paint(shown.colour, std::string(shown.word) + " " + diagnostic.code + ":") + " " +
                       shortened(diagnostic.message) + "\n";
  if (diagnostic.span.line != 0) {
    const Quote lines = quote(source.line(diagnostic.span.line), diagnostic.span);
    result += margin(std::to_string(source.sources().at(diagnostic.span.line).line)) + lines.text + "\n";
    result += margin("") + paint(green, lines.caret) + "\n";
  }
  if (!diagnostic.hint.empty()) result += paint(cyan, "hint:") + " " + shortened(diagnostic.hint) + "\n";
  return result;
}

std::string render(const Diagnostics& diagnostics, bool colour) {
  const std::vector<Diagnostic> all = diagnostics.sorted();
  std::string result;
  for (const Diagnostic& one : all) result += render(one, diagnostics, colour);
  return result + summary(all);
}

}  // namespace tessera::diagnostics
