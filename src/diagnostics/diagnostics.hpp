#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "tessera/nearest.hpp"

namespace tessera::diagnostics {

/// A part of one line of a source text. Lines and columns count from 1; columns and lengths count bytes. A
/// span with line 0 means the file as a whole.
struct Span {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 1;

  auto operator<=>(const Span&) const = default;
};

enum class Severity : std::uint8_t { error, warning, note };

/// One message about a mistake in the user's input.
struct Diagnostic {
  Severity severity = Severity::error;
  std::string code;  ///< "E101"; the catalogue is docs/reference/diagnostics.md
  Span span;
  std::string message;                    ///< one line, lower case, no full stop
  std::string hint;                       ///< what to do about it; may be empty
  std::optional<std::string> proposal{};  ///< the name that the hint proposes to put in place of the span
};

/// Collects the diagnostics of one source text. A stage that finds a mistake goes on, so that
/// one run reports every mistake. A diagnostic that is reported twice (a template used by many
/// agents, an alias) is kept once.
///
/// Threads: one at a time.
class Diagnostics {
 public:
  /// file: the name to print; text: the whole source, kept to quote lines from.
  Diagnostics(std::string file, std::string text);

  void error(std::string code, Span span, std::string message, Hint hint = {});
  void warning(std::string code, Span span, std::string message, Hint hint = {});
  void note(std::string code, Span span, std::string message, Hint hint = {});

  [[nodiscard]] bool has_errors() const { return errors_ > 0; }
  [[nodiscard]] std::size_t error_count() const { return errors_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Line `number` (from 1) without its line end; "" if there is none.
  [[nodiscard]] std::string_view line(std::uint32_t number) const;

  /// In the order of their lines; those of one line in the order in which they were added.
  [[nodiscard]] std::vector<Diagnostic> sorted() const;

 private:
  void add(Diagnostic diagnostic);

  std::string file_;
  std::string text_;
  std::vector<std::size_t> line_starts_;
  std::vector<Diagnostic> all_;
  std::set<std::tuple<std::uint32_t, std::uint32_t, std::string, std::string>> seen_;
  std::size_t errors_ = 0;
};

/// One diagnostic as people read it: file:line:column, the source line (a long one is cut around the span),
/// a caret, the hint. colour: with ANSI colours.
[[nodiscard]] std::string render(const Diagnostic& diagnostic, const Diagnostics& source,
                                 bool colour = false);

/// All diagnostics as text, ending with a count ("2 errors, 1 warning") when there are any.
[[nodiscard]] std::string render(const Diagnostics& diagnostics, bool colour = false);

/// All diagnostics as a JSON array of {severity, code, file, line, column, length, message, hint}.
[[nodiscard]] std::string render_json(const Diagnostics& diagnostics);

}  // namespace tessera::diagnostics
