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

/// The checks and measures of a run, as in the simulation file, on the physics of a world.
class Judging {
 public:
  /// json: a list of {"name", "when", "formula", "text"?, "within_s"?} at "checks", and an object of
  /// {"number", "unit"} at "measures" (the text of the number alone: no unit); empty: neither. Problem: a check
  /// or measure does not fit the world. physics, eyes: must outlive this object; eyes may be added after this
  /// call.
  [[nodiscard]] static Result<std::unique_ptr<Judging>> read(const std::string& json, const Physics& physics,
                                                             const Eyes& eyes);

  /// Call it after every step. It notes contacts, and judges every 10 ms.
  void after_step();
  /// Judges the conditions that hold at the end, once.
  void finish();
  [[nodiscard]] std::vector<WorldFailure> take_failures();
  /// JSON: {"checks": [{"name", "text", "verdict", "time_s"?, "detail"?}], "measures": {NAME: {"least",
  /// "least_at_s", "greatest", "greatest_at_s", "mean", "last", "unit"?}}, "curves": [{"name", "check", "truth"?,
  /// "limit"?, "unit"?, "every_s", "spans": [[least, greatest] or null...]}]}; empty: there are none.
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
