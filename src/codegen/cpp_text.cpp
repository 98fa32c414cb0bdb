#include "codegen/cpp_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "spec/conditions/tokens.hpp"

namespace tessera::codegen {
namespace {

constexpr std::string_view off = "// clang-format off\n";
constexpr std::string_view on = "// clang-format on\n";

constexpr std::array scalar_names{"bool",          "std::int8_t",  "std::int16_t",  "std::int32_t",
                                  "std::int64_t",  "std::uint8_t", "std::uint16_t", "std::uint32_t",
                                  "std::uint64_t", "float",        "double"};

/// The period of std::chrono::duration for a unit of time.
constexpr auto periods =
    std::to_array<std::pair<std::string_view, std::string_view>>({{"h", "std::ratio<3600>"},
                                                                  {"min", "std::ratio<60>"},
                                                                  {"s", "std::ratio<1>"},
                                                                  {"ms", "std::milli"},
                                                                  {"us", "std::micro"},
                                                                  {"ns", "std::nano"}});

std::string element_name(const spec::Model& model, const spec::Type& type,
                         const std::set<std::string_view>& hidden) {
  switch (type.kind) {
    case spec::Type::Kind::scalar:
      return scalar_names[static_cast<std::size_t>(type.scalar)];
    case spec::Type::Kind::string:
      return fmt::format("tessera::BoundedString<{}>", type.capacity);
    case spec::Type::Kind::structure:
      break;
  }
  const std::string& name = model.structures[type.structure].name;
  return hidden.contains(name) ? fmt::format("::{}::{}", model.system, name) : name;
}

/// Whether copies of it had better share their elements: those of 4 KB and more, structures counted
/// as 16 bytes.
bool is_large(const spec::Type& type) {
  const std::uint64_t element = type.kind == spec::Type::Kind::scalar   ? bytes_of(type.scalar)
                                : type.kind == spec::Type::Kind::string ? type.capacity
                                                                        : 16;
  return element * type.extent >= 4096;
}

/// The end of the run of commented lines that starts at `begin`.
std::size_t end_of_run(const std::vector<Declaration>& lines, std::size_t begin) {
  std::size_t end = begin;
  while (end < lines.size() && !lines[end].comment.empty()) ++end;
  return end;
}

/// Comments behind the code, aligned; above it where the column limit leaves no room.
void add_run(std::span<const Declaration> lines, const std::string& indent, std::string& out) {
  std::size_t code = 0, comment = 0;
  for (const Declaration& line : lines) {
    code = std::max(code, line.code.size());
    comment = std::max(comment, line.comment.size());
  }
  const bool fits = indent.size() + code + 5 + comment <= column_limit;
  for (const Declaration& line : lines) {
    if (fits)
      out += fmt::format("{}{:<{}}  // {}\n", indent, line.code, code, line.comment);
    else
      out += fmt::format("{0}// {1}\n{0}{2}\n", indent, line.comment, line.code);
  }
}

}  // namespace

std::string type_name(const spec::Model& model, const spec::Type& type,
                      const std::set<std::string_view>& hidden) {
  std::string element = element_name(model, type, hidden);
  if (type.extent == 0) return element;
  if (type.is_sequence)
    return fmt::format("tessera::{}<{}, {}>", is_large(type) ? "LargeSequence" : "BoundedSequence", element,
                       type.extent);
  return fmt::format("{}<{}, {}>", is_large(type) ? "tessera::LargeArray" : "std::array", element,
                     type.extent);
}

void add_headers(const spec::Type& type, std::set<std::string>& headers) {
  if (type.extent != 0)
    headers.insert(type.is_sequence
                       ? (is_large(type) ? "<tessera/large_sequence.hpp>" : "<tessera/bounded_sequence.hpp>")
                   : is_large(type) ? "<tessera/large_array.hpp>"
                                    : "<array>");
  if (type.kind == spec::Type::Kind::string) headers.insert("<tessera/bounded_string.hpp>");
  if (type.kind == spec::Type::Kind::scalar && type.scalar >= Scalar::int8 && type.scalar <= Scalar::uint64)
    headers.insert("<cstdint>");
}

std::string include_block(const std::set<std::string>& headers) {
  std::string out;
  for (const std::string& header : headers) out += fmt::format("#include {}\n", header);
  if (!out.empty()) out += '\n';
  return out;
}

std::string duration(spec::Duration value) {
  using Unit = std::pair<std::int64_t, const char*>;
  constexpr std::array units{Unit{1'000'000'000, "s"}, Unit{1'000'000, "ms"}, Unit{1000, "us"}};
  for (const auto& [nanoseconds, suffix] : units)
    if (value.count() % nanoseconds == 0) return fmt::format("{}{}", value.count() / nanoseconds, suffix);
  return fmt::format("{}ns", value.count());
}

std::string string_literal(std::string_view text) {
  std::string out = "\"";
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if (character == '"' || character == '\\')
      (out += '\\') += character;
    else if (byte < 0x20 || byte == 0x7f)
      out += fmt::format("\\{:03o}", byte);
    else
      out += character;
  }
  return out += '"';
}

std::string condition_text(const spec::Expression& expression) {
  std::string text = spec::with_cpp_durations(expression.text);
  for (std::size_t at = expression.times.size(); at-- > 0;) {  // from the back, so that positions stay
    const spec::Expression::TimeNumber& number = expression.times[at];
    const auto* const period =
        std::ranges::find(periods, number.unit, [](const auto& one) { return one.first; });
    text.insert(number.end, ")");
    text.insert(number.begin, fmt::format("std::chrono::duration<double, {}>(", period->second));
  }
  return text;
}

std::string comment_text(std::string_view text) {
  std::string out(text);
  for (char& character : out) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x20 || byte == 0x7f || character == '\\') character = '?';  // no line ends, no continuations
  }
  return out;
}

