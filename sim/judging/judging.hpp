#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "checks/checks.hpp"
#include "sim/judging/scene.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// The checks and measures of a run, as the simulation file has them, on the physics of a world.
class Judging {
 public:
  /// json: a list of {"name", "when", "formula", "text"?, "within_s"?} at "checks", and an object of {"number",
  /// "unit"} at "measures" (without a unit also the text of the number alone); empty: none of both. Problem: a check or measure that does not fit the world. physics, eyes: must outlive this
  /// object; eyes may come after this call.
  [[nodiscard]] static Result<std::unique_ptr<Judging>> read(const std::string& json, const Physics& physics,
                                                             const Eyes& eyes);

  /// Call it after every step: notes contacts, and judges every 10 ms.
  void after_step();
  /// Judges what holds at the end, once.
  void finish();
  [[nodiscard]] std::vector<WorldFailure> take_failures();
  /// {"checks": [{"name", "text", "verdict", "time_s"?, "detail"?}], "measures": {NAME: {"least",
  /// "least_at_s", "greatest", "greatest_at_s", "mean", "last", "unit"?}}, "curves": [{"name", "check", "truth"?,
  /// "limit"?, "unit"?, "every_s", "spans": [[least, greatest] or null...]}]} as JSON; empty: there are none.
  [[nodiscard]] std::string results() const;

 private:
  Judging(const Physics& physics, const Eyes& eyes) : physics_(physics), scene_(physics, eyes) {}

  const Physics& physics_;
  Scene scene_;
  std::optional<checks::Judge> judge_;
  Duration next_{0};
  bool finished_ = false;
};

}  // namespace tessera::sim
