#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tessera/device.hpp"

namespace tessera::sim {

/// A requested device cannot be made. The maker of the device throws it, and the world catches it.
class DeviceError : public std::runtime_error {
 public:
  explicit DeviceError(DriverProblem problem)
      : std::runtime_error(problem.text), problem_(std::move(problem)) {}
  DeviceError(std::string text, std::string hint, std::string subject = {})
      : DeviceError(DriverProblem{std::move(text), std::move(hint), std::move(subject)}) {}
  [[nodiscard]] const DriverProblem& problem() const { return problem_; }

 private:
  DriverProblem problem_;
};

/// text: "the world has no site 'eye_lef'"; hint: "did you mean 'eye_left'? the world has: ...".
[[nodiscard]] DriverProblem unknown_name(const std::string& what, const std::string& name,
                                         const std::vector<std::string>& known);

/// "a, b, c and 17 more"
[[nodiscard]] std::string short_list(const std::vector<std::string>& names);

}  // namespace tessera::sim
