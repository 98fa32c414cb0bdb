#include "spec/document/text_checks.hpp"

#include <algorithm>
#include <string_view>

#include "diagnostics/source.hpp"
#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

bool is_forbidden(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
}

diagnostics::Span span_at(const std::string& text, std::size_t position) {
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n');
  const std::size_t start = position == 0 ? std::string::npos : text.rfind('\n', position - 1);
  const std::size_t column = start == std::string::npos ? position : position - start - 1;
  return {static_cast<std::uint32_t>(line) + 1, static_cast<std::uint32_t>(column) + 1, 1};
}

bool check_lines(diagnostics::Diagnostics& out) {
  const std::string_view text = out.text();
  std::uint32_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > longest_line) {
      out.error("E011", {line, 1, 1}, "this line is longer than 1 MB: it cannot be a specification");
      return false;
    }
    begin = end + 1;
  }
  return true;
}

}  // namespace

bool check_text(diagnostics::Diagnostics& out) {
  const std::string& text = out.text();
  if (diagnostics::is_xml(text)) {
    out.error("E005", {1, 1, 1}, "this is XML, and a specification is YAML",
              "`tessera verify` and `tessera simulate` read nets in PNML; a model of a world stands under "
              "`simulation`");
    return false;
  }
  const auto control = std::find_if(text.begin(), text.end(), is_forbidden);
  if (control != text.end()) {
    const auto position = static_cast<std::size_t>(control - text.begin());
    out.error("E003", span_at(text, position), "a control character: this is not a text file");
    return false;
  }
  if (const auto position = diagnostics::first_invalid_byte(text)) {
    out.error("E004", span_at(text, *position), "this byte is not UTF-8",
              "save the file in the encoding UTF-8");
    return false;
  }
  return check_lines(out);
}

}  // namespace tessera::spec
