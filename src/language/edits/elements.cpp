#include "language/edits/elements.hpp"

#include <algorithm>

namespace tessera::language {
namespace {

std::string field(const Fields& fields, const std::string& key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second;
}

/// The use of a name that a key defines.
const Symbol* symbol_at(const Document& document, const TextEditor& editor, const Path& at,
                        SymbolId* id = nullptr) {
  const std::optional<Extent> key = editor.key_extent(at);
  const Use* use = key ? document.index().at(key->begin) : nullptr;
  if (use == nullptr || !use->defines || use->extent.begin != key->begin) return nullptr;
  if (id != nullptr) *id = use->symbol;
  return &document.index()[use->symbol];
}

/// Finds the entries that use a symbol.
class Dependents {
 public:
  Dependents(const Document& document, const TextEditor& editor, SymbolId symbol) : editor_(editor) {
    for (const Use& use : document.index().uses())
      if (use.symbol == symbol && !use.defines) uses_.push_back(use.extent.begin);
  }

  std::vector<Path> find() {
    items({"channels"});
    entries({"drivers"}, false);
    entries({"simulation", "drivers"}, true);
    entries({"simulation", "models"}, false);
    processes();
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool is_used(std::optional<Extent> in) const {
    return in && std::any_of(uses_.begin(), uses_.end(),
                             [&](std::size_t use) { return in->begin <= use && use < in->end; });
  }

  void items(const Path& list) {
    const Node* node = editor_.list(list);
    for (std::size_t at = 0; node != nullptr && at < node->items.size(); ++at)
      if (is_used(editor_.extent(list / at))) found_.push_back(list / at);
  }

  void entries(const Path& map, bool with_value) {
    for (const std::string& key : editor_.keys(map))
      if (is_used(with_value ? editor_.extent(map / key) : editor_.key_extent(map / key)))
        found_.push_back(map / key);
  }

  /// A process without agents goes, and so does a deployment without processes.
  void processes() {
    const Path all{"deploy", "processes"};
    std::vector<Path> gone;
    std::size_t whole = 0;
    const std::vector<std::string> names = editor_.keys(all);
    for (const std::string& name : names) {
      const Path process = all / name;
      const Path at = editor_.map(process) != nullptr ? process / "agents" : process;
      std::vector<Path> mine;
      std::size_t count = 1;
      if (const Node* list = editor_.list(at)) {
        count = list->items.size();
        for (std::size_t item = 0; item < count; ++item)
          if (is_used(editor_.extent(at / item))) mine.push_back(at / item);
      } else if (is_used(editor_.value_extent(at))) {
        mine.push_back(process);
      }
      if (!mine.empty() && mine.size() == count) {
        mine = {process};
        ++whole;
      }
      gone.insert(gone.end(), mine.begin(), mine.end());
    }
    if (whole > 0 && whole == names.size()) gone = {Path{"deploy"}};
    found_.insert(found_.end(), gone.begin(), gone.end());
  }

  const TextEditor& editor_;
  std::vector<std::size_t> uses_;
  std::vector<Path> found_;
};

std::string entry_text(const std::string& to, const std::string& when) {
  return when.empty() ? scalar_text(to) : "{ to: " + scalar_text(to) + ", when: " + scalar_text(when) + " }";
}

struct NextEntry {
  std::string to, when;
};
NextEntry read_entry(const TextEditor& editor, const Path& at) {
  if (editor.map(at) == nullptr) return {editor.value_text(at), ""};
  return {editor.value_text(at / "to"), editor.value_text(at / "when")};
}

/// The parts to remove with entries of `next`: all of it, if none is left.
std::vector<Path> next_to_remove(const TextEditor& editor, const Path& behaviour,
                                 const std::vector<std::size_t>& entries) {
  const std::vector<Path> all = next_entries(editor, behaviour);
  if (entries.empty()) return {};
  if (entries.size() == all.size()) return {behaviour / "next"};
  std::vector<Path> gone;
  for (const std::size_t at : entries) gone.push_back(all[at]);
  return gone;
}

void add_uses_of_behaviour(const TextEditor& editor, const Path& at, std::vector<Path>& paths) {
  const Path behaviours = without_last(at), unit = without_last(behaviours);
  const std::string& name = *key_of(at.back());
  if (editor.value_text(unit / "start") == name) paths.push_back(unit / "start");
  for (const std::string& other : editor.keys(behaviours)) {
    if (other == name) continue;
    std::vector<std::size_t> hits;
    const std::vector<Path> entries = next_entries(editor, behaviours / other);
    for (std::size_t entry = 0; entry < entries.size(); ++entry)
      if (read_entry(editor, entries[entry]).to == name) hits.push_back(entry);
    const std::vector<Path> gone = next_to_remove(editor, behaviours / other, hits);
    paths.insert(paths.end(), gone.begin(), gone.end());
  }
}

/// The safe command and the limits of a real buffer.
void add_device_entries(const TextEditor& editor, const Path& at, std::vector<Path>& paths) {
  const Path unit = without_last(without_last(at));
  const std::string& name = *key_of(at.back());
  for (const char* part : {"safe", "limits"})
    for (const std::string& key : editor.keys(unit / part))
      if (key == name || key.starts_with(name + ".")) paths.push_back(unit / part / key);
}

}  // namespace

std::vector<Path> to_remove(const Document& document, const TextEditor& editor, const Path& at) {
  std::vector<Path> paths{at};
  SymbolId id{};
  const Symbol* symbol = symbol_at(document, editor, at, &id);
  if (symbol == nullptr) return paths;
  switch (symbol->kind) {
    case Kind::real:
      add_device_entries(editor, at, paths);
      [[fallthrough]];
    case Kind::agent:
    case Kind::subsystem:
    case Kind::input:
    case Kind::output: {
      const std::vector<Path> others = Dependents(document, editor, id).find();
      paths.insert(paths.end(), others.begin(), others.end());
      break;
    }
    case Kind::behaviour:
      add_uses_of_behaviour(editor, at, paths);
      break;
    default:
      break;
  }
  return paths;
}

// ------------------------------------------------------------------------------------------------ channels

std::string channel_text(const Fields& fields) {
  const std::string from = field(fields, "from"), to = field(fields, "to");
  std::string rest;
  for (const char* side : {"send", "receive"})
    if (field(fields, side) == "blocking") rest += std::string(", ") + side + ": blocking";
  for (const char* key : {"timeout", "model"})
    if (const std::string text = field(fields, key); !text.empty())
      rest += std::string(", ") + key + ": " + scalar_text(text);
  if (rest.empty()) return from + " -> " + to;
  return "{ from: " + scalar_text(from) + ", to: " + scalar_text(to) + rest + " }";
}

Changes change_channel(const TextEditor& editor, const Path& at, const Fields& change) {
  if (editor.map(at) == nullptr) {
    const std::string text = editor.value_text(at);
    const std::size_t arrow = text.find("->");
    if (arrow == std::string::npos) return {};
    const auto trimmed = [](std::string part) {
      part.erase(0, part.find_first_not_of(' '));
      return part.erase(part.find_last_not_of(' ') + 1);
    };
    Fields fields = change;
    fields["from"] = trimmed(text.substr(0, arrow));
    fields["to"] = trimmed(text.substr(arrow + 2));
    return editor.replace(at, channel_text(fields));
  }
  Changes changes;
  for (const auto& [key, value] : change) {
    const Changes one = editor.set(at, key, value == "non_blocking" ? "" : value, Writing::scalar);
    changes.insert(changes.end(), one.begin(), one.end());
  }
  return changes;
}

// ------------------------------------------------------------------------------------------------ next

std::vector<Path> next_entries(const TextEditor& editor, const Path& behaviour) {
  const Path at = behaviour / "next";
  const std::optional<Extent> value = editor.value_extent(at);
  if (!value || value->empty()) return {};
  std::vector<Path> entries;
  const Node* list = editor.list(at);
  if (list == nullptr) return {at};
  for (std::size_t item = 0; item < list->items.size(); ++item) entries.push_back(at / item);
  return entries;
}

std::string with_next(const TextEditor& editor, const Path& behaviour, const Fields& entry) {
  const Path at = behaviour / "next";
  const std::string when = field(entry, "when");
  const std::string text = entry_text(field(entry, "to"), when);
  const auto done = [&](const Changes& changes) { return applied(editor.text(), changes); };
  if (editor.list(at) != nullptr) return done(editor.append(at, text));
  if (next_entries(editor, behaviour).empty())
    return done(editor.set(behaviour, "next", when.empty() ? text : "[" + text + "]", Writing::as_is));
  const TextEditor listed(done(editor.make_list(at)));
  return applied(listed.text(), listed.append(at, text));
}

std::string changed_next(const TextEditor& editor, const Path& behaviour, std::size_t at,
                         const Fields& change) {
  const std::vector<Path> entries = next_entries(editor, behaviour);
  if (at >= entries.size()) return editor.text();
  const auto done = [&](const Changes& changes) { return applied(editor.text(), changes); };
  if (const auto to = change.find("to"); to != change.end() && to->second.empty()) {
    Changes gone;
    for (const Path& path : next_to_remove(editor, behaviour, {at})) gone = editor.remove(path);
    return done(gone);
  }
  const Path& path = entries[at];
  NextEntry entry = read_entry(editor, path);
  if (change.contains("to")) entry.to = change.at("to");
  if (change.contains("when")) entry.when = change.at("when");
  const Node* map = editor.map(path);
  // A map in one line becomes a name again when it loses its condition.
  const std::string written = editor.text().substr(
      editor.value_extent(path)->begin, editor.value_extent(path)->end - editor.value_extent(path)->begin);
  const bool one_line = map != nullptr && map->flow && written.find('\n') == std::string::npos;
  if (map != nullptr && (!entry.when.empty() || !one_line)) {
    std::string text = editor.text();
    for (const auto& [key, value] : change) {
      const TextEditor now(text);
      text = applied(text, now.set(path, key, value, Writing::scalar));
    }
    return text;
  }
  const std::string text = entry_text(entry.to, entry.when);
  const bool is_item = key_of(path.back()) == nullptr;
  return done(editor.replace(path, !entry.when.empty() && !is_item ? "[" + text + "]" : text));
}

// ------------------------------------------------------------------------------------------------ templates

std::optional<std::string> with_template(const TextEditor& editor, const Path& agent) {
  const std::string& text = editor.text();
  const std::string name = agent.empty() || key_of(agent.back()) == nullptr ? "" : *key_of(agent.back());
  const std::optional<Extent> whole = editor.extent(agent);
  const Node* body = editor.map(agent);
  const Path templates{"templates"};
  if (!whole || body == nullptr || body->flow || body->find("use") != nullptr || editor.has(templates / name))
    return std::nullopt;
  const std::vector<std::string> beside = editor.keys(templates);
  if (editor.has(templates) && (beside.empty() || editor.map(templates)->flow)) return std::nullopt;
  const std::size_t indent =
      beside.empty() ? 2 : editor.column_of(editor.extent(templates / beside.front())->begin);
  if (editor.column_of(whole->begin) != indent) return std::nullopt;
  // A comment behind the last value goes along.
  const std::size_t end = editor.line_end(whole->end);
  const std::string entry = text.substr(whole->begin, end - whole->begin);
  const Outline own(entry);
  if (!own.anchors().empty()) return std::nullopt;
  std::string inside = entry.substr(entry.find(':') + 1);
  inside.erase(inside.find_last_not_of(" \t\r\n") + 1);
  Changes changes = editor.insert(templates, name, Value::scalar(inside));
  // The text of the body begins with what stands behind its colon, without the blank of a scalar.
  for (Change& change : changes)
    if (const std::size_t at = change.text.find(name + ": " + inside); at != std::string::npos)
      change.text.erase(at + name.size() + 1, 1);
  changes.push_back({{whole->begin, end}, name + ": { use: " + name + " }"});
  return applied(text, changes);
}

}  // namespace tessera::language
