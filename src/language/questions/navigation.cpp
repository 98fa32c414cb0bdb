#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "language/language.hpp"
#include "language/names/sources.hpp"
#include "language/questions/place.hpp"
#include "spec/document/names.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

std::vector<CodeUse> uses_in(const Index& index, const Source& source) {
  if (source.path.ends_with(".yaml")) return uses_in_parameter_file(index, source.text);
  if (source.path.ends_with(".json")) return uses_in_layout_file(index, source.text);
  return uses_in_code(index, source.text);
}

/// The name under a cursor.
struct AtCursor {
  SymbolId symbol;
  Range range;
  bool defines = false;
  bool enumeration = false;  ///< in C++, the enumeration of the memory cell
};

std::optional<AtCursor> at_cursor(const Document& document, const Source* in, Position position) {
  if (in == nullptr) {
    const Use* use = document.index().at(document.lines().offset(position));
    if (use == nullptr) return std::nullopt;
    return AtCursor{use->symbol, document.lines().range(use->extent), use->defines};
  }
  const Lines lines(in->text);
  const std::size_t offset = lines.offset(position);
  for (const CodeUse& use : uses_in(document.index(), *in))
    if (use.sure && use.extent.touches(offset))
      return AtCursor{use.symbol, lines.range(use.extent), use.defines, use.enumeration};
  return std::nullopt;
}

Location definition_of(const Document& document, SymbolId symbol) {
  return {"", document.lines().range(document.index()[symbol].definition)};
}

/// The names beside that of `symbol`. The parser knows the other names that it may not equal.
std::vector<SymbolId> neighbours(const Index& index, SymbolId symbol) {
  const Symbol& own = index[symbol];
  std::vector<SymbolId> all;
  for (const SymbolId id : index.symbols().ids())
    if (id != symbol && index[id].owner == own.owner && index[id].kind == own.kind) all.push_back(id);
  return all;
}

std::multiset<std::string> errors_of(const std::string& text, const std::filesystem::path& folder,
                                     std::vector<diagnostics::Diagnostic>* all = nullptr) {
  diagnostics::Diagnostics out("spec.yaml", text, folder);
  (void)spec::parse(out);
  std::multiset<std::string> codes;
  for (const diagnostics::Diagnostic& one : out.sorted()) {
    if (one.severity != diagnostics::Severity::error) continue;
    codes.insert(one.code);
    if (all != nullptr) all->push_back(one);
  }
  return codes;
}

/// Why a specification with `edits` would be worse; nullopt: it is not.
std::optional<std::string> new_error(const Document& document, const std::vector<TextEdit>& edits) {
  const std::multiset<std::string> before = errors_of(document.text(), document.folder());
  std::vector<diagnostics::Diagnostic> found;
  const std::multiset<std::string> after = errors_of(edited(document, edits), document.folder(), &found);
  for (const diagnostics::Diagnostic& one : found)
    if (after.count(one.code) > before.count(one.code))
      return fmt::format("then line {} would be wrong: {} ({})", one.span.line, one.message, one.code);
  return std::nullopt;
}

/// Why a word that means something else in each subsystem keeps a symbol from being renamed; nullopt: there is none.
std::optional<std::string> shared_word(const Document& document, SymbolId symbol) {
  for (const SharedWord& word : document.index().shared_words())
    if (std::ranges::count(word.symbols, symbol) > 0)
      return fmt::format(
          "line {} names it, and in other subsystems something else of that name: rename it by hand, or give "
          "it by "
          "'with' if this is a template",
          document.lines().position(word.extent.begin).line + 1);
  return std::nullopt;
}

bool is_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// The line on which a word stands, but for comments that fill their line; 0: it does not.
std::size_t line_with(std::string_view text, std::string_view word) {
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view one = text.substr(begin, end - begin);
    ++line;
    begin = end + 1;
    if (const std::size_t first = one.find_first_not_of(" \t"); first != one.npos && one[first] == '#')
      continue;
    for (std::size_t at = one.find(word); at != one.npos; at = one.find(word, at + 1))
      if ((at == 0 || !is_of_name(one[at - 1])) &&
          (at + word.size() == one.size() || !is_of_name(one[at + word.size()])))
        return line;
  }
  return 0;
}

