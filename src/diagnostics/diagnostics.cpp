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

std::string_view line_in(const std::string& text, const std::vector<std::size_t>& starts,
                         std::uint32_t number) {
  if (number == 0 || number > starts.size()) return {};
  const std::size_t begin = starts[number - 1];
  const std::size_t end = number < starts.size() ? starts[number] - 1 : text.size();
  std::string_view line = std::string_view(text).substr(begin, end - begin);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace

Diagnostics::Diagnostics(std::string file, std::string text)
    : Diagnostics(std::move(file), std::move(text), {}) {}

Diagnostics::Diagnostics(std::string file, std::string text, std::filesystem::path folder)
    : file_(std::move(file)),
      text_(std::move(text)),
      folder_(std::move(folder)),
      line_starts_(starts_of_lines(text_)) {}

Diagnostics Diagnostics::of_same_source() const {
  Diagnostics result(file_, text_, folder_);
  result.sources_ = sources_;
  result.included_ = included_;
  return result;
}

std::uint32_t Diagnostics::include(std::string name, std::string text) {
  const std::uint32_t before =
      included_.empty()
          ? static_cast<std::uint32_t>(line_starts_.size())
          : included_.back().before + static_cast<std::uint32_t>(included_.back().line_starts.size());
  std::vector<std::size_t> starts = starts_of_lines(text);
  included_.push_back({std::move(text), std::move(starts), before});
  sources_.add(std::filesystem::path(file_).filename().string(), std::move(name), before);
  return before;
}

void Diagnostics::adopt(const Diagnostics& included, std::uint32_t before) {
  for (Diagnostic one : included.all_) {
    // The file as a whole is told by its first line: line 0 is that of the given file.
    if (one.span.line == 0) one.span = {1, 1, 1};
    one.span.line += before;
    add(std::move(one));
  }
}

std::string Diagnostics::whole_text() const {
  std::string whole = text_;
  const std::vector<std::string> names = sources_.included();
  for (std::size_t at = 0; at < names.size(); ++at)
    whole += std::string(1, '\0') + names[at] + std::string(1, '\0') + included_[at].text;
  return whole;
}

std::string Diagnostics::file_of(std::uint32_t line) const {
  const SourceLine place = sources_.at(line);
  if (place.file.empty()) return file_;
  return (std::filesystem::path(file_).parent_path() / place.file).string();
}

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
  for (auto one = included_.rbegin(); one != included_.rend(); ++one)
    if (number > one->before) return line_in(one->text, one->line_starts, number - one->before);
  return line_in(text_, line_starts_, number);
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  std::vector<Diagnostic> result = all_;
  std::stable_sort(result.begin(), result.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return a.span.line < b.span.line; });
  return result;
}

}  // namespace tessera::diagnostics
