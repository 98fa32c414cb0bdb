#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "language/edits/elements.hpp"
#include "language/edits/text_editor.hpp"
#include "language/language.hpp"
#include "spec/behaviours/groups.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

using Names = std::vector<std::string>;

std::optional<spec::Model> model_of(const std::string& text) {
  diagnostics::Diagnostics out("", text);
  return spec::parse(out);
}

bool is_same(const spec::Expression& a, const spec::Expression& b) {
  return a.name == b.name && a.text == b.text && a.member == b.member && a.until_of == b.until_of;
}

bool is_same(const spec::Condition& a, const spec::Condition& b) {
  return a.kind == b.kind &&
         std::ranges::equal(a.expressions, b.expressions,
                            [](const auto& one, const auto& other) { return is_same(one, other); });
}

bool is_same(const std::vector<spec::Change>& a, const std::vector<spec::Change>& b) {
  return std::ranges::equal(a, b, [](const spec::Change& one, const spec::Change& other) {
    return one.cell == other.cell && one.step == other.step && one.value == other.value;
  });
}

bool is_same(const spec::Next& a, const spec::Next& b) {
  return a.behaviour == b.behaviour && is_same(a.sets, b.sets) && a.implied == b.implied &&
         a.when.kind == b.when.kind && a.when.expression == b.when.expression &&
         is_same(a.when.text, b.when.text);
}

bool is_same(const std::optional<spec::Group>& a, const std::optional<spec::Group>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  if (!a->until || !b->until) return a->start == b->start && a->until.has_value() == b->until.has_value();
  return a->start == b->start && is_same(*a->until, *b->until);
}

bool is_same(const spec::Behaviour& a, const spec::Behaviour& b) {
  return a.name == b.name && a.parent == b.parent && is_same(a.group, b.group) &&
         is_same(a.terminal, b.terminal) && is_same(a.error, b.error) && is_same(a.sets, b.sets) &&
         a.orders == b.orders && a.send == b.send &&
         std::ranges::equal(a.skippable, b.skippable,
                            [](const spec::Skippable& one, const spec::Skippable& other) {
                              return one.output == other.output && one.by_function == other.by_function &&
                                     is_same(one.when, other.when);
                            }) &&
         a.receive == b.receive && a.transfer == b.transfer && a.takes == b.takes && a.uses == b.uses &&
         std::ranges::equal(a.next, b.next,
                            [](const auto& one, const auto& other) { return is_same(one, other); });
}

/// Whether all behaviours are the same. Nothing else is changed.
bool is_same(const spec::Model& a, const spec::Model& b) {
  return std::ranges::equal(
      a.definitions, b.definitions, [](const spec::Definition& one, const spec::Definition& other) {
        return std::ranges::equal(
            one.subsystems, other.subsystems, [](const spec::Subsystem& x, const spec::Subsystem& y) {
              return x.name == y.name && x.receive_first == y.receive_first && x.start == y.start &&
                     std::ranges::equal(
                         x.behaviours, y.behaviours,
                         [](const auto& first, const auto& second) { return is_same(first, second); });
            });
      });
}

/// The text from each # on that may begin a comment.
std::multiset<std::string> comments_of(const std::string& text) {
  std::multiset<std::string> all;
  for (std::size_t at = text.find('#'); at != std::string::npos; at = text.find('#', at + 1)) {
    if (at > 0 && std::string_view(" \t\n\r").find(text[at - 1]) == std::string_view::npos) continue;
    all.insert(text.substr(at, std::min(text.find_first_of("\r\n", at), text.size()) - at));
  }
  return all;
}

std::string in_list(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return "[" + text + "]";
}