/// Why a name of a specification that includes files cannot be changed; nullopt: they do not have it.
std::optional<std::string> in_included_files(const Document& document, SymbolId id, const std::string& name) {
  const std::string files = included_files(document);
  if (files.empty()) return std::nullopt;
  const Symbol& symbol = document.index()[id];
  diagnostics::Diagnostics out("spec.yaml", document.text(), document.folder());
  (void)spec::parse(out);
  const std::vector<std::string> included = out.sources().included();
  const std::vector<diagnostics::Diagnostic> all = out.sorted();
  const bool unread = std::ranges::any_of(all, [](const diagnostics::Diagnostic& one) {
    return one.code == "E356" || one.code == "E357" || one.code == "E358" || one.code == "E361";
  });
  if (unread || included.empty())
    return fmt::format(
        "the specification includes {}, where the name may stand too: rename it by hand, and run "
        "`tessera check`",
        files);
  for (std::size_t file = 0; file < included.size(); ++file)
    for (const std::string& word : {symbol.name, name})
      if (const std::size_t line = line_with(out.included_text(file), word); line > 0)
        return fmt::format(
            "'{}' stands on line {} of {}, which the specification includes: rename it by hand, and "
            "run `tessera check`",
            word, line, included[file]);
  // The functions of its behaviours begin with its name, and are not known here.
  const std::string& use = node_at(document.outline(), symbol.way)["use"].text;
  if (symbol.kind == Kind::behaviour && !use.empty() && document.index().group_template(use) == nullptr)
    return fmt::format(
        "the behaviours of group '{}' stand in {}: rename it by hand, and its functions in C++", symbol.name,
        files);
  return std::nullopt;
}

/// The place at which the text means something else after an edit of names; nullopt: none.
std::optional<std::string> new_meaning(const Document& before, const Document& after) {
  const std::vector<Use>&old = before.index().uses(), &now = after.index().uses();
  for (std::size_t at = 0; at < std::max(old.size(), now.size()); ++at) {
    if (at < std::min(old.size(), now.size()) && old[at].symbol == now[at].symbol &&
        old[at].defines == now[at].defines)
      continue;
    const std::size_t place = at < old.size()   ? before.lines().position(old[at].extent.begin).line
                              : now.size() > at ? after.lines().position(now[at].extent.begin).line
                                                : 0;
    return fmt::format("then a word on line {} would mean something else", place + 1);
  }
  return std::nullopt;
}

}  // namespace

std::string included_files(const Document& document) {
  const Node& include = document.outline().root()["include"];
  std::vector<std::string> files;
  if (include.is_scalar()) files.push_back(include.text);
  for (const Entry& item : include.items) files.push_back(item.value->text);
  std::string text;
  for (std::size_t at = 0; at < files.size(); ++at)
    text += (at == 0 ? "" : at + 1 == files.size() ? " and " : ", ") + files[at];
  return text;
}

std::string edited(const Document& document, const std::vector<TextEdit>& edits) {
  std::vector<std::pair<Extent, std::string_view>> parts;
  for (const TextEdit& edit : edits)
    if (edit.path.empty())
      parts.push_back(
          {{document.lines().offset(edit.range.start), document.lines().offset(edit.range.end)}, edit.text});
  std::sort(parts.begin(), parts.end());
  std::string text;
  std::size_t at = 0;
  for (const auto& [extent, with] : parts) {
    if (extent.begin < at) continue;
    text += document.text().substr(at, extent.begin - at);
    text += with;
    at = extent.end;
  }
  return text + document.text().substr(at);
}

std::string edited(const Source& source, const std::vector<TextEdit>& edits) {
  std::vector<TextEdit> own;
  for (const TextEdit& edit : edits)
    if (edit.path == source.path && edit.sure) own.push_back(edit);
  // The last one comes first, so that the positions of the others stay valid.
  std::sort(own.begin(), own.end(), [](const TextEdit& a, const TextEdit& b) { return b.range < a.range; });
  std::string text = source.text;
  for (const TextEdit& edit : own) replace(text, edit.range, edit.text);
  return text;
}

Range range_of(const Document& document, const diagnostics::Span& span) {
  if (span.line == 0) return {};
  const std::size_t start = document.lines().start_of(span.line - 1);
  const std::size_t end = start + document.lines().line(span.line - 1).size();
  const std::size_t begin = std::min(start + (span.column == 0 ? 0 : span.column - 1), end);
  return document.lines().range({begin, std::min(begin + span.length, end)});
}

