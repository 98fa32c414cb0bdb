#include "sim/devices.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/unknown_name.hpp"

namespace tessera::sim {
namespace {

[[noreturn]] void refuse_size(const std::string& path, std::size_t bytes) {
  throw std::invalid_argument(path +
                              ": the device has a float64 or a float32 (8 or 4 bytes), the buffer has " +
                              std::to_string(bytes) + " bytes");
}

template <class Float>
double number_in(std::span<const std::byte> value) {
  Float number = 0;
  std::memcpy(&number, value.data(), sizeof number);
  return number;
}

template <class Float>
void put_number(double number, std::span<std::byte> value) {
  const auto as_float = static_cast<Float>(number);
  std::memcpy(value.data(), &as_float, sizeof as_float);
}

/// The type of the buffer is determined by its size; the specification allows only these two types.
double read_float(std::span<const std::byte> value, const std::string& path) {
  if (value.size() == sizeof(double)) return number_in<double>(value);
  if (value.size() == sizeof(float)) return number_in<float>(value);
  refuse_size(path, value.size());
}

void write_float(double number, std::span<std::byte> value, const std::string& path) {
  if (value.size() == sizeof(double)) return put_number<double>(number, value);
  if (value.size() == sizeof(float)) return put_number<float>(number, value);
  refuse_size(path, value.size());
}

/// FNV-1a: the same on every machine, unlike std::hash.
std::uint64_t hash_of(std::string_view text, std::uint64_t hash) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

class LightSensor final : public RealReceptor {
 public:
  LightSensor(std::shared_ptr<Simulation> simulation, std::string path, int eye, double noise,
              std::uint64_t seed)
      : simulation_(std::move(simulation)), path_(std::move(path)), eye_(eye), noise_(noise), random_(seed) {}

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    const double light = std::clamp(simulation_->light_at(eye_) + noise_ * normal_(random_), 0.0, 1.0);
    write_float(light, value, path_);
    return true;
  }

 private:
  std::shared_ptr<Simulation> simulation_;
  std::string path_;
  int eye_;
  double noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

class Wheel final : public RealEffector {
 public:
  Wheel(std::shared_ptr<Simulation> simulation, std::string path, int actuator)
      : simulation_(std::move(simulation)), path_(std::move(path)), actuator_(actuator) {}

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    const double velocity = read_float(value, path_);
    if (!std::isfinite(velocity)) return false;
    simulation_->command(actuator_, velocity);
    return true;
  }

 private:
  std::shared_ptr<Simulation> simulation_;
  std::string path_;
  int actuator_;
};

/// Options must be among `known`, finite and not negative.
std::optional<Problem> problem_of_options(const DriverRequest& request,
                                          const std::vector<std::string>& known) {
  for (const auto& [name, value] : request.options) {
    if (std::ranges::find(known, name) == known.end()) return Problem{unknown_name("option", name, known)};
    if (!std::isfinite(value) || value < 0)
      return Problem{"option '" + name + "' must be a number from 0 up"};
  }
  return std::nullopt;
}

double option(const DriverRequest& request, const std::string& name, double otherwise) {
  const auto found = request.options.find(name);
  return found == request.options.end() ? otherwise : found->second;
}

}  // namespace

Result<std::unique_ptr<RealReceptor>> light_sensor(std::shared_ptr<Simulation> simulation,
                                                   const DriverRequest& request, double footprint_m,
                                                   std::uint64_t seed) {
  if (auto problem = problem_of_options(request, {"noise", "footprint"})) return std::move(*problem);
  const auto eye = simulation->add_eye(request.target, option(request, "footprint", footprint_m));
  if (!eye) return Problem{eye.problem()};
  const std::uint64_t own_seed =
      hash_of(request.path, seed * 0x9e3779b97f4a7c15ULL + 14695981039346656037ULL);
  return std::unique_ptr<RealReceptor>(std::make_unique<LightSensor>(
      std::move(simulation), request.path, *eye, option(request, "noise", 0.01), own_seed));
}

Result<std::unique_ptr<RealEffector>> wheel(std::shared_ptr<Simulation> simulation,
                                            const DriverRequest& request) {
  if (auto problem = problem_of_options(request, {})) return std::move(*problem);
  const auto actuator = simulation->add_actuator(request.target);
  if (!actuator) return Problem{actuator.problem()};
  return std::unique_ptr<RealEffector>(
      std::make_unique<Wheel>(std::move(simulation), request.path, *actuator));
}

}  // namespace tessera::sim
