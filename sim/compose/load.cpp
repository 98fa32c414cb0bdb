#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "sim/compose/comparison.hpp"
#include "sim/compose/compose.hpp"
#include "sim/compose/keyframe.hpp"
#include "sim/mjcf/compile.hpp"

namespace tessera::sim {
namespace {

/// Names that the composer made end in "(12)". Names of a model file or of an instance never do.
bool is_generated(std::string_view name) {
  const auto slash = name.rfind('/');
  const std::string_view last = slash == std::string_view::npos ? name : name.substr(slash + 1);
  return last.size() > 2 && last.front() == '(' && last.back() == ')' &&
         last.substr(1, last.size() - 2).find_first_not_of("0123456789") == std::string_view::npos;
}

void take_generated_names_away(mjModel& model) {
  for (int at = 0; at < model.nnames;) {
    const std::string_view name = model.names + at;
    if (is_generated(name)) model.names[at] = '\0';
    at += static_cast<int>(name.size()) + 1;
  }
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

}  // namespace

Result<ComposedWorld> load(const Composition& composition) {
  Result<ModelPtr> model = compile_text(composition.mjcf);
  if (!model) return Problem{"the composed world: " + model.problem()};
  for (const PlacedModel& placed : composition.placed) {
    if (const auto found = differences(**model, placed); !found.empty())
      return Problem{placed.placement.name + ": " + placed.placement.model +
                     " would not be in this world what it is alone: " + joined(found)};
  }
  InitialState initial = initial_state(**model, composition.initial);
  take_generated_names_away(**model);
  return ComposedWorld{std::move(*model), std::move(initial), composition.warnings};
}

void set_state(const mjModel& model, const InitialState& initial, mjData& data) {
  static_cast<void>(model);
  std::ranges::copy(initial.positions, data.qpos);
  std::ranges::copy(initial.velocities, data.qvel);
  std::ranges::copy(initial.activations, data.act);
  std::ranges::copy(initial.controls, data.ctrl);
  std::ranges::copy(initial.mocap_positions, data.mocap_pos);
  std::ranges::copy(initial.mocap_quaternions, data.mocap_quat);
}

}  // namespace tessera::sim
