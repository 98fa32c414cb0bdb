#include "sim/judging/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include "sim/devices/device_error.hpp"
#include "sim/engine/elements.hpp"
#include "sim/engine/shapes.hpp"

namespace tessera::sim {
namespace {

/// A name as checks write it: "/cart" names a part of the world itself.
std::string plain(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

/// 3 for "robot[3]/chassis" and "robot"; nullopt: it is no part of such a model.
std::optional<std::int64_t> index_in(std::string_view element, std::string_view name) {
  if (!element.starts_with(name) || element.substr(name.size()).find('[') != 0) return std::nullopt;
  const std::string_view rest = element.substr(name.size() + 1);
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), index);
  const std::string_view after = rest.substr(static_cast<std::size_t>(end - rest.data()));
  const bool whole = after == "]" || after.starts_with("]/");
  return error == std::errc() && whole ? std::optional(index) : std::nullopt;
}

/// Whether the body can move relative to its parent.
bool moves(const mjModel& model, int body) {
  return model.body_dofnum[body] > 0 || model.body_mocapid[body] >= 0;
}

/// The last body of a planar base, whose bodies carry each other: one slides in x, one in y, one turns.
int carried_by(const mjModel& model, int body) {
  while (model.body_geomnum[body] == 0) {
    std::vector<int> children;
    for (int child = body + 1; child < model.nbody; ++child)
      if (model.body_parentid[child] == body) children.push_back(child);
    if (children.size() != 1 || !moves(model, children.front())) break;
    body = children.front();
  }
  return body;
}

}  // namespace

std::vector<std::int64_t> Scene::indices_of(std::string_view name) const {
  std::set<std::int64_t> indices;
  for (int body = 0; body < physics_.model().nbody; ++body)
    if (const auto index = index_in(name_of(physics_.model(), mjOBJ_BODY, body), name))
      indices.insert(*index);
  return {indices.begin(), indices.end()};
}

std::vector<std::string> Scene::groups() const {
  std::set<std::string> names;
  for (int body = 0; body < physics_.model().nbody; ++body) {
    const std::string name = name_of(physics_.model(), mjOBJ_BODY, body);
    const std::string before = name.substr(0, name.find('['));
    if (index_in(name, before)) names.insert(before + "[*]");
  }
  return {names.begin(), names.end()};
}

/// In the order of the model, so that the first is the root of the others.
std::vector<int> Scene::bodies_of_model(const std::string& name) const {
  const mjModel& model = physics_.model();
  std::vector<int> bodies;
  for (int body = 1; body < model.nbody; ++body) {
    const std::string its_name = name_of(model, mjOBJ_BODY, body);
    if (its_name == name || its_name.starts_with(name + "/")) bodies.push_back(body);
  }
  return bodies;
}

/// The body at the origin of a placed model: the one that drives, or else its frame.
Result<int> Scene::root_of_model(const std::string& name, const std::vector<int>& bodies) const {
  const mjModel& model = physics_.model();
  const auto is_frame = [&](int body) { return name_of(model, mjOBJ_BODY, body) == name; };
  if (is_frame(bodies.front()) && moves(model, bodies.front())) return bodies.front();
  std::vector<int> moving;
  for (const int body : bodies) {
    const int parent = model.body_parentid[body];
    const bool on_top = is_frame(parent) || std::ranges::find(bodies, parent) == bodies.end();
    if (on_top && moves(model, body)) moving.push_back(body);
  }
  if (moving.size() > 1)
    return Problem{fmt::format("'{}' has several bodies that move on their own; name one, such as '{}'", name,
                               name_of(model, mjOBJ_BODY, moving.front()))};
  return moving.empty() ? bodies.front() : carried_by(model, moving.front());
}

Result<std::optional<Scene::Element>> Scene::point_named(const std::string& name) const {
  const mjModel& model = physics_.model();
  if (const std::vector<int> bodies = bodies_of_model(plain(name)); !bodies.empty()) {
    const bool placed = std::ranges::any_of(
        bodies, [&](int body) { return name_of(model, mjOBJ_BODY, body) != plain(name); });
    if (placed) {
      const Result<int> root = root_of_model(plain(name), bodies);
      if (!root) return Problem{root.problem()};
      return std::optional(Element{mjOBJ_BODY, *root});
    }
  }
  for (const mjtObj type : {mjOBJ_BODY, mjOBJ_GEOM, mjOBJ_SITE})
    if (const auto id = find_element(model, type, "", plain(name))) return std::optional(Element{type, *id});
  return std::optional<Element>();
}

Problem Scene::unknown(const char* what, const std::string& name, std::initializer_list<mjtObj> types) const {
  std::vector<std::string> known;
  for (const mjtObj type : types)
    for (std::string& one : names_of(physics_.model(), type)) known.push_back(std::move(one));
  const DriverProblem problem = unknown_name(what, name, known);
  return Problem{problem.text + (problem.hint.empty() ? "" : "; " + problem.hint)};
}

Result<std::size_t> Scene::find(As as, const std::string& name) {
  if (as == As::solid) return find_solid(name);
  if (as == As::follower) return find_follower(name);
  if (as == As::point) {
    const Result<std::optional<Element>> element = point_named(name);
    if (!element) return Problem{element.problem()};
    if (!*element) return unknown("model, body, geom or site", name, {mjOBJ_BODY, mjOBJ_GEOM, mjOBJ_SITE});
    elements_.push_back(**element);
  } else {
    const mjtObj type = as == As::zone ? mjOBJ_SITE : mjOBJ_SENSOR;
    const auto id = find_element(physics_.model(), type, "", plain(name));
    if (!id) return unknown(word_for(type), name, {type});
    elements_.push_back({type, *id});
  }
  return elements_.size() - 1;
}

