#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "diagnostics/sources.hpp"
#include "tessera/nearest.hpp"

namespace tessera::diagnostics {

/// A part of one line of a source text. Lines and columns count from 1; columns and lengths count bytes. A
/// span with line 0 means the file as a whole. A line may be one of an included file: Sources knows which.
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

/// Collects the diagnostics of one source text, with the files that it includes. A stage that finds a mistake goes on, so that
/// one run reports every mistake. A diagnostic that is reported twice (a template used by many
/// agents, an alias) is kept once.
///
/// Threads: one at a time.
class Diagnostics {
 public:
  /// file: the name to print; text: the whole source, kept to quote lines from.
  Diagnostics(std::string file, std::string text);
  /// The same. folder: the included files of the text are there. Without a folder the text can include none.
  Diagnostics(std::string file, std::string text, std::filesystem::path folder);

  /// The same source, with its included files, and no diagnostic.
  [[nodiscard]] Diagnostics of_same_source() const;

  /// Appends a file that the text includes. name: relative to the folder. Returns how many lines stand before it.
  std::uint32_t include(std::string name, std::string text);
  /// Adds the diagnostics of an included file, which count its own lines; `before` as include() returned it.
  void adopt(const Diagnostics& included, std::uint32_t before);

  void report(Diagnostic one) { add(std::move(one)); }
  void error(std::string code, Span span, std::string message, Hint hint = {});
  void warning(std::string code, Span span, std::string message, Hint hint = {});
  void note(std::string code, Span span, std::string message, Hint hint = {});

  [[nodiscard]] bool has_errors() const { return errors_ > 0; }
  [[nodiscard]] std::size_t error_count() const { return errors_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// The text of the given file alone.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// That text and those of the included files with their names: what the meaning of the source depends on.
  [[nodiscard]] std::string whole_text() const;
  /// The folder of the included files; empty: there is none.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const Sources& sources() const { return sources_; }
  /// The text of a file of sources().included().
  [[nodiscard]] const std::string& included_text(std::size_t number) const { return included_[number].text; }
  /// The file of a line as messages name it: file(), or the included file beside it.
  [[nodiscard]] std::string file_of(std::uint32_t line) const;
  /// As Sources::words.
  [[nodiscard]] std::string words(Span span) const { return sources_.words(span.line); }
  [[nodiscard]] std::string words(std::uint32_t line) const { return sources_.words(line); }
  /// Line `number` (from 1) without its line end; "" if there is none.
  [[nodiscard]] std::string_view line(std::uint32_t number) const;

  /// In the order of their lines; those of one line in the order in which they were added.
  [[nodiscard]] std::vector<Diagnostic> sorted() const;

 private:
  /// A text with the beginnings of its lines.
  struct Text {
    std::string text;
    std::vector<std::size_t> line_starts;
    std::uint32_t before = 0;  ///< lines of the source before its first one
  };
  void add(Diagnostic diagnostic);

  std::string file_;
  std::string text_;
  std::filesystem::path folder_;
  std::vector<std::size_t> line_starts_;
  Sources sources_;
  std::vector<Text> included_;  ///< those of `sources_`
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
