#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "language/names/index.hpp"
#include "language/schema/grammar.hpp"
#include "language/text/lines.hpp"
#include "language/text/outline.hpp"

/// Answers what an editor asks about a specification while it is typed: any text, also one with mistakes.
///
/// The parser of the specification (spec/parser.hpp) judges a text. This module only finds names and places.
namespace tessera::language {

/// A file of the project beside the specification: C++, params.yaml, or the layout of the drawing (a file in JSON).
struct Source {
  std::string path;
  std::string text;
};

/// A part of a file. path: empty in the specification itself.
struct Location {
  std::string path;
  Range range;
};

struct Proposal {
  enum class Kind : std::uint8_t { key, word, type, name, example } kind = Kind::word;
  std::string label;
  std::string detail;         ///< one line
  std::string documentation;  ///< of a key: what the schema says
  Range range;                ///< what it replaces
  std::string insert;
};

/// The name of a page of the net, and the line that describes it, counted from 1.
struct PageName {
  std::string path;
  std::uint32_t line = 0;
};

struct Explanation {
  std::string markdown;
  Range range;
  PageName page;  ///< of an agent, subsystem or behaviour; an empty path: it has none
};

struct TextEdit {
  std::string path;  ///< empty: the specification
  Range range;
  std::string text;
  bool sure = true;  ///< false: only a compiler knows whether this is the same name
};

struct Renaming {
  std::vector<TextEdit> edits;
  std::optional<std::string> problem;  ///< why the name cannot be changed; nullopt: it can
};

/// An offer to correct something.
struct Fix {
  std::string title;
  std::vector<TextEdit> edits;
  std::string code;  ///< of the diagnostic that it corrects: "W324"; empty: none
  Range at;          ///< of that diagnostic
};

/// A name with the names inside it.
struct Heading {
  std::string name, detail;
  Kind kind = Kind::type;
  Range whole, name_range;
  std::vector<Heading> inside;
};

/// One text of a specification, with its names.
///
/// Threads: immutable; any.
class Document {
 public:
  /// grammar: outlives the document. folder: its included files are there; empty: it has none. Linear in the text.
  Document(std::string text, const Grammar& grammar, std::filesystem::path folder = {});
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const Lines& lines() const { return lines_; }
  [[nodiscard]] const Index& index() const { return index_; }
  [[nodiscard]] const Outline& outline() const { return outline_; }
  [[nodiscard]] const Grammar& grammar() const { return grammar_; }

 private:
  std::string text_;
  std::filesystem::path folder_;
  const Grammar& grammar_;
  Lines lines_;
  Outline outline_;
  Index index_;
};

/// The files of its `include`, for messages: "parts/docking.yaml and parts/types.yaml"; empty: there are none. Their
/// names are not in its index.
[[nodiscard]] std::string included_files(const Document& document);

/// The possible texts at the cursor, most likely first. At most 1000.
[[nodiscard]] std::vector<Proposal> complete(const Document& document, Position position);

/// The meaning of the word under the cursor. nullopt: it is unknown.
[[nodiscard]] std::optional<Explanation> explain(const Document& document, Position position);

/// The definition of the name at the cursor. At its definition itself: the transition function of a
/// behaviour.
[[nodiscard]] std::vector<Location> definition(const Document& document, Position position,
                                               std::span<const Source> sources);
/// The same for a cursor in a C++ source of the project.
[[nodiscard]] std::vector<Location> definition_from_code(const Document& document, const Source& source,
                                                         Position position);

/// All uses of the name at the cursor. in: nullptr if the cursor is in the specification, else the source that
/// it is in.
[[nodiscard]] std::vector<Location> references(const Document& document, const Source* in, Position position,
                                               std::span<const Source> sources, bool with_definition);

/// The range of the name at the cursor that can be renamed.
[[nodiscard]] std::optional<Range> renameable(const Document& document, const Source* in, Position position);

/// Gives the name at the cursor another one, in the specification and all sources. Refuses names that are taken or
/// not allowed, and whatever would bring the specification a new error, or another meaning. Refuses names that an
/// included file has too, and every name if these files cannot be read.
[[nodiscard]] Renaming rename(const Document& document, const Source* in, Position position,
                              std::span<const Source> sources, const std::string& name);

/// Offers for what is in `range`. found: the diagnostics of the text.
[[nodiscard]] std::vector<Fix> fixes(const Document& document, Range range,
                                     const std::vector<diagnostics::Diagnostic>& found);

/// The text with all edits of the specification.
[[nodiscard]] std::string edited(const Document& document, const std::vector<TextEdit>& edits);

/// The text of another file with those edits of it that are sure.
[[nodiscard]] std::string edited(const Source& source, const std::vector<TextEdit>& edits);

/// Edits after which a specification of an earlier version means what it meant then
/// (spec/model/former_routes.hpp).
struct Migration {
  struct Step {
    std::string behaviour;   ///< "robot.control.grab"
    diagnostics::Span span;  ///< of its name
    std::string to;          ///< where an error or a failure leads again
    TextEdit edit;
  };
  struct ByHand {
    std::string behaviour;
    diagnostics::Span span;
    std::string why;
  };
  std::vector<Step> steps;
  std::vector<ByHand> by_hand;  ///< what the author has to decide
};
/// Comments, order, style and aliases stay. The edited text has been read again: it means the same but for these
/// entries. only: the steps of the subsystem alone in which that span of a behaviour, or of an entry of its `next`,
/// lies.
/// nullopt: the text has errors.
[[nodiscard]] std::optional<Migration> migrate(const Document& document,
                                               std::optional<diagnostics::Span> only = std::nullopt);

/// A specification in its shorter form: `on_error`, `send`, `receive` and `conditions` of subsystems stand for what
/// their behaviours repeat.
struct Shortened {
  std::string text;
  std::vector<std::string> done;  ///< "robot.control: on_error: safe, for 11 behaviours"; empty: nothing
};
/// Comments, order and style of everything else stay. All behaviours are the same, entry by entry, and so is the net.
///
/// Shape:  the text is read several times for each behaviour.
/// nullopt: it has errors.
[[nodiscard]] std::optional<Shortened> shortened(const std::string& text);

/// All names as a tree.
[[nodiscard]] std::vector<Heading> headings(const Document& document);

/// The range of a diagnostic: its columns count bytes from 1.
[[nodiscard]] Range range_of(const Document& document, const diagnostics::Span& span);

}  // namespace tessera::language
