#include "spec/document/syntax_errors.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/exceptions.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "spec/document/document.hpp"

namespace tessera::spec {
namespace {

struct Explanation {
  std::string_view theirs, ours, hint;
};

constexpr std::string_view brackets_hint =
    "inside { } and [ ], text with brackets or commas needs quotes: \"float64[8]\"";
constexpr std::string_view indent_hint =
    "entries of one map begin in the same column; text with ': ' in it needs quotes";

constexpr std::array explanations = {
    Explanation{"illegal map value", "a second ': ' on this line, or wrong indentation", indent_hint},
    Explanation{"illegal map key", "a key may not begin here", indent_hint},
    Explanation{"illegal block entry", "a list entry '- ' may not begin here",
                "begin the list on its own line"},
    Explanation{"end of map not found", "this does not continue the map above it", indent_hint},
    Explanation{"end of sequence not found", "this does not continue the list above it",
                "entries of one list begin with '- ' in the same column"},
    Explanation{"end of map flow not found", "a '{' is not closed, or something in it needs quotes",
                brackets_hint},
    Explanation{"end of sequence flow not found", "a '[' is not closed, or something in it needs quotes",
                brackets_hint},
    Explanation{"the referenced anchor is not defined", "this alias names no anchor above it", ""},
    Explanation{"alias not found after *", "'*' begins an alias, and its name is missing",
                "put text that begins with * in quotes"},
};

bool indented_by_tab(std::string_view line) {
  const std::size_t text = line.find_first_not_of(" \t");
  return line.substr(0, text).find('\t') != std::string_view::npos;
}

/// The span of the error, moved to the last line with text if it is the end of the file.
Span span_of(const YAML::Mark& mark, const Diagnostics& out) {
  Span span{1, 1, 1};
  if (mark.line >= 0) {
    span = {static_cast<std::uint32_t>(mark.line) + 1,
            static_cast<std::uint32_t>(std::max(mark.column, 0)) + 1, 1};
  }
  while (span.line > 1 && out.line(span.line).find_first_not_of(" \t") == std::string_view::npos) {
    --span.line;
    span.column = static_cast<std::uint32_t>(out.line(span.line).size()) + 1;
  }
  return span;
}

}  // namespace

void report_syntax_error(const YAML::Exception& problem, Diagnostics& out) {
  const Span span = span_of(problem.mark, out);
  if (dynamic_cast<const YAML::DeepRecursion*>(&problem) != nullptr) {
    out.error("E007", span, "nested more than " + std::to_string(deepest) + " levels deep");
    return;
  }
  const std::string_view line = out.line(span.line);
  if (indented_by_tab(line)) {
    const auto tab = static_cast<std::uint32_t>(line.find('\t')) + 1;
    out.error("E005", {span.line, tab, 1}, "a tab may not indent", "indent with spaces");
    return;
  }
  const auto* const known = std::find_if(explanations.begin(), explanations.end(),
                                         [&](const Explanation& one) { return one.theirs == problem.msg; });
  if (known == explanations.end()) {
    out.error("E005", span, "this is not YAML: " + problem.msg);
  } else {
    out.error("E005", span, std::string(known->ours), std::string(known->hint));
  }
}

}  // namespace tessera::spec
