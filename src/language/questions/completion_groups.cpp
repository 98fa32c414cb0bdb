// Groups of behaviours, and what there is for each member of a fleet.

#include <algorithm>

#include "language/questions/completer.hpp"
#include "spec/behaviours/groups.hpp"

namespace tessera::language {

void Completer::leave_groups() {
  const std::optional<PlaceInBehaviours> place = index_.behaviour_at(*unit_, place_.way);
  if (!place) return;
  group_ = place->group;
  behaviour_ = place->behaviour;
  while (inside_.size() > 2 && inside_[0] == "behaviours" && inside_[2] == "behaviours")
    inside_.erase(inside_.begin(), inside_.begin() + 2);
}

bool Completer::in_group_template() const {
  return unit_ != nullptr && index_[unit_->symbol].kind == Kind::agent_template;
}

bool Completer::fits(const std::string& key) const {
  if (in_group_template() && inside_.empty())
    return key == "with" || (key != "next" && std::ranges::count(spec::known_keys(true), key) > 0);
  if (unit_ == nullptr || inside_.size() != 2 || inside_[0] != "behaviours") return true;
  const auto belongs = [](bool to_groups, const std::string& one) {
    return std::ranges::count(spec::known_keys(to_groups), one) > 0;
  };
  const Node& body = node_at(document_.outline(), place_.way);
  bool is_behaviour = false;
  for (const Entry& entry : body.entries) {
    if (entry.key == "use") return key == "with" || (belongs(true, key) && key != "behaviours");
    if (entry.key == "behaviours") return belongs(true, key);
    is_behaviour = is_behaviour || !belongs(true, entry.key);
  }
  const bool has_start = key == "start" || key == "until" || key == "on_error";
  return belongs(false, key) || (!is_behaviour && !has_start);
}

bool Completer::value_of_group() {
  if (inside_.size() != 3) return false;
  const std::string& key = inside_[2];
  const NamesOf& inside = unit_->behaviours_in(behaviour_);
  if (key == "start" || key == "on_error") return add_names(inside), true;
  return key == "until" && (expression(), true);
}

void Completer::templates(bool of_groups) {
  NamesOf names = index_.templates();
  std::erase_if(names, [&](const auto& one) { return index_[one.second].is_group != of_groups; });
  add_names(names);
}

void Completer::names_to_give() {
  const Node& behaviour = node_at(document_.outline(), Way(place_.way.begin(), place_.way.end() - 1));
  if (const GroupTemplateNames* from = index_.group_template(behaviour["use"].text)) add_names(from->taken);
}

bool Completer::value_of_template() {
  if (inside_.size() == 3 && inside_[2] == "use") return templates(/*of_groups=*/true), true;
  if (inside_.size() != 4 || inside_[2] != "with") return false;
  const std::vector<std::string> names = chain();
  if (names.size() == 1) {
    if (const std::optional<NamesOf> members = index_.members(*unit_, names[0])) add_names(*members);
    return true;
  }
  if (!names.empty()) return true;
  for (const NamesOf* buffers : {&unit_->inputs, &unit_->outputs, &unit_->memory}) add_names(*buffers);
  if (!index_.members(*unit_, "parameters")->empty())
    add(Proposal::Kind::word, "parameters", "", "parameters.");
  return true;
}

void Completer::each_fleet() {
  const std::size_t start = place_.scalar->extent.begin;
  const bool has_each =
      begin_ > start && document_.text().substr(start, begin_ - start).find("each") != std::string::npos;
  for (const auto& [fleet, id] : index_.fleets())
    add(Proposal::Kind::name, has_each ? fleet : "each " + fleet, "one for each member of the fleet");
}

std::string Completer::own_fleet() const {
  if (behaviour_.valid() && !index_[behaviour_].fleet.empty()) return index_[behaviour_].fleet;
  // An entry of `next` that leads to a behaviour for each member: [{ to: lend[i], when: ... }]
  if (place_.parent == nullptr || inside_.size() < 3 || inside_[2] != "next") return {};
  const bool is_target = !place_.way.empty() && (place_.way.back() == "to" || place_.way.back().empty() ||
                                                 place_.way.back() == "next");
  if (is_target) {
    for (const auto& [name, id] : unit_->behaviours_in(group_))
      if (!index_[id].fleet.empty()) return index_[id].fleet;
    return {};
  }
  const std::string to = (*place_.parent)["to"].text;
  const auto found = unit_->behaviours_in(group_).find(to.substr(0, to.find('[')));
  return found != unit_->behaviours_in(group_).end() && to.ends_with("[i]") ? index_[found->second].fleet
                                                                            : "";
}

void Completer::functions_of_members() {
  const auto has_members = [&](const NamesOf& names) {
    return std::ranges::any_of(names, [&](const auto& one) { return !index_[one.second].fleet.empty(); });
  };
  if (!has_members(unit_->inputs) && !has_members(unit_->outputs)) return;
  add(Proposal::Kind::word, "any", "of at least one member: any(in.request.fresh)", "any(");
  add(Proposal::Kind::word, "all", "of all members: all(in.request.fresh)", "all(");
  add(Proposal::Kind::word, "count", "of how many members: count(in.request.fresh) >= 2", "count(");
  add(Proposal::Kind::word, "which", "the number of the first member: which(in.request.fresh)", "which(");
}

}  // namespace tessera::language
