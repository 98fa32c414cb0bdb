#include <algorithm>
#include <array>

#include "language/questions/completer.hpp"

namespace tessera::language {
namespace {

/// Stands at the cursor while the text is read, so that an empty place has a scalar or a key.
constexpr char cursor_mark = '\x01';

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

Completer::Completer(const Document& document, Position position)
    : document_(document), index_(document.index()), cursor_(document.lines().offset(position)) {
  const std::string& text = document.text();
  begin_ = end_ = cursor_;
  while (begin_ > 0 && is_word(text[begin_ - 1])) --begin_;
  while (end_ < text.size() && is_word(text[end_])) ++end_;
  marked_ = text.substr(0, cursor_) + cursor_mark + text.substr(cursor_);
}

std::vector<Proposal> Completer::complete() {
  const Outline outline(marked_);
  const std::optional<PlaceInText> place = place_at(outline, cursor_);
  if (!place) return {};
  place_ = *place;
  unit_ = index_.unit_at(place_.way);
  if (unit_ != nullptr) {
    inside_.assign(place_.way.begin() + static_cast<std::ptrdiff_t>(unit_->way.size()), place_.way.end());
    leave_groups();
  }
  if (place_.key != nullptr) {
    keys(place_.way);
  } else {
    value();
  }
  if (proposals_.size() > most_proposals) proposals_.resize(most_proposals);
  return std::move(proposals_);
}

void Completer::add(Proposal::Kind kind, const std::string& label, std::string detail, std::string insert,
                    std::string documentation) {
  if (label.empty() || !seen_.insert(label).second) return;  // a key may be empty while one types
  Proposal proposal;
  proposal.kind = kind;
  proposal.label = label;
  proposal.detail = std::move(detail);
  proposal.documentation = std::move(documentation);
  proposal.insert = insert.empty() ? label : std::move(insert);
  proposal.range = document_.lines().range({begin_, end_});
  proposals_.push_back(std::move(proposal));
}

void Completer::add_names(const NamesOf& names, Form form) {
  std::vector<SymbolId> ids;
  for (const auto& [name, id] : names) ids.push_back(id);
  std::sort(ids.begin(), ids.end());  // as in the file
  for (const SymbolId id : ids) {
    const Symbol& symbol = index_[id];
    const std::string detail = symbol.type.empty() ? std::string(words_of(symbol)) : symbol.type;
    // The agents among the values of a memory cell are those of its members.
    const bool is_value = symbol.kind == Kind::agent;
    const bool has_members = is_value || !symbol.fleet.empty();
    const bool has_index = end_ < document_.text().size() && document_.text()[end_] == '[';
    const std::string member = symbol.name + (own_fleet().empty() ? "[0]" : "[i]");
    const bool of_one = has_members && !has_index && (form != Form::name || is_value);
    if (of_one) add(Proposal::Kind::name, member, detail, quoted_if_needed(member));
    if (!of_one || (form == Form::either && !is_value)) add(Proposal::Kind::name, symbol.name, detail);
  }
}

const std::string& Completer::step(std::size_t at) const {
  static const std::string nothing;
  return at < inside_.size() ? inside_[at] : nothing;
}

// ------------------------------------------------------------------------------------------------ keys

bool Completer::colon_follows() const {
  const std::string& text = document_.text();
  std::size_t at = end_;
  while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
  return at < text.size() && text[at] == ':';
}

void Completer::keys(const Way& way) {
  std::set<std::string> present;
  if (place_.parent != nullptr && place_.key != nullptr)
    for (const Entry& entry : place_.parent->entries) present.insert(entry.key);
  key_names(way);
  const std::vector<Grammar::Key> known = document_.grammar().keys(way);
  const bool has_colon = colon_follows();
  for (const bool needed : {true, false})
    for (const Grammar::Key& key : known) {
      if (key.needed != needed || present.contains(key.name) || !fits(key.name)) continue;
      const bool flow = place_.parent != nullptr && place_.parent->flow;
      const char* end = has_colon ? "" : key.holds_lines && !flow ? ":" : ": ";
      add(Proposal::Kind::key, key.name, key.needed ? "needed" : "", key.name + end, key.description);
    }
}

void Completer::key_names(const Way& way) {
  if (way == Way{"drivers"} || way == Way{"simulation", "drivers"}) return paths(PathEnd::real, "[*]");
  if (way == Way{"simulation", "models"}) return paths(PathEnd::agent, "[*]");
  if (unit_ == nullptr) return;
  const Way& inside = inside_;
  if (inside == Way{"safe"} || inside == Way{"limits"}) return add_names(unit_->real);
  if (!inside.empty() && inside.back() == "sets" &&
      (inside.size() == 1 || (inside.size() > 2 && inside[0] == "behaviours")))
    return add_names(kept_cells(*unit_));
  if (inside.size() == 3 && inside[0] == "behaviours" && inside[2] == "with") return names_to_give();
  if (inside.size() == 3 && inside[0] == "behaviours" && (inside[2] == "terminal" || inside[2] == "error"))
    return add_names(unit_->shared);
  if (inside.size() == 3 && inside[0] == "behaviours" && inside[2] == "send")
    return add_names(unit_->outputs, own_fleet().empty() ? Form::name : Form::either);
  if (inside.size() < 2) return;
  const NamesOf& cells = inside[0] == "safe" ? unit_->real : unit_->memory;
  if (inside[0] != "safe" && !(inside[0] == "memory" && inside.size() > 2 && inside[2] == "initial")) return;
  const auto cell = cells.find(inside[1]);
  if (cell == cells.end()) return;
  if (const NamesOf* fields = index_.fields_of(index_[cell->second].type)) add_names(*fields);
}

// ----------------------------------------------------------------------------------------------- values

bool Completer::begins_line() const {
  const std::size_t start = document_.text().find_last_of("\r\n", begin_ == 0 ? 0 : begin_ - 1);
  const std::size_t first = start == std::string::npos || begin_ == 0 ? 0 : start + 1;
  return document_.text().find_first_not_of(" \t-", first) >= begin_;
}

void Completer::value() {
  const Way& way = place_.way;
  if (!special_value()) {
    for (const std::string& word : document_.grammar().values(way)) add(Proposal::Kind::word, word);
    if (begin_ <= place_.scalar->extent.begin + 1)
      for (const std::string& text : document_.grammar().examples(way))
        add(Proposal::Kind::example, text, "example");
  }
  if (begins_line() && !(place_.parent != nullptr && place_.parent->flow)) keys(way);
}

bool Completer::special_value() {
  const Way& way = place_.way;
  const std::size_t size = way.size();
  const std::string last = size > 0 ? way.back() : "";
  if (is_type_place()) return types(), true;
  if (size == 3 && last == "use" && (way[0] == "agents" || way[0] == "templates"))
    return templates(/*of_groups=*/false), true;
  if (last == "on_error" && !in_group_template() &&
      (size == 1 || (size == 3 && (way[0] == "agents" || way[0] == "templates"))))
    return on_error(), true;
  if (last == "for" && step(0) == "behaviours" && inside_.size() == 3) return each_fleet(), true;
  if (last.empty() && size > 1 && way[size - 2] == "values" && step(0) == "memory") return each_fleet(), true;
  if (size >= 2 && way[0] == "channels") return channel_value(last);
  if (size >= 2 && way[0] == "properties" && last != "name" && value_after_comparison()) return true;
  if (size >= 2 && way[0] == "properties" && last != "name")
    return paths(PathEnd::behaviour, "[*]"), words_of_formulas(), true;
  if (size >= 4 && way[0] == "timing" && way[1] == "chains" && way[3] == "path" &&
      (last.empty() || last == "path"))
    return paths(PathEnd::subsystem, "[i]"), true;
  if (size >= 3 && way[0] == "simulation" && way[1] == "script" && last == "set")
    return paths(PathEnd::real, "[*]"), true;
  if (size >= 3 && way[0] == "deploy" && way[1] == "processes" && last != "host" && last != "interface")
    return paths(PathEnd::agent, "[*]"), true;
  return unit_ != nullptr && value_in_unit();
}

bool Completer::is_type_place() const {
  const Way& way = place_.way;
  if (way.size() == 3 && way[0] == "types") return true;
  if (way.size() == 3 && way[0] == "parameters" && way[2] == "type") return true;
  if (unit_ == nullptr || inside_.size() < 2) return false;
  const bool buffers =
      inside_[0] == "inputs" || inside_[0] == "outputs" || inside_[0] == "real" || inside_[0] == "memory";
  if (inside_.size() == 2) return buffers;
  return inside_.size() == 3 && inside_[2] == "type" &&
         (inside_[0] == "memory" || inside_[0] == "parameters");
}

void Completer::types() {
  const std::string_view before =
      std::string_view(marked_).substr(0, begin_).substr(std::min(place_.scalar->extent.begin, begin_));
  if (const std::size_t open = before.rfind('['); open != std::string_view::npos) {
    if (before.find(']', open) == std::string_view::npos && step(0) != "real") each_fleet();
    return;
  }
  if (begin_ > place_.scalar->extent.begin + (place_.scalar->quoted ? 1U : 0U)) return;  // the unit
  add_names(index_.types());
  constexpr std::array words{"bool",  "float64", "float32", "int8",   "int16",  "int32",
                             "int64", "uint8",   "uint16",  "uint32", "uint64", "string"};
  for (const char* word : words) add(Proposal::Kind::type, word);
}

bool Completer::channel_value(const std::string& last) {
  const std::size_t arrow = marked_.find("->", place_.scalar->extent.begin);
  const bool behind = arrow != std::string::npos && arrow < cursor_;
  if (last == "from" || (last.empty() && !behind)) return paths(PathEnd::output, "[i]"), true;
  if (last == "to" || (last.empty() && behind)) return paths(PathEnd::input, "[i]"), true;
  if (last == "model") return add_names(index_.models()), true;
  return false;
}

bool Completer::value_in_unit() {
  if (inside_ == Way{"start"}) return add_names(unit_->behaviours, Form::member), true;
  if (inside_ == Way{"on_error"}) {
    add_names(unit_->behaviours);
    return in_group_template() || (stop(), true);
  }
  if (inside_ == Way{"until"} && in_group_template()) return expression(), true;
  if (value_of_change()) return true;
  if ((step(0) == "send" || step(0) == "receive") && inside_.back().empty()) return buffers(step(0)), true;
  if (step(0) == "conditions" && inside_.size() == 2) return expression(), true;
  if (value_of_goal()) return true;
  if (step(0) != "behaviours" || inside_.size() < 3) return false;
  if (value_of_group() || value_of_template()) return true;
  const std::string& key = inside_[2];
  const std::string& last = inside_.back();
  if (key == "send" && inside_.size() > 4) {
    if (last != "when") return false;  // the words of the schema
    if (inside_.size() == 5 && chain().empty() && place_.scalar->extent.begin >= begin_)
      add_names(unit_->shared);
    return expression(), true;
  }
  if (last == "when") {
    if (value_after_comparison()) return true;
    if (const auto names = unit_->conditions.find(behaviour_); names != unit_->conditions.end())
      add_names(names->second);
    if (chain().empty() && behaviour_.valid() && index_[behaviour_].is_group)
      add(Proposal::Kind::word, "until", "the condition of the group ended it");
    if (chain().empty()) add(Proposal::Kind::word, "error", "the behaviour failed");
    return expression(), true;
  }
  if (key == "next") {
    add_names(unit_->behaviours_in(group_), Form::member);
    return add(Proposal::Kind::word, "end", group_.valid() ? "the group is left" : "the subsystem ends"),
           true;
  }
  if (key == "send" || key == "receive") return buffers(key), true;
  if (key != "terminal" && key != "error") return false;
  if (inside_.size() == 3 && chain().empty() && place_.scalar->extent.begin >= begin_)
    add_names(unit_->shared);
  return expression(), true;
}

void Completer::stop() { add(Proposal::Kind::word, "stop", "the subsystem ends, and the run fails"); }

void Completer::buffers(const std::string& key) {
  NamesOf names = key == "send" ? unit_->outputs : unit_->inputs;
  const char sign = begin_ > 0 ? document_.text()[begin_ - 1] : ' ';
  if (step(0) == "behaviours" && begin_ > place_.scalar->extent.begin && (sign == '+' || sign == '-')) {
    const Node& own = node_at(document_.outline(), unit_->way)[key];
    const Node& list = own.is_map() && !own.entries.empty() ? *own.entries.front().value : own;
    const auto is_listed = [&](const std::string& name) {
      return !list.is_sequence() || std::any_of(list.items.begin(), list.items.end(),
                                                [&](const Entry& one) { return one.value->text == name; });
    };
    std::erase_if(names, [&](const auto& one) { return is_listed(one.first) != (sign == '-'); });
  }
  add_names(names, step(0) == "behaviours" && !own_fleet().empty() ? Form::either : Form::name);
}

void Completer::on_error() {
  for (const DefinitionNames& definition : index_.definitions())
    if (place_.way.size() == 1 || index_[definition.symbol].way == Way{place_.way[0], place_.way[1]})
      for (const UnitNames& unit : definition.units) add_names(unit.behaviours);
  stop();
}

std::vector<std::string> Completer::chain() const {
  const std::size_t from = std::min(place_.scalar->extent.begin, begin_);
  const std::vector<Token> tokens = tokens_of(std::string_view(marked_).substr(from, begin_ - from));
  std::vector<std::string> names;
  std::size_t at = tokens.size();
  while (at > 0 && tokens[at - 1].text == ".") {
    --at;
    if (at > 0 && tokens[at - 1].text == "]") {
      while (at > 0 && tokens[at - 1].text != "[") --at;
      if (at > 0) --at;
    }
    if (at == 0 || tokens[at - 1].kind != Token::Kind::name) break;
    names.emplace_back(tokens[--at].text);
  }
  std::reverse(names.begin(), names.end());
  return names;
}

void Completer::expression() {
  if (value_after_comparison()) return;
  const std::vector<std::string> names = chain();
  if (names.empty()) {
    for (const char* base : {"in", "out", "memory", "parameters"})
      if (!index_.members(*unit_, base)->empty())
        add(Proposal::Kind::word, base, "", std::string(base) + ".");
    functions_of_members();
    if (place_.scalar->extent.begin >= begin_) {
      add(Proposal::Kind::word, "true");
      add(Proposal::Kind::word, "false");
    }
    return;
  }
  const std::optional<NamesOf> members = index_.members(*unit_, names[0]);
  if (!members) return;
  if (names.size() == 1) return add_names(*members, Form::either);
  auto symbol = members->find(names[1]);
  if (symbol == members->end()) return;
  SymbolId id = symbol->second;
  for (std::size_t at = 2; at < names.size(); ++at) {
    const NamesOf* fields = index_.fields_of(index_[id].type);
    const auto field = fields == nullptr ? NamesOf::const_iterator{} : fields->find(names[at]);
    if (fields == nullptr || field == fields->end()) return;
    id = field->second;
  }
  if (const NamesOf* fields = index_.fields_of(index_[id].type)) add_names(*fields);
  if (names.size() == 2 && (names[0] == "in" || names[0] == "out")) states_of_buffer(names[0] == "in");
}

void Completer::states_of_buffer(bool input) {
  if (input) {
    add(Proposal::Kind::word, "fresh", "a valid value has come; the proof knows it, unless no side waits");
    add(Proposal::Kind::word, "age", "time since the last valid value was sent");
    add(Proposal::Kind::word, "valid", "what came last is valid: its sender wrote it and did not fail");
    add(Proposal::Kind::word, "failed", "what came last is invalid");
  }
  add(Proposal::Kind::word, "stamp", input ? "when the last valid value was sent" : "when it was last sent");
  add(Proposal::Kind::word, "timed_out", "the channel waited for too long; the proof knows it");
  add(Proposal::Kind::word, "disconnected", "the other process is not heard of");
}

std::vector<Proposal> complete(const Document& document, Position position) {
  return Completer(document, position).complete();
}

}  // namespace tessera::language
