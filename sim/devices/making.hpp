#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "sim/devices/device_error.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

/// Adapters that all world libraries share: they turn exceptions into the results of the world interface.
namespace tessera::sim {

/// The result of `make`, or the problem that it throws.
template <class Make>
auto without_exceptions(Make&& make) -> decltype(make()) try {
  return make();
} catch (const std::exception& thrown) {
  return Problem{thrown.what()};
} catch (...) {
  return Problem{"the simulated world failed without saying why"};
}

/// The form of the world interface: nullptr and `error`.
template <class T>
std::unique_ptr<T> value_or_null(Result<std::unique_ptr<T>> made, std::string& error) {
  if (made) return std::move(*made);
  error = made.problem();
  return nullptr;
}

/// The same for a text.
inline bool text_or_false(Result<std::string> made, std::string& text, std::string& error) {
  if (made)
    text = std::move(*made);
  else
    error = made.problem();
  return static_cast<bool>(made);
}

/// A world whose devices are made by `make_receptor` and `make_effector` beside the context that they share.
template <class Context>
class WorldOfDevices : public World {
 public:
  explicit WorldOfDevices(Context context) : context_(std::move(context)) {}

  [[nodiscard]] std::unique_ptr<RealReceptor> receptor(const DriverRequest& request,
                                                       std::string& error) override {
    return device_or_error<RealReceptor>(request, error);
  }
  [[nodiscard]] std::unique_ptr<RealEffector> effector(const DriverRequest& request,
                                                       std::string& error) override {
    return device_or_error<RealEffector>(request, error);
  }
  [[nodiscard]] std::optional<DriverProblem> problem_with(const DriverRequest& request,
                                                          bool effector) override {
    DriverProblem problem;
    const bool made = effector ? device<RealEffector>(request, problem) != nullptr
                               : device<RealReceptor>(request, problem) != nullptr;
    return made ? std::nullopt : std::optional(std::move(problem));
  }

 protected:
  Context context_;  // devices may outlive the world

 private:
  template <class Device>
  std::unique_ptr<Device> device_or_error(const DriverRequest& request, std::string& error) {
    DriverProblem problem;
    std::unique_ptr<Device> made = device<Device>(request, problem);
    if (made == nullptr)
      error = request.path + ": " + problem.text + (problem.hint.empty() ? "" : "; " + problem.hint);
    return made;
  }

  template <class Device>
  std::unique_ptr<Device> device(const DriverRequest& request, DriverProblem& problem) try {
    if constexpr (std::is_same_v<Device, RealReceptor>)
      return make_receptor(context_, request);
    else
      return make_effector(context_, request);
  } catch (const DeviceError& error) {
    problem = error.problem();
    return nullptr;
  } catch (const std::exception& error) {
    problem.text = error.what();
    return nullptr;
  } catch (...) {
    problem.text = "the simulated world failed without saying why";
    return nullptr;
  }
};

}  // namespace tessera::sim
