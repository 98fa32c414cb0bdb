#include "spec/document/names.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "diagnostics/utf8.hpp"
#include "spec/document/cpp_names.hpp"

namespace tessera::spec {
namespace {

constexpr std::size_t longest_name = 64;

/// Names that the generated code uses beside the transition functions.
constexpr std::array beside_functions =
    std::to_array<std::string_view>({"Context", "Inputs", "Outputs", "Memory", "Parameters", "Real"});

constexpr std::array keywords = std::to_array<std::string_view>(
    {"alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
     "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char16_t",
     "char32_t",    "char8_t",  "class",      "co_await",  "co_return", "co_yield",     "compl",
     "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
     "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
     "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
     "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
     "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
     "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
     "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
     "static_cast", "struct",   "switch",     "template",  "this",      "thread_local", "throw",
     "true",        "try",      "typedef",    "typeid",    "typename",  "union",        "unsigned",
     "using",       "virtual",  "void",       "volatile",  "wchar_t",   "while",        "xor",
     "xor_eq"});

/// Names that generated code and every transition function need.
constexpr std::array taken = std::to_array<std::string_view>({"std", "tessera", "main"});
constexpr std::array our_prefixes = std::to_array<std::string_view>({"tessera_", "TESSERA_"});

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// `name` with everything that C++ does not allow replaced; "" if nothing useful is left.
std::string repaired(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool good = is_letter(c) || is_digit(c);
    if (good && c != '_') {
      result += c;
    } else if (!result.empty() && result.back() != '_') {
      result += '_';
    }
  }
  while (result.ends_with('_')) result.pop_back();
  return is_identifier(result) && result.size() <= longest_name ? result : std::string();
}

std::string with_agent_number(std::string_view name) { return "for example '" + std::string(name) + "_1'"; }

std::string write_it(std::string_view name) {
  const std::string better = repaired(name);
  return better.empty() ? "names are letters, digits and single underscores, and begin with a letter"
                        : "for example '" + better + "'";
}

}  // namespace

bool is_identifier(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

bool is_keyword(std::string_view word) { return contains(keywords, word); }

bool check_name(std::string_view name, diagnostics::Span span, std::string_view what,
                diagnostics::Diagnostics& out) {
  const std::string subject = std::string(what) + " name " + diagnostics::in_quotes(name);
  if (name.empty()) {
    out.error("E105", span, "a " + std::string(what) + " needs a name");
  } else if (!is_identifier(name)) {
    out.error("E105", span, subject + " is not an identifier of C++", write_it(name));
  } else if (name.size() > longest_name) {
    out.error("E105", span, subject + " is longer than " + std::to_string(longest_name) + " characters");
  } else if (name.front() == '_' || name.find("__") != std::string_view::npos) {
    out.error("E105", span, subject + ": leading and double underscores belong to the compiler",
              write_it(name));
  } else if (contains(keywords, name)) {
    out.error("E106", span, subject + " is a keyword of C++", with_agent_number(name));
  } else if (contains(taken, name)) {
    out.error("E106", span, subject + " is taken by the generated code", with_agent_number(name));
  } else if (std::ranges::any_of(our_prefixes, [&](auto prefix) { return name.starts_with(prefix); })) {
    out.error("E106", span, subject + ": names that begin with 'tessera_' belong to the generated code",
              "choose another beginning");
  } else if (is_macro(name)) {
    out.error("E106", span, subject + " is a macro of the C or C++ library", with_agent_number(name));
  } else {
    return true;
  }
  return false;
}

bool check_system_name(std::string_view name, diagnostics::Span span, diagnostics::Diagnostics& out) {
  if (!check_name(name, span, "system", out)) return false;
  if (!is_global_name(name)) return true;
  out.error("E106", span, "system name " + diagnostics::in_quotes(name) + " is taken by the C or C++ library",
            with_agent_number(name));
  return false;
}

bool check_behaviour_name(std::string_view name, diagnostics::Span span, diagnostics::Diagnostics& out) {
  const bool is_generated = std::ranges::find(beside_functions, name) != beside_functions.end();
  if (name == "end")
    out.error("E106", span, "behaviour name 'end' is reserved", "'next: end' ends the subsystem");
  else if (is_generated)
    out.error("E106", span,
              "behaviour name " + diagnostics::in_quotes(name) + " is taken by the generated code");
  else
    return check_name(name, span, "behaviour", out);
  return false;
}

}  // namespace tessera::spec
