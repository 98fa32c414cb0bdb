#include "language/edits/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "diagnostics/diagnostics.hpp"
#include "spec/document/document.hpp"

namespace tessera::language {
namespace {

bool one_of(std::string_view all, char c) { return all.find(c) != std::string_view::npos; }

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first);
}

/// -0.5, .5, 2., 1e-3. sign: also +1.
bool is_number(std::string_view text, bool sign) {
  if (sign && text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  // from_chars also accepts "inf", "nan" and similar texts.
  if (text.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return false;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error != std::errc::invalid_argument && end == text.data() + text.size();
}

/// Whether YAML reads the plain text as something else than text, so that a text needs quotes.
bool is_no_text(std::string_view text) {
  constexpr std::string_view words[] = {"",     "~",    "null",  "Null",  "NULL", "true",
                                        "True", "TRUE", "false", "False", "FALSE"};
  if (std::find(std::begin(words), std::end(words), text) != std::end(words)) return true;
  if (is_number(text, true)) return true;
  const bool based = text.size() > 2 && text[0] == '0' && (text[1] == 'o' || text[1] == 'x');
  if (based && text.find_first_not_of("0123456789abcdefABCDEF", 2) == std::string_view::npos) return true;
  const std::string_view unsigned_text =
      !text.empty() && (text[0] == '-' || text[0] == '+') ? text.substr(1) : text;
  constexpr std::string_view special[] = {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN"};
  return std::find(std::begin(special), std::end(special), unsigned_text) != std::end(special);
}

/// Whether a text can be written without quotes inside a flow, and so everywhere.
bool can_be_plain(std::string_view text) {
  if (text.empty() || is_no_text(text)) return false;
  if (text.find_first_of(",[]{}\n\r") != std::string_view::npos) return false;
  if (one_of(" \t#&*!|>'\"%@`", text[0]) || text == "?" || text == "-") return false;
  if ((text[0] == '?' || text[0] == '-') && text.size() > 1 && one_of(" \t", text[1])) return false;
  if (one_of(" \t:-", text.back())) return false;
  for (std::size_t at = 0; at + 1 < text.size(); ++at) {
    if (text[at] == ':' && one_of(" \t", text[at + 1])) return false;
    if (one_of(" \t", text[at]) && text[at + 1] == '#') return false;
  }
  return std::none_of(text.begin(), text.end(), [](char c) { return c >= 0 && c < ' '; });
}

std::string in_single_quotes(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

/// Whether the text can be read as one flow, with those aliases.
bool is_flow(std::string_view text, const std::vector<std::string>& anchors) {
  std::string whole = "[";
  for (const std::string& name : anchors) whole += "&" + name + " 0, ";
  diagnostics::Diagnostics out("", whole + std::string(text) + "]");
  const std::optional<spec::Document> read = spec::read_document(out);
  return read && !out.has_errors() && read->root().items.size() == anchors.size() + 1;
}

bool is_known_alias(std::string_view text, const std::vector<std::string>& anchors) {
  return text.starts_with('*') && std::find(anchors.begin(), anchors.end(), text.substr(1)) != anchors.end();
}

/// The parts between commas that are in no brackets and no quotes.
std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  char quote = '\0';
  for (const char c : text) {
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (one_of("([{", c)) {
      ++depth;
    } else if (one_of(")]}", c)) {
      --depth;
    }
    if (c == ',' && depth == 0 && quote == '\0')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  std::vector<std::string> filled;
  for (const std::string& part : parts)
    if (const std::string_view kept = without_blanks(part); !kept.empty()) filled.emplace_back(kept);
  return filled;
}

bool is_in_quotes(std::string_view text) {
  return text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
}

}  // namespace

std::string quoted_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      quoted += {'\\', c};
    else if (c == '\n')
      quoted += "\\n";
    else if (c == '\t')
      quoted += "\\t";
    else if (c >= 0 && c < ' ')
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned>(c));
    else
      quoted += c;
  }
  return quoted + "\"";
}

std::string scalar_text(std::string_view text, const std::vector<std::string>& anchors) {
  const std::string_view kept = without_blanks(text);
  if (is_known_alias(kept, anchors) || kept == "true" || kept == "false" || is_number(kept, false))
    return std::string(kept);
  if (!kept.empty() && one_of("[{", kept.front()) && is_flow(kept, anchors)) return std::string(kept);
  if (can_be_plain(kept)) return std::string(kept);
  const bool single = kept.find('"') != std::string_view::npos && kept.find('\'') == std::string_view::npos &&
                      std::none_of(kept.begin(), kept.end(), [](char c) { return c >= 0 && c < ' '; });
  return single ? in_single_quotes(kept) : quoted_text(kept);
}

std::string list_text(std::string_view text, const std::vector<std::string>& anchors) {
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() < 2) return scalar_text(text, anchors);
  std::string list;
  for (const std::string& part : parts)
    list += (list.empty() ? "" : ", ") + (is_in_quotes(part) ? part : scalar_text(part, anchors));
  return "[" + list + "]";
}

std::string flow_parts(const Value& value) {
  std::string inside;
  for (std::size_t at = 0; at < value.items.size(); ++at) {
    if (at > 0) inside += ", ";
    if (value.kind == Value::Kind::map) inside += value.keys[at] + ": ";
    inside += flow_text(value.items[at]);
  }
  return inside;
}

std::string flow_text(const Value& value) {
  if (value.kind == Value::Kind::text) return value.text;
  if (value.kind == Value::Kind::list) return "[" + flow_parts(value) + "]";
  return value.items.empty() ? "{}" : "{ " + flow_parts(value) + " }";
}

std::string block_text(const Value& value, std::size_t indent, std::string_view end) {
  if (value.kind == Value::Kind::text || value.items.empty()) return " " + flow_text(value);
  std::string lines;
  for (std::size_t at = 0; at < value.items.size(); ++at) {
    lines += std::string(end) + std::string(indent, ' ');
    lines += value.kind == Value::Kind::list
                 ? "- " + flow_text(value.items[at])
                 : value.keys[at] + ":" + block_text(value.items[at], indent + 2, end);
  }
  return lines;
}

}  // namespace tessera::language
