#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "checks/checks.hpp"
#include "diagnostics/diagnostics.hpp"

/// The settings of the world itself in `simulation:`.
namespace tessera::spec {

/// One model that is placed in the simulated world: a robot of an agent, or a thing.
struct ModelPlacement {
  std::string instance;  ///< "robot[3]", "arm", "box[0]"; the elements get the names `robot[3]/...`
  bool is_agent = false;
  std::string model;  ///< MJCF file
  diagnostics::Span model_span;
  std::optional<std::array<double, 3>> at_m;  ///< unset: as the model has it, or drawn by `scatter`
  double heading_rad = 0;
  std::string pose;     ///< keyframe of the model; empty: none
  std::string scatter;  ///< site of the world in which the place is drawn from the seed; empty: none
  double apart_m = 0;   ///< least distance of scattered models
  /// A value that is drawn from the seed: "box.mass" between the two numbers.
  std::map<std::string, std::pair<double, double>> vary;
  diagnostics::Span span;
};

struct Track {
  std::string image;
  diagnostics::Span image_span;
  double metres_per_pixel = 0.005;
  std::optional<double> start_x_m, start_y_m, start_heading_rad;
  double footprint_m = 0.008;
};

/// The checks and measures of a simulated run.
struct WorldCheck {
  checks::Check check;
  diagnostics::Span span;  ///< of the formula
};
/// The most that all agents together may use of a resource in a simulated run:
/// `{ name: battery, at_most: { energy: 200 J } }`.
struct UseCheck {
  std::string name;
  std::string resource, unit;  ///< "energy", "J"
  double most = 0;             ///< in this unit
  diagnostics::Span span;      ///< of the entry of the resource
};
/// A number that a simulated run tells.
struct WorldMeasure {
  checks::Measure measure;
  diagnostics::Span span;  ///< of the number
};

/// CoppeliaSim, which simulates the world as a server of its own.
struct CoppeliaServer {
  std::string host = "localhost";
  std::uint16_t port = 23000;
  std::string scene;  ///< file; empty: the scene that it has open
  diagnostics::Span scene_span;
  std::chrono::nanoseconds timeout = std::chrono::seconds(10);  ///< for one answer
  diagnostics::Span span;
};

}  // namespace tessera::spec
