#include "spec/behaviours/defaults.hpp"

#include <algorithm>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/document/families.hpp"
#include "spec/memory/few_values.hpp"
#include "spec/model/endings.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr std::string_view stop = "stop";

std::vector<BehaviourId> members_of(BehaviourId group, const Subsystem& subsystem) {
  std::vector<BehaviourId> members;
  for (const BehaviourId id : subsystem.behaviours.ids())
    if (subsystem.behaviours[id].parent == group) members.push_back(id);
  return members;
}

std::vector<std::string> labels_of(const std::vector<BehaviourId>& behaviours, const Subsystem& subsystem) {
  std::vector<std::string> names;
  for (const BehaviourId id : behaviours) names.emplace_back(subsystem.behaviours[id].label());
  return names;
}

/// The name in a list, or the key of the map form.
struct Item : Node {
  const Entry* option = nullptr;  ///< that key, if something stands behind it
};

/// Reads one list of buffers.
class ListReader {
 public:
  ListReader(const ListScope& scope, ListDefault& around, Diagnostics& out)
      : scope_(scope), around_(around), out_(out) {}

  /// The buffers of each key of the map form with something behind it.
  [[nodiscard]] std::vector<ListedOption> options() { return std::move(options_); }

  std::vector<BufferId> read(const std::vector<Item>& items) {
    const auto changes =
        std::count_if(items.begin(), items.end(), [](const Item& one) { return sign(one) != 0; });
    if (changes == 0) {
      for (const Item& item : items) read_name(item);
      return std::move(list_);
    }
    around_.used = true;
    if (static_cast<std::size_t>(changes) < items.size()) {
      complain_about_mixture(items);
      return std::move(list_);
    }
    list_ = around_.list.value_or(all());
    for (const Item& item : items) read_change(item);
    return std::move(list_);
  }

 private:
  static char sign(const Node& text) {
    return text.text.starts_with('+') || text.text.starts_with('-') ? text.text.front() : '\0';
  }

  [[nodiscard]] std::vector<BufferId> all() const {
    std::vector<BufferId> ids;
    for (std::uint32_t at = 0; at < scope_.buffers.size(); ++at) ids.push_back({at});
    return ids;
  }

  /// The buffers of that name, with which the text ends; none after an error.
  std::vector<BufferId> find(const Node& text, std::string_view name) {
    if (name.empty()) {
      const std::vector<std::string> names = written_names(scope_.buffers);
      out_.error("E104", text.span,
                 "an " + std::string(scope_.what) + " should follow " + in_quotes(text.text),
                 names.empty() ? "" : "for example " + text.text + names.front());
      return {};
    }
    const auto read = read_indexed(text, text.text.size() - name.size(), out_);
    if (!read) return {};
    std::vector<BufferId> found;
    for (std::uint32_t at = 0; at < scope_.buffers.size(); ++at) {
      const Field& field = scope_.buffers[at];
      if ((field.member ? field.member->family : field.name) == read->name) found.push_back({at});
    }
    if (found.empty()) {
      complain_about_unknown(text, *read);
      return {};
    }
    const std::optional<Member>& family = scope_.buffers[found.front().value].member;
    if (!family) return check_single(*read, scope_.what, out_) ? found : std::vector<BufferId>{};
    if (read->index == IndexedName::Index::none) return found;
    const auto number = number_of(*read, *family, scope_.member, scope_.what, out_);
    return number ? std::vector{found[*number]} : std::vector<BufferId>{};
  }

  void complain_about_unknown(const Node& text, const IndexedName& name) {
    const std::vector<std::string> others = written_names(scope_.others);
    const bool other = std::ranges::find(others, name.name) != others.end();
    const std::string what(scope_.what);
    const std::vector<std::string> names = written_names(scope_.buffers);
    Hint hint = did_you_mean(name.name, names);
    if (names.empty()) hint = "this subsystem has no " + what + "s";
    const std::string quoted = in_quotes(name.name);
    out_.error("E101", name.index == IndexedName::Index::none ? text.span : name.span,
               other ? quoted + " is no " + what : "unknown " + what + " " + quoted,
               other ? std::string("list it under '") + (what == "output" ? "receive" : "send") + "'"
                     : std::move(hint));
  }

  [[nodiscard]] bool is_listed(BufferId buffer) const {
    return std::find(list_.begin(), list_.end(), buffer) != list_.end();
  }

  void read_name(const Item& text) {
    for (const BufferId buffer : find_for(text, text.text)) {
      if (!is_listed(buffer)) {
        list_.push_back(buffer);
        continue;
      }
      out_.error("E107", text.span,
                 std::string(scope_.what) + " " + in_quotes(text.text) + " is listed twice");
      return;
    }
  }

  void read_change(const Item& text) {
    for (const BufferId buffer : find_for(text, std::string_view(text.text).substr(1)))
      if (!change(text, buffer)) return;
  }