Result<std::size_t> Scene::find_follower(const std::string& name) {
  if (eyes_.floor() == nullptr) return Problem{"only a world with a track has a line to follow"};
  const Result<std::optional<Element>> element = point_named(name);
  if (!element) return Problem{element.problem()};
  if (!*element || (*element)->type != mjOBJ_BODY) return unknown("model or body", name, {mjOBJ_BODY});
  if (!line_) line_ = std::make_shared<const Skeleton>(skeleton(*eyes_.floor()));
  if (line_->points.size() < 2) return Problem{"there is no line on the track"};
  followers_.emplace_back(name, physics_.root_of_body((*element)->id), line_);
  return followers_.size() - 1;
}

void Scene::follow_lines() {
  for (LineFollower& follower : followers_) follower.look(physics_, eyes_);
}

std::vector<bool> Scene::geoms_of(const std::string& name) const {
  const mjModel& model = physics_.model();
  std::vector<bool> geoms(static_cast<std::size_t>(model.ngeom));
  std::vector<int> bodies = bodies_of_model(name);
  if (const auto body = find_element(model, mjOBJ_BODY, "", plain(name))) bodies.push_back(*body);
  if (const auto geom = find_element(model, mjOBJ_GEOM, "", plain(name)); geom && bodies.empty())
    geoms[static_cast<std::size_t>(*geom)] = true;
  for (int geom = 0; geom < model.ngeom; ++geom)
    if (std::ranges::any_of(bodies,
                            [&](int body) { return is_part_of(model, model.geom_bodyid[geom], body); }))
      geoms[static_cast<std::size_t>(geom)] = true;
  return geoms;
}

Result<std::size_t> Scene::find_solid(const std::string& name) {
  if (const auto known = solids_.find(name); known != solids_.end()) return known->second;
  const std::vector<bool> geoms = geoms_of(name);
  if (std::ranges::find(geoms, true) == geoms.end()) {
    if (const auto element = point_named(name); !element || *element)
      return Problem{"'" + name + "' has no shape that could touch anything"};
    return unknown("model, body or geom", name, {mjOBJ_BODY, mjOBJ_GEOM});
  }
  const std::size_t solid = solids_.size();
  solids_.emplace(name, solid);
  touching_anything_.push_back(false);
  solids_of_geom_.resize(geoms.size());
  for (std::size_t geom = 0; geom < geoms.size(); ++geom)
    if (geoms[geom]) solids_of_geom_[geom].push_back(solid);
  return solid;
}

std::size_t Scene::dimension_of(std::size_t sensor) const {
  return static_cast<std::size_t>(physics_.model().sensor_dim[elements_[sensor].id]);
}

std::array<double, 3> Scene::position(std::size_t point) {
  const auto [type, id] = elements_[point];
  const mjData& now = physics_.positions();
  const mjtNum* const at = (type == mjOBJ_BODY   ? now.xpos
                            : type == mjOBJ_GEOM ? now.geom_xpos
                                                 : now.site_xpos) +
                           3 * id;
  return {at[0], at[1], at[2]};
}

const mjData& Scene::state() const {
  const mjData& now = physics_.state();
  if (physics_.failure()) throw std::runtime_error(physics_.failure()->text);
  return now;
}

double Scene::speed(std::size_t point) {
  const auto [type, id] = elements_[point];
  mjtNum velocity[6] = {};
  mj_objectVelocity(&physics_.model(), &state(), type, id, velocity, 0);
  return std::hypot(velocity[3], velocity[4], velocity[5]);
}

void Scene::note_contacts() {
  if (solids_.empty()) return;
  physics_.for_contacts_of_last_step([this](int geom, int other) { note_contact(geom, other); });
}

void Scene::note_contact(int geom, int other) {
  const auto& ones = solids_of_geom_[static_cast<std::size_t>(geom)];
  const auto& others = solids_of_geom_[static_cast<std::size_t>(other)];
  const auto has = [](const std::vector<std::size_t>& solids, std::size_t solid) {
    return std::ranges::find(solids, solid) != solids.end();
  };
  for (const std::size_t one : ones)
    if (!has(others, one)) touching_anything_[one] = true;
  for (const std::size_t two : others)
    if (!has(ones, two)) touching_anything_[two] = true;
  for (const std::size_t one : ones)
    for (const std::size_t two : others)
      if (one != two) touching_.insert(std::minmax(one, two));
}

void Scene::forget_contacts() {
  touching_.clear();
  touching_anything_.assign(touching_anything_.size(), false);
}

bool Scene::touched(std::size_t solid, std::size_t other) {
  return !touching_.empty() && touching_.contains(std::minmax(solid, other));
}

bool Scene::touched_anything(std::size_t solid) { return touching_anything_[solid]; }

bool Scene::inside(std::size_t point, std::size_t zone) {
  const std::array<double, 3> at = position(point);
  return is_inside_site(physics_.model(), physics_.positions(), elements_[zone].id, at.data());
}

double Scene::sensor(std::size_t sensor, std::size_t component) {
  const mjModel& model = physics_.model();
  return state().sensordata[model.sensor_adr[elements_[sensor].id] + static_cast<int>(component)];
}

}  // namespace tessera::sim