/// Changes of `base` that give `list`; nullopt: none do, or they are not fewer than its names.
std::optional<std::string> as_changes(const Names& list, const Names& base) {
  const auto has = [](const Names& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  Names changes, result;
  for (const std::string& name : base)
    if (has(list, name))
      result.push_back(name);
    else
      changes.push_back("-" + name);
  for (const std::string& name : list)
    if (!has(base, name)) {
      changes.push_back("+" + name);
      result.push_back(name);
    }
  return result == list && changes.size() < list.size() ? std::optional(in_list(changes)) : std::nullopt;
}

/// The most frequent value that stands more than once; the first of equals.
template <class T>
std::optional<T> most_frequent(const std::vector<T>& all) {
  const T* best = nullptr;
  std::ptrdiff_t most = 1;
  for (const T& one : all)
    if (const auto times = std::ranges::count(all, one); times > most) {
      best = &one;
      most = times;
    }
  return best == nullptr ? std::nullopt : std::optional(*best);
}

/// Writes defaults of one text, one after the other. Each is tried: it stays if the behaviours are the same, every
/// comment is still there, and the text is shorter.
class Shortener {
 public:
  Shortener(std::string text, spec::Model model) : result_{std::move(text), {}}, model_(std::move(model)) {}

  Shortened shorten() {
    const TextEditor editor(result_.text);
    for (const char* section : {"templates", "agents"})
      for (const std::string& agent : editor.keys({section})) {
        const Path body{section, agent};
        if (editor.entry(body / "control") != nullptr) unit(body / "control", agent + ".control");
        for (const char* kind : {"receptors", "effectors"})
          for (const std::string& name : editor.keys(body / kind))
            unit(body / kind / name, agent + "." + name);
      }
    return std::move(result_);
  }

 private:
  void unit(const Path& at, const std::string& name) {
    const TextEditor editor(result_.text);
    if (editor.map(at) == nullptr || behaviours_in(editor, at).size() < 2) return;
    try_conditions(at, name);
    for (const char* key : {"send", "receive"}) try_list(at, name, key);
    on_errors(at, name, 0);
  }

  /// `on_error` of the subsystem or group, then of the groups in it.
  void on_errors(const Path& at, const std::string& name, std::size_t depth) {
    const TextEditor editor(result_.text);
    const Path behaviours = at / "behaviours";
    const std::vector<std::string> names = editor.keys(behaviours);
    if (names.size() > 1) try_on_error(at, name, depth > 0);
    for (const std::string& one : names)
      if (depth < spec::most_nested_groups && editor.map(behaviours / one / "behaviours") != nullptr)
        on_errors(behaviours / one, name + "." + one, depth + 1);
  }

  /// The behaviours of a subsystem or a group, also those in groups.
  static std::vector<Path> behaviours_in(const TextEditor& editor, const Path& at, std::size_t depth = 0) {
    std::vector<Path> all;
    for (const std::string& name : editor.keys(at / "behaviours")) {
      const Path path = at / "behaviours" / name;
      if (editor.map(path / "behaviours") == nullptr || depth == spec::most_nested_groups) {
        all.push_back(path);
      } else {
        const std::vector<Path> inside = behaviours_in(editor, path, depth + 1);
        all.insert(all.end(), inside.begin(), inside.end());
      }
    }
    return all;
  }

  [[nodiscard]] bool means_the_same(const std::string& text) const {
    if (comments_of(text) != comments_of(result_.text) || TextEditor(text).lost_alias()) return false;
    const std::optional<spec::Model> now = model_of(text);
    return now && is_same(*now, model_);
  }

  void take(std::string text, std::string what) {
    if (text.size() >= result_.text.size()) return;
    result_.text = std::move(text);
    result_.done.push_back(std::move(what));
  }

  /// Writes `entry` before `behaviours` of a subsystem. false: they stand in no usual way.
  static bool add_before_behaviours(TextEditor& editor, const Path& unit, const std::string& entry) {
    const Entry* behaviours = editor.entry(unit / "behaviours");
    const Node* map = editor.map(unit);
    if (behaviours == nullptr || map == nullptr) return false;
    const std::size_t begin = behaviours->whole.begin;
    if (map->flow) return editor.change({begin, begin}, entry + ", ");
    const std::string& text = editor.text();
    const std::size_t column = editor.column_of(begin);
    std::size_t line = begin - column;
    if (text.find_first_not_of(' ', line) != begin) return false;
    // A comment before it is about the behaviours.
    while (line > 0) {
      const std::size_t above = line < 2 ? 0 : text.rfind('\n', line - 2) + 1;
      const std::size_t first = text.find_first_not_of(" \t", above);
      if (first >= line || text[first] != '#') break;
      line = above;
    }
    const std::string end = text.find("\r\n") == std::string::npos ? "\n" : "\r\n";
    return editor.change({line, line}, std::string(column, ' ') + entry + end);
  }

  /// Removes one of the keys of a behaviour, which stays.
  static void remove_key(TextEditor& editor, const Path& behaviour, const char* key) {
    const Node* map = editor.map(behaviour);
    if (map != nullptr && !map->flow && map->entries.size() == 1)
      editor.replace(behaviour, "{}");
    else
      editor.remove(behaviour / key);
  }

  // ------------------------------------------------------------------------------------------------ lists

  /// The names of a list that is written out here; nullopt: it is not.
  static std::optional<Names> names_at(const TextEditor& editor, const Path& at) {
    const Node* list = editor.list(at);
    if (list == nullptr) return std::nullopt;
    Names names;
    for (const Entry& item : list->items) {
      const Node& text = *item.value;
      if (!text.is_scalar() || text.text.starts_with('+') || text.text.starts_with('-')) return std::nullopt;
      names.push_back(text.text);
    }
    return names;
  }

  void try_list(const Path& unit, const std::string& name, const char* key) {
    TextEditor first(result_.text);
    const std::string order = first.value_text(unit / key);
    if (first.entry(unit / key) != nullptr && order != "first" && order != "last") return;
    const std::vector<Path> all = behaviours_in(first, unit);
    std::vector<Names> lists;
    for (const Path& behaviour : all) {
      const std::optional<Names> names = names_at(first, behaviour / key);
      if (!names) return;  // it uses all buffers
      lists.push_back(*names);
    }
    const std::optional<Names> base = most_frequent(lists);
    if (!base) return;
    const std::string list = in_list(*base), value = order == "first" ? "{ first: " + list + " }" : list;
    const bool written = order.empty() ? add_before_behaviours(first, unit, std::string(key) + ": " + value)
                                       : first.replace(unit / key, value);
    std::string text = first.text();
    if (!written || !means_the_same(text)) return;
    std::size_t changed = 0;
    for (std::size_t at = 0; at < all.size(); ++at) {
      TextEditor now(text);
      const Path& behaviour = all[at];
      if (lists[at] == *base)
        remove_key(now, behaviour, key);
      else if (const auto changes = as_changes(lists[at], *base);
               changes && now.list(behaviour / key) != nullptr && now.list(behaviour / key)->flow)
        now.replace(behaviour / key, *changes);
      if (now.text() == text || !means_the_same(now.text())) continue;
      text = now.text();
      ++changed;
    }
    take(text, fmt::format("{}: {}: {}, for {} behaviours", name, key, value, changed));
  }

  // ------------------------------------------------------------------------------------------------ on_error

  /// The entry of `next` that takes every error; nullopt: there is none.
  static std::optional<std::size_t> error_entry(const TextEditor& editor, const Path& behaviour) {
    const std::vector<Path> entries = next_entries(editor, behaviour);
    for (std::size_t at = 0; at < entries.size(); ++at)
      if (editor.map(entries[at]) != nullptr && editor.value_text(entries[at] / "when") == "error" &&
          editor.entry(entries[at] / "sets") == nullptr)
        return at;
    return std::nullopt;
  }

  /// Removes an entry of `next`. A list of one name becomes that name.
  static void remove_entry(TextEditor& editor, const Path& behaviour, std::size_t at) {
    const std::vector<Path> entries = next_entries(editor, behaviour);
    if (entries.size() == 1) return remove_key(editor, behaviour, "next");
    editor.remove(entries[at]);
    const Path next = behaviour / "next";
    const Node* list = editor.list(next);
    if (list == nullptr || !list->flow || list->items.size() != 1 || !list->items.front().value->is_scalar())
      return;
    editor.replace(next, editor.value_text(next / std::size_t{0}));
  }

  void try_on_error(const Path& unit, const std::string& name, bool is_group) {
    TextEditor first(result_.text);
    const Path behaviours = unit / "behaviours";
    for (const Path& level : {unit, Path{unit[0], unit[1]}, Path{}})
      if (first.entry(level / "on_error") != nullptr && (!is_group || level == unit)) return;
    std::vector<std::pair<Path, std::string>> leads;
    Names targets;
    for (const std::string& behaviour : first.keys(behaviours)) {
      const Path path = behaviours / behaviour;
      const std::optional<std::size_t> at = error_entry(first, path);
      const std::string to = at ? first.value_text(next_entries(first, path)[*at] / "to") : "";
      if (to.empty() || to == "end" || to == behaviour) continue;
      leads.emplace_back(path, to);
      targets.push_back(to);
    }
    const std::optional<std::string> to = most_frequent(targets);
    if (!to || !add_before_behaviours(first, unit, "on_error: " + *to) || !means_the_same(first.text()))
      return;
    std::string text = first.text();
    std::size_t changed = 0;
    for (const auto& [behaviour, target] : leads) {
      if (target != *to) continue;
      TextEditor now(text);
      const std::optional<std::size_t> at = error_entry(now, behaviour);
      if (!at) continue;  // by an alias, it stands for that of another behaviour
      remove_entry(now, behaviour, *at);
      if (!means_the_same(now.text())) continue;
      text = now.text();
      ++changed;
    }
    // A default that fewer than half of the others use would mislead.
    if (2 * changed + 1 < first.keys(behaviours).size()) return;
    take(text, fmt::format("{}: on_error: {}, for {} behaviours", name, *to, changed));
  }

  // ------------------------------------------------------------------------------------------------ conditions

  struct Repeated {
    std::string written;      ///< the expression, as in the file
    std::vector<Path> where;  ///< the maps that have it
    bool usual = true;        ///< everywhere the same, in one line
  };

  void try_conditions(const Path& unit, const std::string& name) {
    const TextEditor editor(result_.text);
    if (editor.entry(unit / "conditions") != nullptr) return;
    std::map<std::string, Repeated> all;
    Names order;
    for (const std::string& behaviour : editor.keys(unit / "behaviours"))
      for (const char* key : {"terminal", "error"}) {
        const Path at = unit / "behaviours" / behaviour / key;
        const Node* map = editor.map(at);
        if (map == nullptr) continue;
        for (const Entry& condition : map->entries) {
          const std::string written =
              editor.text().substr(condition.written.begin, condition.written.end - condition.written.begin);
          Repeated& one = all[condition.key];
          if (one.where.empty()) {
            one.written = written;
            order.push_back(condition.key);
          }
          one.where.push_back(at);
          one.usual =
              one.usual && map->flow && written == one.written && written.find('\n') == std::string::npos;
        }
      }
    for (const std::string& condition : order)
      if (const Repeated& one = all[condition]; one.usual && one.where.size() > 1)
        share(unit, name, condition, one);
  }

  void share(const Path& unit, const std::string& name, const std::string& condition, const Repeated& one) {
    TextEditor now(result_.text);
    for (const Path& at : one.where) {
      const Entry* entry = now.entry(at / condition);
      if (entry == nullptr) return;
      if (now.keys(at).size() == 1)
        now.replace(at, condition);
      else
        now.change({entry->behind - 1, entry->written.end}, "");
    }
    bool written = false;
    if (now.entry(unit / "conditions") != nullptr)
      written = now.insert(unit / "conditions", condition, Value::scalar(one.written));
    else
      written =
          add_before_behaviours(now, unit, fmt::format("conditions: {{ {}: {} }}", condition, one.written));
    if (written && means_the_same(now.text()))
      take(now.text(), fmt::format("{}: condition {}, for {} behaviours", name, condition, one.where.size()));
  }

  Shortened result_;
  const spec::Model model_;
};

}  // namespace

std::optional<Shortened> shortened(const std::string& text) {
  std::optional<spec::Model> model = model_of(text);
  if (!model) return std::nullopt;
  return Shortener(text, std::move(*model)).shorten();
}

}  // namespace tessera::language