  bool change(const Item& text, BufferId buffer) {
    const std::string name = text.text.substr(1);
    const std::string subject = std::string(scope_.what) + " " + in_quotes(name);
    if (std::find(changed_.begin(), changed_.end(), buffer) != changed_.end()) {
      out_.error("E107", text.span, subject + " is listed twice");
      return false;
    }
    changed_.push_back(buffer);
    if (sign(text) == '-' && text.option != nullptr) {
      out_.error("E328", text.option->span, subject + " is not sent, so nothing says when",
                 "leave the map behind -" + name + " out");
      return false;
    }
    if (sign(text) == '+' && is_listed(buffer)) {
      if (text.option != nullptr) return true;  // it says when the output is sent
      out_.error("E272", text.span, subject + " is " + done() + " already",
                 source() + "; leave +" + name + " out");
      return false;
    }
    if (sign(text) == '-' && !is_listed(buffer)) {
      out_.error("E273", text.span, subject + " is not " + done(), source() + "; leave -" + name + " out");
      return false;
    }
    if (sign(text) == '+')
      list_.push_back(buffer);
    else
      std::erase(list_, buffer);
    return true;
  }

  std::vector<BufferId> find_for(const Item& text, std::string_view name) {
    std::vector<BufferId> found = find(text, name);
    if (text.option != nullptr && sign(text) != '-') options_.push_back({text.option, found});
    return found;
  }

  [[nodiscard]] std::string done() const { return scope_.what == "output" ? "sent" : "received"; }

  /// The origin of the list around this one.
  [[nodiscard]] std::string source() const {
    const std::string all = "all " + std::string(scope_.what) + "s";
    if (around_.entry == nullptr)
      return scope_.what == "output" ? "a subsystem without 'send' sends " + all
                                     : "a subsystem without 'receive' receives " + all;
    return "the list of the subsystem is on " + out_.words(around_.entry->span);
  }

  void complain_about_mixture(const std::vector<Item>& items) {
    const auto plain =
        std::find_if(items.begin(), items.end(), [](const Item& one) { return sign(one) == 0; });
    out_.error("E274", plain->span, in_quotes(plain->text) + " stands beside changes by + and -",
               "write +" + plain->text +
                   " to add it to the list of the subsystem, or every name without a sign "
                   "to replace that list");
  }

  const ListScope& scope_;
  ListDefault& around_;
  Diagnostics& out_;
  std::vector<BufferId> list_, changed_;
  std::vector<ListedOption> options_;
};

}  // namespace

std::optional<OnError> read_on_error(const Section& section, Diagnostics& out) {
  const Entry* entry = section.find("on_error");
  if (entry == nullptr) return std::nullopt;
  OnError on_error{.behaviour = {}, .span = entry->span};
  const Node* text = text_of(*entry->value, entry->span, "on_error", out, "name a behaviour, or write stop");
  if (text == nullptr) {
    on_error.used = true;
    return on_error;
  }
  on_error.span = text->span;
  if (text->text != stop) on_error.behaviour = text->text;
  return on_error;
}

BehaviourId resolve_on_error(OnError& on_error, BehaviourId around, bool own, const Subsystem& subsystem,
                             Diagnostics& out) {
  const std::vector<BehaviourId> behaviours = members_of(around, subsystem);
  const std::vector<std::string> names = labels_of(behaviours, subsystem);
  const std::string wanted = on_error.behaviour.empty() ? std::string(stop) : on_error.behaviour;
  const auto found = std::find(names.begin(), names.end(), wanted);
  const bool is_there = found != names.end();
  if (on_error.behaviour.empty()) {
    const bool was_unreadable = on_error.used;
    on_error.used = true;
    if (is_there && !was_unreadable)
      out.error("E275", own ? on_error.span : subsystem.span,
                own ? "'stop' is a behaviour here, and stands for the end of the subsystem"
                    : "subsystem " + in_quotes(subsystem.name) +
                          " has a behaviour 'stop', and 'on_error: stop' on " + out.words(on_error.span) +
                          " stands for its end",
                "rename the behaviour; or leave 'on_error: stop' out, which is the default");
    return {};
  }
  if (is_there) return behaviours[static_cast<std::size_t>(found - names.begin())];
  on_error.used = true;
  if (own) {
    std::vector<std::string> known = names;
    if (!around.valid()) known.emplace_back(stop);
    const Hint guess = wanted == "end" && !around.valid()
                           ? Hint("write on_error: stop: the subsystem ends, and the run fails")
                           : did_you_mean(wanted, known);
    out.error("E101", on_error.span, "unknown behaviour " + in_quotes(wanted), guess);
  } else {
    out.error("E271", subsystem.span,
              "subsystem " + in_quotes(subsystem.name) + " has no behaviour " + in_quotes(wanted) +
                  ", to which 'on_error' on " + out.words(on_error.span) + " leads its failures",
              "give it a behaviour " + in_quotes(wanted) + ", or write on_error: stop in it");
  }
  return {};
}

