#include "diagnostics/diagnostics.hpp"

#include <algorithm>
#include <utility>

namespace tessera::diagnostics {
namespace {

std::vector<std::size_t> starts_of_lines(const std::string& text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', end + 1)) {
    starts.push_back(end + 1);
  }
  return starts;
}

}  // namespace

Diagnostics::Diagnostics(std::string file, std::string text)
    : file_(std::move(file)), text_(std::move(text)), line_starts_(starts_of_lines(text_)) {}

void Diagnostics::error(std::string code, Span span, std::string message, Hint hint) {
  add({Severity::error, std::move(code), span, std::move(message), std::move(hint.text),
       std::move(hint.proposal)});
}

void Diagnostics::warning(std::string code, Span span, std::string message, Hint hint) {
  add({Severity::warning, std::move(code), span, std::move(message), std::move(hint.text),
       std::move(hint.proposal)});
}

void Diagnostics::note(std::string code, Span span, std::string message, Hint hint) {
  add({Severity::note, std::move(code), span, std::move(message), std::move(hint.text),
       std::move(hint.proposal)});
}

void Diagnostics::add(Diagnostic diagnostic) {
  // An error that was reported before counts too: a part that is read twice, through an alias, is wrong both
  // times.
  if (diagnostic.severity == Severity::error) ++errors_;
  const auto key =
      std::tie(diagnostic.span.line, diagnostic.span.column, diagnostic.code, diagnostic.message);
  if (!seen_.emplace(key).second) return;
  all_.push_back(std::move(diagnostic));
}

std::string_view Diagnostics::line(std::uint32_t number) const {
  if (number == 0 || number > line_starts_.size()) return {};
  const std::size_t begin = line_starts_[number - 1];
  const std::size_t end = number < line_starts_.size() ? line_starts_[number] - 1 : text_.size();
  std::string_view text = std::string_view(text_).substr(begin, end - begin);
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  std::vector<Diagnostic> result = all_;
  std::stable_sort(result.begin(), result.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return a.span.line < b.span.line; });
  return result;
}

}  // namespace tessera::diagnostics
