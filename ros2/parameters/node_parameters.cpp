#include "ros2/parameters/node_parameters.hpp"

#include <algorithm>
#include <utility>

namespace tessera::ros2 {
namespace {

constexpr char separator = '.';

bool is_within(std::string_view rest, std::uint64_t depth) {
  return depth == 0 || static_cast<std::uint64_t>(std::ranges::count(rest, separator)) < depth;
}

/// The rule of rclcpp.
bool is_listed(const std::string& name, const ListRequest& request) {
  if (request.prefixes.empty()) return is_within(name, request.depth);
  return std::ranges::any_of(request.prefixes, [&](const std::string& prefix) {
    if (name == prefix) return true;
    return name.starts_with(prefix + separator) &&
           is_within(std::string_view(name).substr(prefix.size() + 1), request.depth);
  });
}

template <class All>
auto find_name(const All& all, const std::string& name) {
  return std::ranges::find_if(all, [&](const auto& one) { return one.name == name; });
}

template <class All>
std::vector<std::byte> listed(const All& all, const ListRequest& request) {
  std::vector<std::string> names, prefixes;
  for (const auto& one : all) {
    if (!is_listed(one.name, request)) continue;
    names.push_back(one.name);
    const std::string prefix = one.name.substr(0, one.name.rfind(separator));
    if (std::ranges::find(prefixes, prefix) == prefixes.end()) prefixes.push_back(prefix);
  }
  return list_answer(names, prefixes);
}

}  // namespace

NodeParameters::NodeParameters(Ros2Host& host, std::string node, std::set<std::string> agents)
    : host_(host), node_(std::move(node)), agents_(std::move(agents)) {}

std::optional<std::string> name_in_node(const std::set<std::string>& agents, std::string_view path) {
  const std::size_t dot = path.find(separator);
  if (dot == std::string_view::npos || !agents.contains(std::string(path.substr(0, dot))))
    return std::nullopt;
  return std::string(agents.size() == 1 ? path.substr(dot + 1) : path);
}

std::vector<NodeParameters::Known> NodeParameters::known() const {
  std::vector<Known> all;
  for (Ros2Parameter& one : host_.parameters())
    if (auto name = name_of(one.path)) all.push_back({*std::move(name), std::move(one)});
  return all;
}

std::optional<std::vector<std::byte>> NodeParameters::answer(ParameterService service,
                                                             std::span<const std::byte> request) {
  if (service == ParameterService::set || service == ParameterService::set_all) {
    const auto values = read_set_request(request);
    if (!values) return std::nullopt;
    return set(*values, service == ParameterService::set_all);
  }
  const std::vector<Known> all = known();
  if (service == ParameterService::list) {
    const auto wanted = read_list_request(request);
    if (!wanted) return std::nullopt;
    return listed(all, *wanted);
  }
  const auto names = read_names(request);
  if (!names) return std::nullopt;
  std::vector<ParameterValue> values;
  std::vector<Described> described;
  for (const std::string& name : *names) {
    const auto found = find_name(all, name);
    const bool exists = found != all.end();
    values.push_back(exists ? value_of(found->parameter) : ParameterValue());
    described.emplace_back(name, exists ? &found->parameter : nullptr);
  }
  if (service == ParameterService::describe) return descriptors_answer(described);
  return service == ParameterService::types ? types_answer(values) : values_answer(values);
}

std::vector<std::byte> NodeParameters::set(std::span<const NamedValue> values, bool all_or_none) {
  const std::vector<Known> all = known();
  std::vector<SetOutcome> outcomes;
  std::vector<Ros2Host::Change> changes;
  for (const auto& [name, value] : values) {
    SetOutcome& outcome = outcomes.emplace_back();
    const auto found = find_name(all, name);
    if (found == all.end()) {
      outcome = "the node " + node_ + " has no parameter " + name;
      continue;
    }
    Result<std::string> text = text_for(found->parameter, value);
    if (!text) {
      outcome = text.problem();
      continue;
    }
    changes.emplace_back(found->parameter.path, *text);
    if (!all_or_none) outcome = host_.set(std::span(changes).last(1));
  }
  if (!all_or_none) return set_answer(outcomes);
  const auto wrong = std::ranges::find_if(outcomes, [](const SetOutcome& one) { return one.has_value(); });
  return set_all_answer(wrong != outcomes.end() ? *wrong : host_.set(changes));
}

std::optional<std::vector<std::byte>> NodeParameters::event(const Stamp& stamp) {
  const std::vector<Known> all = known();
  ParameterEvent event{stamp, node_};
  std::vector<std::string> values;
  for (std::size_t index = 0; index < all.size(); ++index) {
    const auto& [name, parameter] = all[index];
    values.push_back(parameter.value);
    if (!told_)
      event.made.emplace_back(name, value_of(parameter));
    else if ((*told_)[index] != parameter.value)
      event.changed.emplace_back(name, value_of(parameter));
  }
  told_ = std::move(values);
  if (event.made.empty() && event.changed.empty()) return std::nullopt;
  return event_message(event);
}

}  // namespace tessera::ros2
