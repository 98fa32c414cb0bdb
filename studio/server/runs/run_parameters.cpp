#include "server/runs/run_parameters.hpp"

#include <algorithm>

#include "server/runs/or_null.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

/// Whether a pattern such as "robot[*].control" means "robot[3].control".
bool is_meant(std::string_view pattern, std::string_view path) {
  constexpr std::string_view any = "[*]";
  for (std::size_t star = pattern.find(any); star != std::string_view::npos; star = pattern.find(any)) {
    if (path.substr(0, star) != pattern.substr(0, star) || !path.substr(star).starts_with('[')) return false;
    path.remove_prefix(star);
    const std::size_t end = path.find(']');
    if (end == std::string_view::npos) return false;
    path.remove_prefix(end + 1);
    pattern.remove_prefix(star + any.size());
  }
  return pattern == path;
}

/// Text without the quotes that its C++ initialiser has.
std::string plain(const spec::Parameter& parameter) {
  const std::string& text = parameter.initial;
  const bool quoted = parameter.type.kind == spec::Type::Kind::string && text.size() > 1;
  return quoted && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2) : text;
}

}  // namespace

RunParameters::RunParameters(const spec::Model& model) {
  Numbered<spec::InstanceId, std::string> all;
  for (const spec::InstanceId instance : model.instances.ids()) all.push_back(model.instance_path(instance));
  for (const spec::Parameter& parameter : model.parameters) add(model, parameter, all, parameter.name);
  for (const spec::InstanceId instance : model.instances.ids())
    for (const spec::Parameter& parameter : model.subsystem(instance).parameters)
      add(model, parameter, {all[instance]}, all[instance] + "." + parameter.name);
}

void RunParameters::add(const spec::Model& model, const spec::Parameter& parameter,
                        const std::vector<std::string>& owners, std::string path) {
  Shown one{.path = std::move(path),
            .name = parameter.name,
            .type = model.layout_of(parameter.type),
            .unit = parameter.type.unit,
            .minimum = parameter.minimum,
            .maximum = parameter.maximum,
            .initial = plain(parameter),
            .values = {}};
  for (const std::string& owner : owners) one.values.emplace(owner, one.initial);
  all_.push_back(std::move(one));
}

void RunParameters::set(std::string_view path, const std::string& value) {
  const std::size_t dot = path.rfind('.');
  const std::string_view name = dot == std::string_view::npos ? path : path.substr(dot + 1);
  const std::string_view owner = dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
  for (Shown& one : all_) {
    if (one.name != name) continue;
    for (auto& [subsystem, held] : one.values) {
      const std::string_view agent = std::string_view(subsystem).substr(0, subsystem.rfind('.'));
      if (owner.empty() || is_meant(owner, subsystem) || is_meant(owner, agent)) held = value;
    }
  }
}

void RunParameters::forget() {
  for (Shown& one : all_)
    for (auto& [subsystem, held] : one.values) held.reset();
}

json RunParameters::shown() const {
  json rows = json::array();
  for (const Shown& one : all_) {
    if (one.values.empty()) continue;
    const std::optional<std::string>& value = one.values.begin()->second;
    const bool differs =
        std::ranges::any_of(one.values, [&](const auto& each) { return each.second != value; });
    rows.push_back({{"path", one.path},
                    {"type", one.type},
                    {"unit", one.unit},
                    {"minimum", or_null(one.minimum)},
                    {"maximum", or_null(one.maximum)},
                    {"initial", one.initial},
                    {"value", value ? json(*value) : json(nullptr)},
                    {"differs", differs}});
  }
  return rows;
}

}  // namespace tessera::server
