#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "sim/physics.hpp"
#include "sim/trace_writer.hpp"
#include "sim/track.hpp"

namespace tessera::sim {

/// What a world and its devices share: physics over a floor, and the trace of the robot.
///
/// Threads: all members lock.
class Simulation {
 public:
  /// `floor` absent: white everywhere.
  Simulation(std::unique_ptr<Physics> physics, std::optional<Track> floor, std::string trace);

  void advance_to(Time time);
  [[nodiscard]] bool finish(std::string& error);

  /// The site as a light sensor, which from now on counts for the trace. nullopt and `error` when there is
  /// none.
  [[nodiscard]] std::optional<int> add_eye(const std::string& site, double footprint_m, std::string& error);
  [[nodiscard]] std::optional<int> find_actuator(const std::string& name, std::string& error) const;

  /// 0 dark .. 1 bright, without noise. Throws std::runtime_error once the physics has failed.
  [[nodiscard]] double light_at(int eye);
  /// Throws std::runtime_error once the physics has failed.
  void command(int actuator, double value);

 private:
  struct Eye {
    int site;
    double footprint_m;
  };
  [[nodiscard]] double light_under(const Eye& eye);
  void sample();
  void throw_failure() const;

  mutable std::mutex mutex_;
  std::unique_ptr<Physics> physics_;
  std::optional<Track> floor_;
  std::vector<Eye> eyes_;
  TraceWriter trace_;
  Duration next_sample_{0};
};

}  // namespace tessera::sim
