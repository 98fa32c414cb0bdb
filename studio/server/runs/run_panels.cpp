#include "server/runs/run_panels.hpp"

#include <algorithm>
#include <chrono>

namespace tessera::server {

using nlohmann::json;

namespace {

json json_of(const spec::PanelControl& control) {
  return {{"field", control.field},
          {"control", spec::name_of(control.kind)},
          {"unit", control.unit},
          {"minimum", control.is_number() ? json(control.minimum) : json(nullptr)},
          {"maximum", control.is_number() ? json(control.maximum) : json(nullptr)},
          {"whole", control.whole}};
}

/// The first entry of each real buffer.
void add_panels(const spec::Model& model, const std::vector<spec::Driver>& drivers, json& all) {
  for (const spec::Driver& driver : drivers) {
    const std::string path = model.driver_path(driver);
    const auto is_same = [&](const json& one) { return one.at("path") == path; };
    if (!driver.panel || std::ranges::any_of(all, is_same)) continue;
    json controls = json::array();
    for (const spec::PanelControl& control : driver.panel->controls) controls.push_back(json_of(control));
    all.push_back({{"path", path},
                   {"stale_s", std::chrono::duration<double>(driver.panel->stale).count()},
                   {"controls", std::move(controls)}});
  }
}

}  // namespace

json panels_of(const spec::Model& model, const RunRequest& request) {
  using Kind = RunRequest::Kind;
  json all = json::array();
  if (request.kind == Kind::deployment) return all;
  const bool simulated = request.kind == Kind::simulate || !request.world.empty();
  // The drivers of a controller that was started elsewhere are unknown.
  const bool attached = request.kind == Kind::attach;
  if (!simulated) add_panels(model, model.drivers, all);
  if ((simulated || attached) && model.simulation) add_panels(model, model.simulation->drivers, all);
  return all;
}

}  // namespace tessera::server
