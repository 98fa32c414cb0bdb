#include "language/edits/elements.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <vector>

namespace tessera::language {
namespace {

std::string field(const Fields& fields, const std::string& key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second;
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
    items({"timing", "chains"});
    entries({"drivers"}, false);
    entries({"simulation", "drivers"}, true);
    entries({"simulation", "models"}, false);
    processes();
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool is_used(const Extent& in) const {
    return std::ranges::any_of(uses_, [&](std::size_t use) { return in.begin <= use && use < in.end; });
  }

  void items(const Path& list) {
    const Node* node = editor_.list(list);
    for (std::size_t at = 0; node != nullptr && at < node->items.size(); ++at)
      if (is_used(node->items[at].whole)) found_.push_back(list / at);
  }

  void entries(const Path& map, bool with_value) {
    const Node* node = editor_.map(map);
    if (node == nullptr) return;
    for (const Entry& entry : node->entries)
      if (is_used(with_value ? entry.whole : entry.extent)) found_.push_back(map / entry.key);
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
          if (is_used(list->items[item].whole)) mine.push_back(at / item);
      } else if (const Entry* agent = editor_.entry(at); agent != nullptr && is_used(agent->written)) {
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

struct NextEntry {
  std::string to, when, sets;

  [[nodiscard]] bool is_name() const { return when.empty() && sets.empty(); }
};

std::string entry_text(const NextEntry& entry) {
  if (entry.is_name()) return scalar_text(entry.to);
  std::string text = "{ to: " + scalar_text(entry.to);
  if (!entry.when.empty()) text += ", when: " + scalar_text(entry.when);
  if (!entry.sets.empty()) text += ", sets: " + scalar_text(entry.sets);
  return text + " }";
}

NextEntry read_entry(const TextEditor& editor, const Path& at) {
  if (editor.map(at) == nullptr) return {editor.value_text(at), "", ""};
  return {editor.value_text(at / "to"), editor.value_text(at / "when"), editor.value_text(at / "sets")};
}

void add_uses_of_behaviour(const TextEditor& editor, const Path& at, std::vector<Path>& paths) {
  const Path behaviours = without_last(at), unit = without_last(behaviours);
  const std::string& name = *key_of(at.back());
  for (const char* key : {"start", "on_error"})
    if (editor.value_text(unit / key) == name) paths.push_back(unit / key);
  for (const std::string& other : editor.keys(behaviours)) {
    if (other == name) continue;
    const std::vector<Path> entries = next_entries(editor, behaviours / other);
    std::vector<Path> gone;
    std::ranges::copy_if(entries, std::back_inserter(gone), [&](const Path& entry) {
      const std::string to = read_entry(editor, entry).to;
      return to.substr(0, to.find('[')) == name;  // lend[i]
    });
    if (!gone.empty() && gone.size() == entries.size()) gone = {behaviours / other / "next"};
    paths.insert(paths.end(), gone.begin(), gone.end());
  }
}

/// The uses of a buffer in one list of `send` or `receive`. Without changes, the list is that of the subsystem.
void add_list_items(const TextEditor& editor, const Path& at, const std::string& buffer,
                    std::vector<Path>& paths) {
  std::vector<Path> hits;
  bool changes = false;
  const Node* list = editor.list(at);
  if (list == nullptr) {  // the map form of `send`
    const std::vector<std::string> keys = editor.keys(at);
    for (const std::string& key : keys) {
      const bool sign = key.starts_with('+') || key.starts_with('-');
      changes = changes || sign;
      if (key.substr(sign ? 1 : 0) == buffer) hits.push_back(at / key);
    }
    if (changes && hits.size() == keys.size()) hits = {at};
    paths.insert(paths.end(), hits.begin(), hits.end());
    return;
  }
  for (std::size_t item = 0; item < list->items.size(); ++item) {
    const std::string& text = list->items[item].value->text;
    const bool sign = text.starts_with('+') || text.starts_with('-');
    changes = changes || sign;
    if (text.substr(sign ? 1 : 0) == buffer) hits.push_back(at / item);
  }
  if (changes && hits.size() == list->items.size()) hits = {at};
  paths.insert(paths.end(), hits.begin(), hits.end());
}

/// The uses of an input or output in the lists of its subsystem and of the behaviours there.
void add_lists(const TextEditor& editor, const Path& at, const char* key, std::vector<Path>& paths) {
  const Path unit = without_last(without_last(at)), list = unit / key;
  const std::string& name = *key_of(at.back());
  add_list_items(editor, list, name, paths);
  for (const std::string& order : editor.keys(list)) add_list_items(editor, list / order, name, paths);
  for (const std::string& behaviour : editor.keys(unit / "behaviours"))
    add_list_items(editor, unit / "behaviours" / behaviour / key, name, paths);
}

/// Whether the path leads to the only item of `send` or `receive`. A list without items says that there are none;
/// without the list, there would be all.
bool is_last_of_list(const TextEditor& editor, const Path& path) {
  if (key_of(path.back()) != nullptr || (path[0] != Step("agents") && path[0] != Step("templates")))
    return false;
  const Path list = without_last(path);
  const bool is_of_buffers = std::ranges::any_of(
      list, [](const Step& step) { return step == Step("send") || step == Step("receive"); });
  const Node* node = is_of_buffers ? editor.list(list) : nullptr;
  return node != nullptr && node->items.size() == 1;
}

/// The changes of a memory cell in one `sets`, which goes with the last of them.
void add_changes(const TextEditor& editor, const Path& at, const std::string& cell,
                 std::vector<Path>& paths) {
  const std::vector<std::string> cells = editor.keys(at);
  if (std::ranges::find(cells, cell) != cells.end()) paths.push_back(cells.size() == 1 ? at : at / cell);
}

/// The changes of a memory cell in its subsystem. Conditions that ask it stay: only their author knows what holds then.
void add_all_changes(const TextEditor& editor, const Path& at, std::vector<Path>& paths) {
  const Path behaviours = without_last(without_last(at)) / "behaviours";
  for (const std::string& behaviour : editor.keys(behaviours)) {
    add_changes(editor, behaviours / behaviour / "sets", *key_of(at.back()), paths);
    if (editor.value_text(behaviours / behaviour / "orders") == *key_of(at.back()))
      for (const char* key : {"orders", "cancel"})
        if (editor.entry(behaviours / behaviour / key) != nullptr)
          paths.push_back(behaviours / behaviour / key);
    for (const Path& entry : next_entries(editor, behaviours / behaviour))
      add_changes(editor, entry / "sets", *key_of(at.back()), paths);
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

/// The element at a path, and what cannot be without it.
std::vector<Path> to_remove(const Document& document, const TextEditor& editor, const Path& at) {
  std::vector<Path> paths{at};
  const Use* name = document.index().defined_at(editor.entry(at)->extent.begin);
  if (name == nullptr) return paths;
  const Kind kind = document.index()[name->symbol].kind;
  switch (kind) {
    case Kind::real:
      add_device_entries(editor, at, paths);
      [[fallthrough]];
    case Kind::agent:
    case Kind::subsystem:
    case Kind::input:
    case Kind::output: {
      const std::vector<Path> others = Dependents(document, editor, name->symbol).find();
      paths.insert(paths.end(), others.begin(), others.end());
      if (kind == Kind::input) add_lists(editor, at, "receive", paths);
      if (kind == Kind::output) add_lists(editor, at, "send", paths);
      break;
    }
    case Kind::memory:
      add_all_changes(editor, at, paths);
      break;
    case Kind::behaviour:
      add_uses_of_behaviour(editor, at, paths);
      break;
    default:
      break;
  }
  return paths;
}

}  // namespace

std::vector<Path> next_entries(const TextEditor& editor, const Path& behaviour) {
  const Path at = behaviour / "next";
  const Entry* next = editor.entry(at);
  if (next == nullptr || next->written.empty()) return {};
  const Node* list = editor.list(at);
  if (list == nullptr) return {at};
  std::vector<Path> entries;
  for (std::size_t item = 0; item < list->items.size(); ++item) entries.push_back(at / item);
  return entries;
}

bool remove_with_uses(const Document& document, TextEditor& editor, const Path& at) {
  if (editor.entry(at) == nullptr) return false;
  std::vector<Path> paths = to_remove(document, editor, at);
  // From below: the positions of the others stay. The rest of a list decides how the next one goes.
  std::ranges::stable_sort(paths, std::greater{},
                           [&](const Path& path) { return editor.entry(path)->whole.begin; });
  for (const Path& path : paths)
    if (is_last_of_list(editor, path))
      editor.replace(without_last(path), "[]");
    else
      editor.remove(path);
  return true;
}

std::optional<std::string> needed_by(const Document& document, const TextEditor& editor, const Path& at) {
  const Entry* entry = editor.entry(at);
  const Use* name = entry == nullptr ? nullptr : document.index().defined_at(entry->extent.begin);
  if (name == nullptr || document.index()[name->symbol].kind != Kind::behaviour) return std::nullopt;
  if (editor.entry(without_last(without_last(at)) / "on_error") != nullptr) return std::nullopt;
  const Entry* outer = editor.entry({at[0], at[1], "on_error"});
  if (outer == nullptr) outer = editor.entry({"on_error"});
  if (outer == nullptr || outer->value->text != entry->key) return std::nullopt;
  const std::size_t line = document.lines().position(outer->extent.begin).line + 1;
  return "'on_error' on line " + std::to_string(line) + " leads failures to '" + entry->key +
         "'; change that first, or write on_error: stop in the subsystem";
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

bool change_channel(TextEditor& editor, const Path& at, Fields change) {
  if (editor.map(at) == nullptr) {
    const std::string text = editor.value_text(at);
    const std::size_t arrow = text.find("->");
    if (arrow == std::string::npos) return false;
    const auto trimmed = [](std::string part) {
      part.erase(0, part.find_first_not_of(' '));
      return part.erase(part.find_last_not_of(' ') + 1);
    };
    change["from"] = trimmed(text.substr(0, arrow));
    change["to"] = trimmed(text.substr(arrow + 2));
    return editor.replace(at, channel_text(change));
  }
  // A model says itself how the ends wait.
  if (!field(change, "model").empty()) change["send"] = change["receive"] = "";
  for (const auto& [key, value] : change)
    editor.set(at, key, value == "non_blocking" ? "" : value, Writing::scalar);
  return true;
}

// ------------------------------------------------------------------------------------------------ next

bool add_next(TextEditor& editor, const Path& behaviour, const Fields& entry) {
  const Path at = behaviour / "next";
  const NextEntry added{field(entry, "to"), field(entry, "when"), field(entry, "sets")};
  const std::string text = entry_text(added);
  if (editor.list(at) == nullptr) {
    if (next_entries(editor, behaviour).empty())
      return editor.set(behaviour, "next", added.is_name() ? text : "[" + text + "]", Writing::as_is);
    editor.make_list(at);
  }
  return editor.append(at, text);
}

bool change_next(TextEditor& editor, const Path& behaviour, std::size_t at, const Fields& change) {
  const std::vector<Path> entries = next_entries(editor, behaviour);
  if (at >= entries.size()) return false;
  const Path& path = entries[at];
  if (const auto to = change.find("to"); to != change.end() && to->second.empty())
    return editor.remove(entries.size() == 1 ? behaviour / "next" : path);
  NextEntry entry = read_entry(editor, path);
  if (change.contains("to")) entry.to = change.at("to");
  if (change.contains("when")) entry.when = change.at("when");
  if (change.contains("sets")) entry.sets = change.at("sets");
  const Node* map = editor.map(path);
  // A map in one line becomes a name again when it loses its condition and its changes.
  const bool one_line =
      map != nullptr && map->flow &&
      editor.text().substr(map->extent.begin, map->extent.end - map->extent.begin).find('\n') ==
          std::string::npos;
  if (map != nullptr && (!entry.is_name() || !one_line)) {
    for (const auto& [key, value] : change) editor.set(path, key, value, Writing::scalar);
    return true;
  }
  const std::string text = entry_text(entry);
  const bool is_item = key_of(path.back()) == nullptr;
  return editor.replace(path, !entry.is_name() && !is_item ? "[" + text + "]" : text);
}

// ------------------------------------------------------------------------------------------------ templates

bool make_template(TextEditor& editor, const Path& agent) {
  const Entry* whole = editor.entry(agent);
  const Node* body = editor.map(agent);
  if (whole == nullptr || body == nullptr || body->flow || body->find("use") != nullptr) return false;
  if (body->find("count") != nullptr) return false;  // it stays at the agent
  const std::string name = whole->key;
  const Path templates{"templates"};
  const Node* others = editor.map(templates);
  if (editor.entry(templates) != nullptr &&
      (others == nullptr || others->flow || others->find(name) != nullptr))
    return false;
  const std::size_t indent = others == nullptr ? 2 : editor.column_of(others->entries.front().whole.begin);
  if (editor.column_of(whole->whole.begin) != indent) return false;
  // A comment behind the last value goes along.
  const std::size_t end =
      std::min(editor.text().find_first_of("\r\n", whole->written.end), editor.text().size());
  const std::string inside = editor.text().substr(whole->behind, end - whole->behind);
  const Outline own(name + ":" + inside);
  if (!own.anchors().empty()) return false;
  editor.change({whole->behind, end}, " { use: " + name + " }");
  editor.insert(templates, name, Value::scalar("here"));
  return editor.change({editor.entry(templates / name)->behind, editor.entry(templates / name)->written.end},
                       inside);
}

}  // namespace tessera::language