std::string declarations(const std::vector<Declaration>& lines, std::size_t indent) {
  const std::string margin(indent, ' ');
  std::string out;
  for (std::size_t line = 0; line < lines.size();) {
    const std::size_t end = end_of_run(lines, line);
    add_run(std::span(lines).subspan(line, end - line), margin, out);
    if (end < lines.size()) out += fmt::format("{}{}\n", margin, lines[end].code);
    line = end + 1;
  }
  return out;
}

std::string structure(std::string_view name, const std::vector<Declaration>& members, std::string_view tail) {
  if (members.empty() && tail.empty()) return fmt::format("struct {} {{}};\n", name);
  return fmt::format("struct {} {{\n{}{}}};\n", name, declarations(members), tail);
}

std::string enumeration(std::string_view prefix, const std::vector<std::string_view>& names) {
  std::string out = fmt::format("{} {{ {} }};\n", prefix, fmt::join(names, ", "));
  if (out.size() - 1 <= column_limit) return out;
  out = fmt::format("{} {{\n", prefix);
  for (const std::string_view name : names) out += fmt::format("  {},\n", name);
  return out += "};\n";
}

std::string member_function(std::string_view head, const std::vector<std::string>& statements) {
  if (statements.empty()) return fmt::format("  {} {{}}\n", head);
  std::string out = fmt::format("  {} {{ {} }}\n", head, statements.front());
  if (statements.size() == 1 && out.size() - 1 <= column_limit) return out;
  out = fmt::format("  {} {{\n", head);
  for (const std::string& statement : statements) out += fmt::format("    {}\n", statement);
  return out += "  }\n";
}

std::string keep_formatter_off_long_lines(std::string text) {
  bool fenced = false, too_long = false;
  std::string rest;  // without switches for the formatter
  for (std::size_t begin = text.find('\n') + 1; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    const std::string_view line(text.data() + begin, end - begin);
    if (line == off || line == on)
      fenced = line == off;
    else
      rest += line;
    too_long = too_long || (!fenced && line.size() - 1 > column_limit);
    begin = end;
  }
  if (!too_long) return text;
  text.resize(text.find('\n') + 1);
  return ((text += off) += rest) += on;
}

}  // namespace tessera::codegen
