#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tessera/device.hpp"

/// A world in which a wheel's speed adds up to a position. WorldOptions::track names an element that must not
/// exist; its trace has a line per call. "seen.xml" has a picture with two bodies. "slow.xml" takes four
/// times as long as the time that passes in it. "stopped.xml" gets a SIGTERM at its first step, and
/// "fails.xml" fails at 20 ms.
namespace {

struct State {
  std::mutex mutex;  // devices and physics come from different threads
  double position = 0, speed = 0;
};

class Position final : public tessera::RealReceptor {
 public:
  explicit Position(std::shared_ptr<State> state) : state_(std::move(state)) {}
  bool read(std::span<std::byte> value) override {
    const std::lock_guard lock(state_->mutex);
    std::copy_n(reinterpret_cast<const std::byte*>(&state_->position), sizeof(double), value.data());
    return true;
  }

 private:
  std::shared_ptr<State> state_;
};

class Wheel final : public tessera::RealEffector {
 public:
  explicit Wheel(std::shared_ptr<State> state) : state_(std::move(state)) {}
  bool write(std::span<const std::byte> value) override {
    const std::lock_guard lock(state_->mutex);
    std::copy_n(value.data(), sizeof(double), reinterpret_cast<std::byte*>(&state_->speed));
    return true;
  }

 private:
  std::shared_ptr<State> state_;
};

class FakeWorld final : public tessera::World {
 public:
  explicit FakeWorld(const tessera::WorldOptions& options) : options_(options) {}
  std::unique_ptr<tessera::RealReceptor> receptor(const tessera::DriverRequest& request,
                                                  std::string& error) override {
    if (request.targets.front() == options_.track) {
      error = "there is no " + request.targets.front();
      return nullptr;
    }
    return std::make_unique<Position>(state_);
  }
  std::unique_ptr<tessera::RealEffector> effector(const tessera::DriverRequest&, std::string&) override {
    return std::make_unique<Wheel>(state_);
  }
  void advance_to(tessera::Time time) override {
    if (options_.world == "slow.xml") std::this_thread::sleep_for(4 * (time - now_));
    if (options_.world == "stopped.xml" && time > tessera::Time{}) std::raise(SIGTERM);
    if (options_.world == "fails.xml" && time >= tessera::Time(std::chrono::milliseconds(20)))
      throw std::runtime_error("the physics failed at 0.020 s");
    const std::lock_guard lock(state_->mutex);
    state_->position += state_->speed * tessera::seconds(time - now_);
    now_ = time;
    trace_.push_back(tessera::seconds(time.time_since_epoch()));
    std::array<tessera::BodyPose, 2> poses{};
    poses[0].position_m[0] = state_->position;
    if (sink_ != nullptr) sink_->take(time, poses);
  }
  std::optional<tessera::WorldScene> scene(std::span<const tessera::DriverRequest> devices) override {
    if (options_.world != "seen.xml") return std::nullopt;
    const std::string agent = devices.empty() ? "" : devices[0].path.substr(0, devices[0].path.find('.'));
    return tessera::WorldScene{.glb = "glTF", .bodies = {{"wheel", agent}, {"stone", ""}}};
  }
  void show_poses(tessera::PoseSink& sink) override { sink_ = &sink; }
  bool finish(std::string& error) override {
    if (options_.trace.empty()) return true;
    std::ofstream file(options_.trace);
    for (const double time : trace_) file << time << '\n';
    error = "disk full";
    return static_cast<bool>(file << std::flush);
  }

 private:
  tessera::WorldOptions options_;
  std::shared_ptr<State> state_ = std::make_shared<State>();
  tessera::Time now_{};
  std::vector<double> trace_;
  tessera::PoseSink* sink_ = nullptr;
};

}  // namespace

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif
extern "C" std::unique_ptr<tessera::World> tessera_open_world_4(const tessera::WorldOptions& options,
                                                                std::string& error) {
  if (options.world == "missing.xml") {
    error = "no such world: missing.xml";
    return nullptr;
  }
  return std::make_unique<FakeWorld>(options);
}
