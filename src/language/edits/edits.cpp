#include "language/edits/edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "language/edits/elements.hpp"
#include "language/names/code.hpp"
#include "spec/document/document.hpp"

namespace tessera::language {
namespace {

constexpr const char* not_there =
    "the text has changed: there is nothing of that name to change here any more";

/// An edit changes no included file; behind what is not found.
std::string perhaps_included(const Document& document) {
  const std::string files = included_files(document);
  return files.empty() ? files : "; what stands in " + files + " is changed there, by hand";
}

/// Whether a path leads into a type or template that this text does not have, so that only an included file may have it.
bool leads_elsewhere(const Document& document, const Path& at) {
  if (at.size() < 2 || included_files(document).empty()) return false;
  const std::string *section = key_of(at[0]), *name = key_of(at[1]);
  return section != nullptr && name != nullptr && (*section == "types" || *section == "templates") &&
         document.outline().root()[*section].find(*name) == nullptr;
}

bool next_changed(TextEditor& editor, const Edit& edit) {
  if (editor.entry(edit.at) == nullptr) return false;
  if (edit.key.empty()) return add_next(editor, edit.at, edit.fields);
  std::size_t entry = 0;
  const char* const last = edit.key.data() + edit.key.size();
  const auto [end, problem] = std::from_chars(edit.key.data(), last, entry);
  return problem == std::errc() && end == last && change_next(editor, edit.at, entry, edit.fields);
}

/// false: there is nothing to change.
bool changed(const Document& document, TextEditor& editor, const Edit& edit) {
  switch (edit.kind) {
    case Edit::Kind::set:
      return editor.set(edit.at, edit.key, edit.text, edit.as);
    case Edit::Kind::insert:
      return editor.insert(edit.at, edit.key, edit.value);
    case Edit::Kind::append:
      return editor.append(edit.at, flow_text(edit.value));
    case Edit::Kind::replace:
      return editor.replace(edit.at, flow_text(edit.value));
    case Edit::Kind::remove:
      return remove_with_uses(document, editor, edit.at);
    case Edit::Kind::connect:
      return editor.append({"channels"}, channel_text(edit.fields));
    case Edit::Kind::channel:
      return change_channel(editor, edit.at, edit.fields);
    case Edit::Kind::next:
      return next_changed(editor, edit);
    case Edit::Kind::make_template:
      return make_template(editor, edit.at);
    case Edit::Kind::move:
    case Edit::Kind::copy:
    case Edit::Kind::paste:
    case Edit::Kind::rename:
      break;
  }
  return false;
}

/// Why an edit cannot be done; nullopt: the editor has its text.
std::optional<std::string> problem_with(const Document& document, TextEditor& editor, const Edit& edit) {
  if (leads_elsewhere(document, edit.at)) return not_there + perhaps_included(document);
  if ((edit.kind == Edit::Kind::insert || edit.kind == Edit::Kind::paste) &&
      editor.entry(edit.at / edit.key) != nullptr)
    return fmt::format("'{}' is there already", edit.key);
  if (edit.kind == Edit::Kind::remove)
    if (std::optional<std::string> why = needed_by(document, editor, edit.at)) return why;
  if (edit.kind == Edit::Kind::move) return move_to_group(editor, edit.at, edit.text);
  if (edit.kind == Edit::Kind::copy) return copy_element(document, editor, edit.at, edit.key);
  if (edit.kind == Edit::Kind::paste) return paste_element(editor, edit.at, edit.key, edit.text);
  if (changed(document, editor, edit)) return std::nullopt;
  if (edit.kind == Edit::Kind::make_template)
    return "the agent is written in one line, with anchors, or beside templates of another layout: "
           "move it in the text";
  if (const Entry* entry = editor.entry(edit.at); entry != nullptr && entry->is_alias)
    return editor.value_text(edit.at) + " stands here; change what it stands for in the text";
  return not_there + perhaps_included(document);
}

/// Why the text after an edit is not taken; nullopt: it is.
std::optional<std::string> worse(const std::string& before, const std::string& after) {
  const TextEditor now(after);
  if (const std::optional<Anchor> lost = now.lost_alias(); lost && !TextEditor(before).lost_alias())
    return fmt::format("*{} stands for it in other places of the text", lost->name);
  const auto unreadable = [](const std::string& text) {
    diagnostics::Diagnostics out("", text);
    const bool empty = text.find_first_not_of(" \t\r\n") == std::string::npos;
    return !spec::read_document(out) && !empty ? std::optional(out) : std::nullopt;
  };
  std::optional<diagnostics::Diagnostics> then = unreadable(after);
  if (!then || unreadable(before)) return std::nullopt;
  const diagnostics::Diagnostic first = then->sorted().front();
  if (first.code == "E002") return std::nullopt;
  return fmt::format("then line {} could not be read: {}", first.span.line, first.message);
}

/// One edit that replaces the lines that differ.
TextEdit difference(const Lines& lines, std::string_view before, std::string_view after) {
  std::size_t begin = 0, same = 0;
  const std::size_t shorter = std::min(before.size(), after.size());
  while (begin < shorter && before[begin] == after[begin]) ++begin;
  while (same < shorter - begin && before[before.size() - 1 - same] == after[after.size() - 1 - same]) ++same;
  // Whole letters: a byte in the middle of one is no position.
  const auto inside = [](std::string_view text, std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  while (begin > 0 && (inside(before, begin) || inside(after, begin))) --begin;
  while (same > 0 && (inside(before, before.size() - same) || inside(after, after.size() - same))) --same;
  return {"", lines.range({begin, before.size() - same}),
          std::string(after.substr(begin, after.size() - same - begin)), true};
}

/// A placed model that is no agent's, and names of maps that only their key has.
Renaming key_renamed(const Document& document, const TextEditor& editor, const Edit& edit) {
  const Path above = without_last(edit.at);
  const Entry& entry = *editor.entry(edit.at);
  const std::string& key = entry.key;
  if (edit.text != key && editor.entry(above / edit.text) != nullptr)
    return {{}, fmt::format("'{}' is taken here", edit.text)};
  Renaming renaming;
  const auto replace = [&](const Extent& old, std::string text) {
    renaming.edits.push_back({"", document.lines().range(old), std::move(text), true});
  };
  const std::size_t quote = entry.extent.begin - entry.whole.begin;
  replace({entry.whole.begin, entry.extent.end + quote},
          editor.node(above)->flow ? scalar_text(edit.text) : edit.text);
  const auto instance = [](std::string_view name) {
    std::string_view first = name.substr(0, name.find('['));
    return first.substr(0, first.find_last_not_of(' ') + 1);
  };
  if (above == Path{"simulation", "models"}) {
    // robot[0] and robot[1] may be placed one by one: the checks go on to name those that stay.
    const bool others = std::ranges::any_of(editor.keys(above), [&](const std::string& one) {
      return one != key && instance(one) == instance(key);
    });
    if (!others)
      for (const Extent& object : document.index().objects())
        if (std::string_view(editor.text()).substr(object.begin, object.end - object.begin) == instance(key))
          replace(object, std::string(instance(edit.text)));
  }
  return renaming;
}

Renaming renamed(const Document& document, const Edit& edit, std::span<const Source> sources) {
  const TextEditor editor(document.text());
  const Entry* entry = editor.entry(edit.at);
  if (entry == nullptr || key_of(edit.at.back()) == nullptr) return {{}, not_there};
  const Use* name = document.index().defined_at(entry->extent.begin);
  const bool has_index = edit.text.find('[') != std::string::npos;
  if (name == nullptr || (document.index()[name->symbol].kind == Kind::process && has_index))
    return key_renamed(document, editor, edit);
  return rename(document, nullptr, document.lines().position(entry->extent.begin), sources, edit.text);
}

std::string with_article(std::string_view words) {
  return fmt::format(
      "{} {}", std::string_view("aeiou").find(words.front()) == std::string_view::npos ? "a" : "an", words);
}

}  // namespace

Renaming edit(const Document& document, std::span<const Edit> edits, std::span<const Source> sources) {
  if (edits.size() == 1 && edits.front().kind == Edit::Kind::rename) {
    Renaming renaming = renamed(document, edits.front(), sources);
    if (!renaming.problem) renaming.problem = worse(document.text(), edited(document, renaming.edits));
    if (renaming.problem) renaming.edits.clear();
    return renaming;
  }
  TextEditor editor(document.text());
  for (const Edit& one : edits) {
    std::optional<Document> later;
    if (&one != &edits.front()) later.emplace(editor.text(), document.grammar());
    const Document& now = later ? *later : document;
    if (one.kind == Edit::Kind::rename) {
      const Renaming renaming = renamed(now, one, {});
      if (renaming.problem) return {{}, renaming.problem};
      editor.change({0, editor.text().size()}, edited(now, renaming.edits));
    } else if (std::optional<std::string> problem = problem_with(now, editor, one)) {
      return {{}, std::move(problem)};
    }
  }
  if (editor.text() == document.text()) return {};
  if (std::optional<std::string> problem = worse(document.text(), editor.text()))
    return {{}, std::move(problem)};
  return {{difference(document.lines(), document.text(), editor.text())}, {}};
}

Named find_name(const Document& document, std::string_view name) {
  const std::size_t colon = name.find(':');
  const std::string_view kind = colon == std::string_view::npos ? "" : name.substr(0, colon);
  const std::string_view path = colon == std::string_view::npos ? name : name.substr(colon + 1);
  std::vector<const Symbol*> found;
  for (const Symbol& symbol : document.index().symbols())
    if (symbol.path == path && (colon == std::string_view::npos || prefix_of(symbol.kind) == kind))
      found.push_back(&symbol);
  if (found.size() == 1) return {document.lines().position(found.front()->definition.begin), {}};
  if (found.empty())
    return {{}, fmt::format("the specification has no name '{}'", name) + perhaps_included(document)};
  std::string all;
  for (const Symbol* symbol : found) {
    const std::string_view prefix = prefix_of(symbol->kind);
    all += fmt::format("{}{}{}{} ({}, line {})", all.empty() ? "" : ", ", prefix, prefix.empty() ? "" : ":",
                       path, with_article(words_of(symbol->kind)),
                       document.lines().position(symbol->definition.begin).line + 1);
  }
  return {{}, fmt::format("'{}' is the name of several things: {}", name, all)};
}

}  // namespace tessera::language
