#include "sim/devices/buffer.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "tessera/units.hpp"
#include "tessera/value_text.hpp"

namespace tessera::sim {

Buffer::Buffer(const DriverRequest& request)
    : type_(request.type), units_(request.units), encoding_(request.encoding) {
  const std::optional<ValueLayout> layout = ValueLayout::parse(type_);
  if (!layout)
    throw DeviceError("a device of the world cannot serve a buffer of this type",
                      "its size is not fixed, or its fields are unknown");
  if (layout->has_sequences())
    throw DeviceError("a device of the world cannot serve a buffer with sequences: " + type_,
                      "give them a fixed length, such as float64[4]");
  fields_ = layout->paths();
  for (const std::string& type : layout->types())
    kinds_.push_back(type == "float64"   ? Kind::real
                     : type == "float32" ? Kind::single
                     : type == "bool"    ? Kind::flag
                                         : Kind::other);
  numbers_.resize(kinds_.size());
  if (encoding_ == nullptr) return;
  bytes_.resize(encoding_->most);
  sink_ = std::make_unique<ValueSink>(encoding_->most);
}

bool Buffer::is_real() const {
  return std::ranges::all_of(kinds_, [](Kind kind) { return kind == Kind::real || kind == Kind::single; });
}

void Buffer::require_reals(std::size_t count, const std::string& what) const {
  if (is_real() && size() == count) return;
  const std::string number = std::to_string(count);
  throw DeviceError(
      what + (count == 1 ? " 1 number" : " " + number + " numbers") + ", and the buffer is " + type_,
      count == 1 ? "make the buffer float64 or float32"
                 : "make the buffer float64[" + number + "] or float32[" + number + "], or a structure of " +
                       number + " such numbers");
}

void Buffer::convert_from(std::span<const std::string> given, const std::string& what) {
  if (units_.size() != size() || given.size() != size()) return;
  std::vector<double> factors(size(), 1);
  for (std::size_t index = 0; index < size(); ++index) {
    const std::string &from = given[index], &to = units_[index];
    if (from.empty() || to.empty() || from == to) continue;
    if (const std::optional<double> factor = converted(1, from, to)) {
      factors[index] = *factor;
      continue;
    }
    if (!read_unit(from) && !read_unit(to)) continue;  // N m, Nm: two names of one unit, perhaps
    const std::string field =
        fields_[index].empty() ? "the buffer" : "'" + fields_[index] + "' of the buffer";
    throw DeviceError(what + " is in " + from + ", and " + field + " in " + to,
                      "declare it in " + from + ", or in another unit of that quantity");
  }
  factors_ = std::move(factors);
}

void Buffer::require_si(const std::string& what) const {
  for (const std::string& unit : units_)
    if (const std::optional<Unit> known = read_unit(unit); known && known->factor() != 1)
      throw DeviceError(what + " is in SI units, and the buffer in " + unit,
                        "declare it in " + si_name(*known));
}

void Buffer::require_flag(const std::string& what) const {
  if (!is_flag())
    throw DeviceError(what + " true or false, and the buffer is " + type_, "make the buffer bool");
}

const ValueEncoding& Buffer::encoding() const {
  if (encoding_ == nullptr) throw std::logic_error("a device that was only judged is used");
  return *encoding_;
}

void Buffer::put(std::span<const double> numbers, std::span<std::byte> value) {
  const ValueEncoding& how = encoding();
  std::byte* to = bytes_.data();
  const auto append = [&to](auto scalar) {
    std::memcpy(to, &scalar, sizeof scalar);
    to += sizeof scalar;
  };
  for (std::size_t index = 0; index < kinds_.size(); ++index) {
    const double number = factors_.empty() ? numbers[index] : numbers[index] * factors_[index];
    if (kinds_[index] == Kind::real)
      append(number);
    else if (kinds_[index] == Kind::single)
      append(static_cast<float>(number));
    else
      append(number != 0);
  }
  if (!how.take(value.data(), bytes_)) throw std::logic_error("the buffer is not of its type " + type_);
}

std::span<const double> Buffer::take(std::span<const std::byte> value) {
  sink_->clear();
  encoding().put(value.data(), *sink_);
  const std::byte* from = sink_->bytes().data();
  const auto next = [&from](auto scalar) {
    std::memcpy(&scalar, from, sizeof scalar);
    from += sizeof scalar;
    return static_cast<double>(scalar);
  };
  for (std::size_t index = 0; index < kinds_.size(); ++index)
    numbers_[index] = kinds_[index] == Kind::real     ? next(0.0)
                      : kinds_[index] == Kind::single ? next(0.0F)
                                                      : next(false);
  for (std::size_t index = 0; index < factors_.size(); ++index) numbers_[index] /= factors_[index];
  return numbers_;
}

}  // namespace tessera::sim
