#include "sim/devices/reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tessera::sim {
namespace {

class Reading final : public RealReceptor {
 public:
  Reading(std::shared_ptr<Simulation> simulation, Buffer buffer, Look look, Distort distort)
      : simulation_(std::move(simulation)),
        buffer_(std::move(buffer)),
        look_(std::move(look)),
        distort_(std::move(distort)),
        numbers_(buffer_.size()) {}

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    simulation_->use([this](const Physics& physics) { look_(physics, numbers_); });
    if (distort_) distort_(numbers_);
    buffer_.put(numbers_, value);
    return true;
  }

 private:
  std::shared_ptr<Simulation> simulation_;
  Buffer buffer_;
  Look look_;
  Distort distort_;
  std::vector<double> numbers_;
};

class Commanding final : public RealEffector {
 public:
  Commanding(std::shared_ptr<Simulation> simulation, Buffer buffer, Act act)
      : simulation_(std::move(simulation)), buffer_(std::move(buffer)), act_(std::move(act)) {}

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    const std::span<const double> numbers = buffer_.take(value);
    if (!std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); })) return false;
    bool taken = false;
    simulation_->command([&](Physics& physics) { taken = act_(physics, numbers); });
    return taken;
  }

 private:
  std::shared_ptr<Simulation> simulation_;
  Buffer buffer_;
  Act act_;
};

}  // namespace

int element_of(const Physics& physics, mjtObj type, const DriverRequest& request, const std::string& name) {
  const std::string agent = request.agent();
  if (const auto id = find_element(physics.model(), type, agent, name)) return *id;
  throw DeviceError(unknown_name(word_for(type), name, names_for(physics.model(), type, agent)));
}

void claim(const DeviceContext& context, const DriverRequest& request, mjtObj type,
           std::span<const int> elements) {
  std::vector<Writers::Element> claimed;
  for (std::size_t index = 0; index < elements.size(); ++index) {
    const std::string& name = request.targets[index];
    claimed.push_back({fmt::format("{} {}", word_for(type), elements[index]),
                       fmt::format("{} '{}'", word_for(type), name), name});
  }
  context.writers->claim(request, claimed);
}

const std::string& only_target(const DriverRequest& request) {
  if (request.targets.size() == 1) return request.targets[0];
  throw DeviceError("'" + request.kind + "' has one target, not a list", "");
}

FrameTarget frame_target(const Physics& physics, const DriverRequest& request, const std::string& name) {
  const std::string agent = request.agent();
  for (const mjtObj type : {mjOBJ_BODY, mjOBJ_SITE})
    if (const auto id = find_element(physics.model(), type, agent, name)) return {type, *id};
  std::vector<std::string> names = names_for(physics.model(), mjOBJ_BODY, agent);
  std::erase(names, "world");
  for (std::string& site : names_for(physics.model(), mjOBJ_SITE, agent)) names.push_back(std::move(site));
  throw DeviceError(unknown_name("body or site", name, names));
}

std::unique_ptr<RealReceptor> reading(std::shared_ptr<Simulation> simulation, Buffer buffer, Look look,
                                      Distort distort) {
  return std::make_unique<Reading>(std::move(simulation), std::move(buffer), std::move(look),
                                   std::move(distort));
}

std::unique_ptr<RealEffector> commanding(std::shared_ptr<Simulation> simulation, Buffer buffer, Act act) {
  return std::make_unique<Commanding>(std::move(simulation), std::move(buffer), std::move(act));
}

}  // namespace tessera::sim
