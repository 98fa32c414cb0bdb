#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tessera/time.hpp"
#include "tessera/world_state.hpp"

namespace tessera {

/// An option of a driver as the specification gives it: `pin: 4`, `radius: 33 mm`, `device:
/// /dev/ttyUSB0`, `inverted: true`.
struct DriverOption {
  std::string_view name;
  std::variant<bool, double, std::string_view> value;
  std::string_view unit{};  ///< of a number, as written; empty: none
};

/// Thrown when a driver cannot work as the specification asks. The run does not start; the message is shown
/// with the driver's path and the line of the specification.
class DriverError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Tells a driver its path and its options in the specification. A driver whose constructor takes a `const
/// tessera::DriverSetup&` is given one; every other driver is default-constructed and has no options.
///
/// The constructor asks for every option that the driver knows. An option that it did not ask for is an
/// error, so a misspelled option is always reported.
///
/// Errors:  each accessor throws DriverError if the option is missing (unless `_or` gives a value for that
///          case) or has another type.
/// Threads: one at a time.
class DriverSetup {
 public:
  /// path: "robot[3].motor.left", or "arm.joints" for a driver of all real buffers of a subsystem. The data
  /// that the options refer to must outlive the setup. Unit tests of drivers may use this constructor, too.
  explicit DriverSetup(std::string path, std::vector<DriverOption> options = {},
                       std::shared_ptr<WorldState> world = nullptr);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& agent() const { return agent_; }            ///< "robot[3]"
  [[nodiscard]] std::optional<std::uint32_t> index() const { return index_; }  ///< 3; nullopt: no fleet
  [[nodiscard]] const std::string& subsystem() const { return subsystem_; }    ///< "motor"
  /// "left"; empty: the driver serves all real buffers of the subsystem.
  [[nodiscard]] const std::string& buffer() const { return buffer_; }

  /// The simulated world, for simulated drivers. Throws DriverError if there is none.
  [[nodiscard]] std::shared_ptr<WorldState> world() const;

  [[nodiscard]] bool has(std::string_view option) const;
  /// A number in `unit`: units of tessera/units.hpp are converted; others have to be the same text. A number
  /// without a unit counts as one in `unit`. With an empty `unit`, the option must not have one.
  [[nodiscard]] double number(std::string_view option, std::string_view unit = {}) const;
  [[nodiscard]] double number_or(std::string_view option, double otherwise, std::string_view unit = {}) const;
  /// A whole number without a unit.
  [[nodiscard]] std::int64_t integer(std::string_view option) const;
  [[nodiscard]] std::int64_t integer_or(std::string_view option, std::int64_t otherwise) const;
  [[nodiscard]] std::string text(std::string_view option) const;
  [[nodiscard]] std::string text_or(std::string_view option, std::string_view otherwise) const;
  [[nodiscard]] bool flag(std::string_view option) const;
  [[nodiscard]] bool flag_or(std::string_view option, bool otherwise) const;
  /// A number with a unit of time.
  [[nodiscard]] Duration duration(std::string_view option) const;
  [[nodiscard]] Duration duration_or(std::string_view option, Duration otherwise) const;

  /// Names of options that the driver has not asked for: "pni", "speed".
  [[nodiscard]] std::vector<std::string> unknown_options() const;

 private:
  [[nodiscard]] const DriverOption* find(std::string_view name) const;
  [[nodiscard]] const DriverOption& get(std::string_view name) const;

  std::string path_, agent_, subsystem_, buffer_;
  std::optional<std::uint32_t> index_;
  std::vector<DriverOption> options_;
  std::shared_ptr<WorldState> world_;
  mutable std::vector<std::string> asked_;
};

/// Throws DriverError if options were given that the driver's constructor did not ask for. takes_setup:
/// whether the constructor takes a setup, so that it could ask.
void refuse_unknown_options(const DriverSetup& setup, bool takes_setup);

}  // namespace tessera
