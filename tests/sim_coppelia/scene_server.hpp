#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "reply_server.hpp"
#include "sim/trace.hpp"
#include "sim/track.hpp"
#include "tessera/device.hpp"

namespace tessera::testing {

/// A small simulator of our own that speaks the remote API of CoppeliaSim as it was recorded.
///
/// Its scene is the robot of line_world.xml on a picture of a floor: two driven wheels that do not slip and
/// three eyes. Beside it stand a camera, a proximity sensor, a force sensor and a few joints.
///
/// Threads: the members may be called while a client is served.
class SceneServer {
 public:
  struct Settings {
    std::string track;  ///< PNG; empty: a white floor
    sim::Pose start{};
    double step_s = 0.01;
    int version = 40900;        ///< of the program
    bool runs_already = false;  ///< a simulation that another client started
    std::uint16_t port = 0;     ///< 0: a free one
    int waits_per_step = 3;     ///< how often a step asks the client to wait
    bool no_main_script = false;
    bool no_marks = false;         ///< refuses to call functions of scripts
    std::set<std::string> silent;  ///< functions that never answer
    std::string late;              ///< a function that answers late the first time
    std::chrono::milliseconds lateness{0};
  };

  explicit SceneServer(Settings settings);

  [[nodiscard]] WorldServer address() const;
  void stop() { server_->stop(); }
  /// The robot at every step.
  [[nodiscard]] sim::Trace trace() const;
  [[nodiscard]] bool is_running() const;
  /// The names of all functions that were called, in order.
  [[nodiscard]] std::vector<std::string> calls() const;
  [[nodiscard]] double joint(const std::string& path) const;
  /// Makes the simulation step without a request.
  void step_by_itself();
  /// The numbers of the open scenes; the last one is the current one.
  [[nodiscard]] std::vector<int> scenes() const;
  void pause();
  void stop_by_hand();
  /// As CoppeliaSim does it: the simulation still makes some steps, without waiting for clients.
  void begin_to_stop_by_hand();
  /// A simulation runs that left these signals.
  void run_by_hand(const std::map<std::string, std::string>& signals);
  [[nodiscard]] std::map<std::string, std::string> signals() const;

 private:
  using json = nlohmann::json;
  struct Thing {
    std::string path;
    int type = 0;
    int mode = 0, control = 0;  ///< of a joint
    double position = 0, velocity = 0, target = 0;
    std::array<double, 2> at{};  ///< of an eye, in the frame of the robot
    bool is_explicit = false;
  };
  std::optional<Bytes> answer(const Bytes& request);
  json execute(const std::string& function, const json& arguments);
  json of_scenes(const std::string& function, const json& arguments);
  json of_simulation(const std::string& function, const json& arguments);
  json of_object(const std::string& function, const json& arguments);
  json of_joint(const std::string& function, const json& arguments);
  json of_sensor(const std::string& function, const json& arguments);
  Thing& thing(const json& handle);
  [[nodiscard]] sim::Point eye_at(const Thing& eye) const;
  [[nodiscard]] double brightness(const Thing& eye) const;
  void step();
  void end();

  Settings settings_;
  std::optional<sim::Track> floor_;
  sim::Pose robot_;
  std::vector<Thing> things_;  // a handle is the index and 10
  /// As in CoppeliaSim, each open scene has a number, and one is open always.
  struct OpenScene {
    int number = 0;
    bool is_empty = false;
  };
  std::vector<OpenScene> scenes_{{1, false}};
  int last_scene_ = 1;
  double time_s_ = 0;
  int state_ = 0;
  bool is_stepping_ = false;
  int waits_left_ = 0;
  std::map<std::string, std::string> signals_;
  sim::Trace trace_;
  std::vector<std::string> calls_;
  mutable std::mutex mutex_;
  std::unique_ptr<ReplyServer> server_;
};

}  // namespace tessera::testing
