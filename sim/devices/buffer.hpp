#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/devices/device_error.hpp"
#include "tessera/device.hpp"
#include "tessera/value_encoding.hpp"

namespace tessera::sim {

/// A real buffer as a device sees it: a row of scalars, whatever structures and arrays hold them. Values are
/// converted one by one, also between units; no scalar is left out.
class Buffer {
 public:
  /// Throws DeviceError if the type has no description.
  explicit Buffer(const DriverRequest& request);

  [[nodiscard]] const std::string& type() const { return type_; }
  [[nodiscard]] std::size_t size() const { return kinds_.size(); }
  [[nodiscard]] const std::vector<std::string>& fields() const { return fields_; }  ///< "pose.x", "[3]"
  /// Whether it is one bool.
  [[nodiscard]] bool is_flag() const { return size() == 1 && kinds_[0] == Kind::flag; }
  /// Whether all scalars are float32 or float64.
  [[nodiscard]] bool is_real() const;

  /// Throws DeviceError unless it has so many numbers, all of them float32 or float64. what: "sensor 'gyro'
  /// gives".
  void require_reals(std::size_t count, const std::string& what) const;
  /// From now on, `put` and `take` convert the numbers from and to the units of the world. given: of each scalar,
  /// in the order of the type; empty: the world does not know it, so the number is not converted. what: as for
  /// require_reals, without the verb. Throws DeviceError if a scalar is declared in a unit of another quantity.
  void convert_from(std::span<const std::string> given, const std::string& what);
  /// The same if all scalars have one unit.
  void convert_from(const std::string& given, const std::string& what) {
    convert_from(std::vector(size(), given), what);
  }
  /// For a world that gives SI units, but does not tell which. Throws DeviceError if a scalar is declared in a known
  /// unit that is none of SI: mm, deg/s.
  void require_si(const std::string& what) const;
  /// Throws DeviceError unless it is one bool.
  void require_flag(const std::string& what) const;

  /// Stores the numbers, one for each scalar, in an object of the buffer's type. A flag is 0 or 1.
  void put(std::span<const double> numbers, std::span<std::byte> value);
  /// The scalars of an object of the buffer's type.
  [[nodiscard]] std::span<const double> take(std::span<const std::byte> value);

 private:
  enum class Kind : std::uint8_t { single, real, flag, other };
  const ValueEncoding& encoding() const;

  std::string type_;
  std::vector<Kind> kinds_;
  std::vector<std::string> fields_, units_;
  std::vector<double> factors_;  // to the unit of the buffer, of each scalar; empty: all are 1
  const ValueEncoding* encoding_;
  std::vector<std::byte> bytes_;
  std::vector<double> numbers_;
  std::unique_ptr<ValueSink> sink_;
};

}  // namespace tessera::sim
