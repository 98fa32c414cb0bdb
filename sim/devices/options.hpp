#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/devices/device_error.hpp"
#include "tessera/device.hpp"

namespace tessera::sim {

/// Reads the options of a request. The accessors throw DeviceError for a value of another form. At the end,
/// `refuse_others` refuses the options that no accessor has read.
class Options {
 public:
  explicit Options(const DriverRequest& request) : request_(request) {}

  /// unit: "m", "rad", "s"; a number without a unit counts as one. Empty: any unit.
  [[nodiscard]] std::optional<double> number(const std::string& name, std::string_view unit = {});
  [[nodiscard]] double number_from_zero(const std::string& name, double otherwise,
                                        std::string_view unit = {});
  /// nullopt: the option is not given.
  [[nodiscard]] std::optional<int> whole_number(const std::string& name, int least, int most);
  /// One of `words`.
  [[nodiscard]] std::optional<std::string> word(const std::string& name,
                                                const std::vector<std::string>& words);
  /// A name, or a list of names.
  [[nodiscard]] std::vector<std::string> names(const std::string& name);
  /// Whole numbers from 0 to `last`, alone or as a list; nullopt: the option is not given.
  [[nodiscard]] std::optional<std::vector<int>> indices(const std::string& name, int last);

  void refuse_others() const;

 private:
  [[nodiscard]] const WorldOption* find(const std::string& name);

  const DriverRequest& request_;
  std::vector<std::string> asked_;
};

}  // namespace tessera::sim
