#include "project/files/world_views.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "project/files/chosen_world.hpp"
#include "project/files/simulation_file.hpp"
#include "project/files/world_check.hpp"
#include "tessera/world_state.hpp"

namespace tessera::project {
namespace {

using Kind = WorldView::Kind;
using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>;

std::optional<Kind> kind_of(std::string_view name) {
  for (const auto& [known, kind] : {std::pair{"scan", Kind::scan}, std::pair{"camera", Kind::camera},
                                    std::pair{"depth", Kind::depth}, std::pair{"labels", Kind::labels}})
    if (name == known) return kind;
  return std::nullopt;
}

double number_in(const DriverRequest& request, const char* option, double otherwise) {
  const auto found = request.options.find(option);
  if (found == request.options.end() || found->second.values.size() != 1) return otherwise;
  const double* number = std::get_if<double>(&found->second.values.front().value);
  return number == nullptr ? otherwise : *number;
}

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion inverse(const Quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }

Vector turned(const Quaternion& q, const Vector& v) {
  const Quaternion moved = product(product(q, {0, v[0], v[1], v[2]}), inverse(q));
  return {moved[1], moved[2], moved[3]};
}

/// Replaces the name of a body without one, which no name finds.
constexpr const char* nameless = "?";

/// Asks an open world at which bodies the sites are.
class Sites {
 public:
  Sites(std::unique_ptr<World> world, const std::string& contents) : world_(std::move(world)) {
    const nlohmann::json world_contents = nlohmann::json::parse(contents);
    for (const nlohmann::json& site : world_contents.at("sites"))
      bodies_.emplace(site.at("name"),
                      site.contains("body") && site["body"] == "" ? nameless : site.value("body", ""));
  }

  void place(WorldView& scan, const std::string& agent, const std::string& target) const {
    const std::shared_ptr<WorldState> state = world_->state(agent);
    if (state == nullptr) return;
    const WorldState::Pose site = state->site(target);
    const bool is_absolute = target.starts_with('/');
    auto found = is_absolute ? bodies_.find(target.substr(1)) : bodies_.find(agent + "/" + target);
    if (found == bodies_.end() && !is_absolute) found = bodies_.find(target);
    scan.body = found == bodies_.end() ? "" : found->second;
    scan.position_m = site.position_m;
    scan.quaternion = site.quaternion;
    if (scan.body.empty() || scan.body == nameless) return;
    const WorldState::Pose body = state->body("/" + scan.body);
    const Quaternion back = inverse(body.quaternion);
    Vector away{};
    for (std::size_t axis = 0; axis < 3; ++axis) away[axis] = site.position_m[axis] - body.position_m[axis];
    scan.position_m = turned(back, away);
    scan.quaternion = product(back, site.quaternion);
  }

 private:
  std::unique_ptr<World> world_;
  std::map<std::string, std::string> bodies_;  // by the names of the sites
};

Result<Sites> open_sites(const spec::Simulation& simulation, const std::filesystem::path& project) {
  std::optional<ChosenWorld> chosen = world_of(simulation, project);
  if (!chosen) return Problem{"there is no world " + simulation.world};
  Result<std::string> contents = contents_of_world(*chosen);
  if (!contents) return Problem{contents.problem()};
  Result<std::unique_ptr<World>> world = open_world_to_ask(std::move(*chosen));
  if (!world) return Problem{world.problem()};
  return Sites(std::move(*world), *contents);
}

}  // namespace

Result<std::vector<WorldView>> world_views(const spec::Model& model,
                                           const std::filesystem::path& project) try {
  std::vector<WorldView> views;
  std::optional<Sites> sites;
  if (!model.simulation || model.simulation->world.empty()) return views;
  for (const spec::Driver& driver : model.simulation->drivers) {
    const std::optional<Kind> kind = kind_of(driver.kind);
    if (!kind) continue;
    const DriverRequest request = request_of(model, driver);
    WorldView view;
    view.path = request.path;
    view.type = request.type;
    view.kind = *kind;
    view.from_rad = number_in(request, "from", -std::numbers::pi);
    view.to_rad = number_in(request, "to", std::numbers::pi);
    view.reach_m = number_in(request, "reach", view.reach_m);
    view.width = static_cast<int>(number_in(request, "width", 0));
    view.height = static_cast<int>(number_in(request, "height", 0));
    if (*kind == Kind::scan) {
      if (!sites) {
        Result<Sites> opened = open_sites(*model.simulation, project);
        if (!opened) return Problem{opened.problem()};
        sites.emplace(std::move(*opened));
      }
      sites->place(view, request.path.substr(0, request.path.find('.')), request.targets.at(0));
    }
    views.push_back(std::move(view));
  }
  return views;
} catch (const std::exception& error) {
  return Problem{error.what()};
}

}  // namespace tessera::project
