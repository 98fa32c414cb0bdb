#pragma once

#include <exception>
#include <memory>
#include <string>
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

inline std::string sentence(const DriverProblem& problem) {
  return problem.text + (problem.hint.empty() ? "" : "; " + problem.hint);
}

/// The result of `make`. nullptr and the problem if it throws.
template <class Make>
auto device_or_problem(Make&& make, DriverProblem& problem) -> decltype(make()) try {
  return make();
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

/// The form of the world interface: nullptr, and in `error` the path and the reason.
template <class Make>
auto device_or_error(Make&& make, const DriverRequest& request, std::string& error) {
  DriverProblem problem;
  auto made = device_or_problem(std::forward<Make>(make), problem);
  if (!made) error = request.path + ": " + sentence(problem);
  return made;
}

}  // namespace tessera::sim