Next entry_for_errors(BehaviourId to, Span at, const Subsystem& subsystem, Diagnostics& out) {
  Next entry{
      .behaviour = to, .when = {}, .span = at, .inherited = true, .sets = subsystem.behaviours[to].sets};
  entry.when.kind = When::Kind::error;
  entry.when.text.span = at;
  entry.may_be_blocked = check_entry(entry, subsystem.memory, out);
  return entry;
}

void check_used(const OnError& on_error, Diagnostics& out) {
  if (on_error.used) return;
  const std::string name = on_error.behaviour.empty() ? std::string(stop) : on_error.behaviour;
  out.warning("W361", on_error.span, "no failure leads to " + in_quotes(name) + " by this 'on_error'",
              on_error.behaviour.empty()
                  ? "every behaviour, or every subsystem, says itself where its failures lead; remove it"
                  : "failures of " + in_quotes(name) +
                        " itself never lead to it by this, and all others are led elsewhere; remove it, or "
                        "write next: "
                        "{ to: " +
                        name + ", when: error } in " + in_quotes(name));
}

std::vector<BufferId> read_buffer_list(const Node& value, const Entry& at, const ListScope& scope,
                                       ListDefault& around, Diagnostics& out,
                                       std::vector<ListedOption>* options) {
  if (value.is_map() && scope.what == "input") {
    out.error("E329", at.span, "'receive' is a list: an input has no condition",
              "write receive: [NAME, ...]; a channel with 'receive: non_blocking' does not wait");
    std::vector<BufferId> all;  // so that no warning about missing inputs follows
    for (std::uint32_t buffer = 0; buffer < scope.buffers.size(); ++buffer) all.push_back({buffer});
    return all;
  }
  std::vector<Item> items;
  if (value.is_map()) {
    for (const Entry& entry : value.entries) {
      Item& key = items.emplace_back();
      key.kind = Node::Kind::scalar;
      key.span = entry.span;
      key.text = entry.key;
      if (!entry.value->is_null()) key.option = &entry;
    }
  } else {
    for (const Node* item : items_of(value, at.span, in_quotes(at.key), out))
      if (const Node* text = text_of(*item, at.span, "an " + std::string(scope.what), out))
        static_cast<Node&>(items.emplace_back()) = *text;
  }
  ListReader reader(scope, around, out);
  std::vector<BufferId> list = reader.read(items);
  if (options != nullptr) *options = reader.options();
  return list;
}

void check_used(const ListDefault& list, Diagnostics& out) {
  if (list.entry == nullptr || list.used) return;
  out.warning("W361", list.entry->span, "no behaviour uses this list",
              "each has a '" + list.entry->key + "' of its own; +x and -x there change this list");
}

const Expression* SharedConditions::use(std::string_view name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [name](const Expression& one) { return one.name == name; });
  if (found == all.end()) return nullptr;
  used[static_cast<std::size_t>(found - all.begin())] = true;
  return &*found;
}

std::vector<std::string> SharedConditions::names() const {
  std::vector<std::string> names;
  for (const Expression& one : all) names.push_back(one.name);
  return names;
}

void check_used(const SharedConditions& conditions, Diagnostics& out) {
  for (std::size_t at = 0; at < conditions.all.size(); ++at) {
    if (conditions.used[at]) continue;
    const Expression& one = conditions.all[at];
    out.warning("W361", one.span, "no behaviour names condition " + in_quotes(one.name),
                "write terminal: " + one.name + ", or error: " + one.name + ", in a behaviour");
  }
}

/// Entries of `until` stay.
void drop_default_end(Numbered<NextId, Next>& next) {
  std::erase_if(next, [](const Next& entry) { return !entry.inherited; });
}

bool lead_failures(Behaviour& behaviour, const Next& entry) {
  Behaviour led = behaviour;
  if (!behaviour.next_given) {
    // Its default entry `end` is for a terminal ending alone.
    Behaviour alone = behaviour;
    alone.next.clear();
    if (!Endings(alone).possible(Ending::terminal)) drop_default_end(led.next);
  }
  const Endings endings(led);
  if (!endings.unrouted(Ending::error) && !endings.unrouted(Ending::failure)) return false;
  behaviour.next = std::move(led.next);
  // In front, as most write it; but behind the entries that name an error themselves.
  std::size_t at = behaviour.next.size();
  while (at > 0 && !names_error(behaviour.next[NextId{static_cast<std::uint32_t>(at - 1)}])) --at;
  behaviour.next.insert(behaviour.next.begin() + static_cast<std::ptrdiff_t>(at), entry);
  return true;
}

}  // namespace tessera::spec
