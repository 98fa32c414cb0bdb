#include "sim/variation.hpp"

#include <algorithm>
#include <random>
#include <string_view>

#include "sim/devices/device_error.hpp"
#include "sim/engine/complaint.hpp"
#include "sim/engine/elements.hpp"
#include "sim/engine/model.hpp"
#include "sim/engine/seeds.hpp"

namespace tessera::sim {
namespace {

void set_mass(mjModel& model, int body, double mass) {
  const double factor = mass / model.body_mass[body];
  model.body_mass[body] = mass;
  for (int axis = 0; axis < 3; ++axis) model.body_inertia[3 * body + axis] *= factor;
}

void set_damping(mjModel& model, int joint, double damping) {
  std::fill_n(model.dof_damping + model.jnt_dofadr[joint], velocity_size(model, joint), damping);
}

struct Quantity {
  std::string_view name;
  mjtObj type;
  void (*set)(mjModel& model, int id, double value);
};
constexpr Quantity quantities[] = {
    {"mass", mjOBJ_BODY, set_mass},
    {"friction", mjOBJ_GEOM,
     [](mjModel& model, int geom, double value) { model.geom_friction[3 * geom] = value; }},
    {"damping", mjOBJ_JOINT, set_damping},
};

Problem about(const Variation& variation, const std::string& text) {
  return Problem{"vary " + variation.what + " of " + variation.instance + ": " + text};
}

std::optional<Problem> vary(mjModel& model, const Variation& variation, std::uint64_t seed) {
  const std::size_t dot = variation.what.rfind('.');
  const std::string element = variation.what.substr(0, dot);
  const std::string_view name =
      dot == std::string::npos ? std::string_view() : std::string_view(variation.what).substr(dot + 1);
  const auto* const quantity = std::ranges::find(quantities, name, &Quantity::name);
  if (quantity == std::end(quantities))
    return about(variation, "write ELEMENT.mass, ELEMENT.friction or ELEMENT.damping");
  const auto id = find_element(model, quantity->type, variation.instance, element);
  if (!id) {
    const DriverProblem problem =
        unknown_name(word_for(quantity->type), element, names_for(model, quantity->type, variation.instance));
    return about(variation, problem.text + (problem.hint.empty() ? "" : "; " + problem.hint));
  }
  if (variation.least < 0 || (name == "mass" && variation.least == 0))
    return about(variation, "it must be positive");
  if (name == "mass" && model.body_mass[*id] <= 0) return about(variation, "the body has no mass of its own");
  std::mt19937_64 random(seed_of(variation.instance + " " + variation.what, seed));
  // Not std::uniform_real_distribution: its numbers differ from library to library.
  const double part = static_cast<double>(random() >> 11U) * 0x1p-53;
  quantity->set(model, *id, variation.least + part * (variation.most - variation.least));
  return std::nullopt;
}

}  // namespace

std::optional<Problem> vary(mjModel& model, const std::vector<Variation>& variations, std::uint64_t seed) {
  if (variations.empty()) return std::nullopt;
  for (const Variation& one : variations)
    if (auto problem = vary(model, one, seed)) return problem;
  // Updates the values that the engine derives from masses.
  const std::optional<Problem> complaint = complaint_of([&] {
    const DataPtr data(mj_makeData(&model));
    if (data) mj_setConst(&model, data.get());
  });
  return complaint ? std::optional(Problem{"vary: " + complaint->text}) : std::nullopt;
}

}  // namespace tessera::sim
