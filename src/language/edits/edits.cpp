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

/// A text after an edit.
struct After {
  std::string text;
  std::optional<std::string> problem;
};

After refused(std::string why) { return {{}, std::move(why)}; }

/// Changes that must not be empty.
After made(const TextEditor& editor, const Path& at, const Changes& changes) {
  if (!changes.empty()) return {applied(editor.text(), changes), {}};
  if (editor.is_alias(at))
    return refused(editor.value_text(at) + " stands here; change what it stands for in the text");
  return refused(not_there);
}

After removed(const Document& document, const TextEditor& editor, const Path& at) {
  std::vector<Path> paths = to_remove(document, editor, at);
  // From below: the positions of the others stay. The rest of a list decides how the next one goes.
  const auto begin = [&](const Path& path) {
    const std::optional<Extent> extent = editor.extent(path);
    return extent ? extent->begin : 0;
  };
  std::stable_sort(paths.begin(), paths.end(),
                   [&](const Path& a, const Path& b) { return begin(a) > begin(b); });
  if (!editor.has(at)) return refused(not_there);
  std::string text = editor.text();
  for (const Path& path : paths) {
    const TextEditor now(text);
    text = applied(text, now.remove(path));
  }
  return {std::move(text), {}};
}

After channel_changed(const TextEditor& editor, const Edit& edit) {
  const auto model = edit.fields.find("model");
  // A model says itself how the ends wait.
  if (model == edit.fields.end() || model->second.empty() || editor.map(edit.at) == nullptr)
    return made(editor, edit.at, change_channel(editor, edit.at, edit.fields));
  std::string text = editor.text();
  for (const char* side : {"send", "receive"}) {
    const TextEditor now(text);
    text = applied(text, now.set(edit.at, side, "", Writing::scalar));
  }
  const TextEditor rest(text);
  return {applied(rest.text(), rest.set(edit.at, "model", model->second, Writing::scalar)), {}};
}

After next_changed(const TextEditor& editor, const Edit& edit) {
  if (!editor.has(edit.at)) return refused(not_there);
  if (edit.key.empty()) return {with_next(editor, edit.at, edit.fields), {}};
  std::size_t entry = 0;
  const auto [end, problem] = std::from_chars(edit.key.data(), edit.key.data() + edit.key.size(), entry);
  if (problem != std::errc() || end != edit.key.data() + edit.key.size() ||
      entry >= next_entries(editor, edit.at).size())
    return refused(not_there);
  return {changed_next(editor, edit.at, entry, edit.fields), {}};
}

After edited_once(const Document& document, const Edit& edit) {
  const TextEditor editor(document.text());
  switch (edit.kind) {
    case Edit::Kind::set: {
      const Changes changes = editor.set(edit.at, edit.key, edit.text, edit.as);
      // A key that is not there needs not be removed.
      if (changes.empty() && !editor.is_alias(edit.at) && edit.text.empty()) return {editor.text(), {}};
      return made(editor, edit.at, changes);
    }
    case Edit::Kind::insert:
      if (editor.has(edit.at / edit.key)) return refused(fmt::format("'{}' is there already", edit.key));
      return made(editor, edit.at, editor.insert(edit.at, edit.key, edit.value));
    case Edit::Kind::append:
      return made(editor, edit.at, editor.append(edit.at, flow_text(edit.value)));
    case Edit::Kind::replace:
      return made(editor, edit.at, editor.replace(edit.at, flow_text(edit.value)));
    case Edit::Kind::remove:
      return removed(document, editor, edit.at);
    case Edit::Kind::connect:
      return made(editor, edit.at, editor.append({"channels"}, channel_text(edit.fields)));
    case Edit::Kind::channel:
      return channel_changed(editor, edit);
    case Edit::Kind::next:
      return next_changed(editor, edit);
    case Edit::Kind::make_template:
      if (std::optional<std::string> text = with_template(editor, edit.at)) return {std::move(*text), {}};
      return refused(
          "the agent is written in one line, with anchors, or beside templates of another layout: move it in "
          "the text");
    case Edit::Kind::rename:
      break;
  }
  return refused(not_there);
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
  Changes changes = editor.rename_key(edit.at, edit.text);
  if (changes.empty()) return {{}, not_there};
  const Path above = without_last(edit.at);
  const std::string& key = *key_of(edit.at.back());
  if (edit.text != key && editor.has(above / edit.text))
    return {{}, fmt::format("'{}' is taken here", edit.text)};
  const auto instance = [](std::string_view name) {
    std::string_view first = name.substr(0, name.find('['));
    return first.substr(0, first.find_last_not_of(' ') + 1);
  };
  if (above == Path{"simulation", "models"}) {
    const std::vector<std::string> all = editor.keys(above);
    // robot[0] and robot[1] may be placed one by one: the checks go on to name those that stay.
    const bool others = std::any_of(all.begin(), all.end(), [&](const std::string& one) {
      return one != key && instance(one) == instance(key);
    });
    if (!others)
      for (const Extent& object : document.index().objects())
        if (std::string_view(editor.text()).substr(object.begin, object.end - object.begin) == instance(key))
          changes.push_back({object, std::string(instance(edit.text))});
  }
  Renaming renaming;
  for (const Change& change : changes)
    renaming.edits.push_back({"", document.lines().range(change.extent), change.text, true});
  return renaming;
}

Renaming renamed(const Document& document, const Edit& edit, std::span<const Source> sources) {
  const TextEditor editor(document.text());
  const std::optional<Extent> key = editor.key_extent(edit.at);
  if (!key) return {{}, not_there};
  const Use* use = document.index().at(key->begin);
  const bool has_index = edit.text.find('[') != std::string::npos;
  if (use == nullptr || !use->defines || use->extent.begin != key->begin ||
      (document.index()[use->symbol].kind == Kind::process && has_index))
    return key_renamed(document, editor, edit);
  return rename(document, nullptr, document.lines().position(key->begin), sources, edit.text);
}

std::string_view prefix_of(Kind kind) {
  switch (kind) {
    case Kind::type:
      return "type";
    case Kind::parameter:
      return "parameter";
    case Kind::memory:
      return "memory";
    case Kind::input:
      return "input";
    case Kind::output:
      return "output";
    case Kind::real:
      return "real";
    case Kind::agent_template:
      return "template";
    case Kind::model:
      return "model";
    case Kind::process:
      return "process";
    case Kind::field:
      return "field";
    case Kind::condition:
      return "condition";
    case Kind::behaviour:
    case Kind::subsystem:
    case Kind::agent:
      break;
  }
  return "";
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
  std::string text = document.text();
  for (const Edit& one : edits) {
    std::optional<Document> later;
    if (&one != &edits.front()) later.emplace(text, document.grammar());
    const Document& now = later ? *later : document;
    After after;
    if (one.kind == Edit::Kind::rename) {
      const Renaming renaming = renamed(now, one, {});
      after = {edited(now, renaming.edits), renaming.problem};
    } else {
      after = edited_once(now, one);
    }
    if (after.problem) return {{}, after.problem};
    text = std::move(after.text);
  }
  if (text == document.text()) return {};
  if (std::optional<std::string> problem = worse(document.text(), text)) return {{}, std::move(problem)};
  return {{difference(document.lines(), document.text(), text)}, {}};
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
  if (found.empty()) return {{}, fmt::format("the specification has no name '{}'", name)};
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