std::vector<Location> definition(const Document& document, Position position,
                                 std::span<const Source> sources) {
  const std::optional<AtCursor> here = at_cursor(document, nullptr, position);
  if (!here) return {};
  std::vector<Location> all;
  if (here->defines && document.index()[here->symbol].kind == Kind::behaviour) {
    for (const Source& source : sources) {
      const Lines lines(source.text);
      for (const CodeUse& use : uses_in(document.index(), source))
        if (use.symbol == here->symbol && use.defines) all.push_back({source.path, lines.range(use.extent)});
    }
  }
  if (all.empty()) all.push_back(definition_of(document, here->symbol));
  return all;
}

std::vector<Location> definition_from_code(const Document& document, const Source& source,
                                           Position position) {
  const std::optional<AtCursor> here = at_cursor(document, &source, position);
  if (!here) return {};
  return {definition_of(document, here->symbol)};
}

std::vector<Location> references(const Document& document, const Source* in, Position position,
                                 std::span<const Source> sources, bool with_definition) {
  const std::optional<AtCursor> here = at_cursor(document, in, position);
  if (!here) return {};
  std::vector<Location> all;
  for (const Use& use : document.index().uses())
    if (use.symbol == here->symbol && (with_definition || !use.defines))
      all.push_back({"", document.lines().range(use.extent)});
  for (const Source& source : sources) {
    const Lines lines(source.text);
    for (const CodeUse& use : uses_in(document.index(), source))
      if (use.symbol == here->symbol && use.sure) all.push_back({source.path, lines.range(use.extent)});
  }
  return all;
}

std::optional<Range> renameable(const Document& document, const Source* in, Position position) {
  const std::optional<AtCursor> here = at_cursor(document, in, position);
  if (!here || here->enumeration) return std::nullopt;
  // The control subsystem has its name from the format.
  const Symbol& symbol = document.index()[here->symbol];
  if (symbol.kind == Kind::subsystem && symbol.name == "control") return std::nullopt;
  return here->range;
}

Renaming rename(const Document& document, const Source* in, Position position,
                std::span<const Source> sources, const std::string& name) {
  const std::optional<AtCursor> here = at_cursor(document, in, position);
  if (!here) return {{}, "there is no name of the specification here"};
  const Index& index = document.index();
  const Symbol& symbol = index[here->symbol];
  if (here->enumeration)
    return {{},
            fmt::format("this enumeration has its name from the memory cell '{}'; rename that", symbol.name)};
  if (!renameable(document, in, position))
    return {{}, "'control' is the name that every control subsystem has"};
  if (name == symbol.name) return {};
  if (std::optional<std::string> problem = in_included_files(document, here->symbol, name))
    return {{}, std::move(problem)};
  diagnostics::Diagnostics judged("", name);
  if (!spec::check_name(name, {1, 1, 1}, words_of(symbol.kind), judged)) {
    const diagnostics::Diagnostic problem = judged.sorted().front();
    return {{}, problem.message + (problem.hint.empty() ? "" : "; " + problem.hint)};
  }
  for (const SymbolId other : neighbours(index, here->symbol))
    if (index[other].name == name)
      return {{},
              fmt::format("'{}' is taken by the {} on line {}", name, words_of(index[other].kind),
                          document.lines().position(index[other].definition.begin).line + 1)};
  Renaming renaming;
  for (const Use& use : index.uses())
    if (use.symbol == here->symbol)
      renaming.edits.push_back({"", document.lines().range(use.extent), name, true});
  if (std::optional<std::string> problem = new_error(document, renaming.edits))
    return {{}, std::move(problem)};
  if (std::optional<std::string> problem = shared_word(document, here->symbol))
    return {{}, std::move(problem)};
  const Document after(edited(document, renaming.edits), document.grammar());
  if (std::optional<std::string> problem = new_meaning(document, after)) return {{}, std::move(problem)};
  for (const Source& source : sources) {
    const Lines lines(source.text);
    for (const CodeUse& use : uses_in(index, source)) {
      const std::string old = index.enumeration_of(use.symbol);
      const std::string text = use.enumeration ? after.index().enumeration_of(use.symbol) : name;
      if (use.enumeration ? text != old : use.symbol == here->symbol)
        renaming.edits.push_back({source.path, lines.range(use.extent), text, use.sure});
    }
  }
  return renaming;
}

}  // namespace tessera::language
