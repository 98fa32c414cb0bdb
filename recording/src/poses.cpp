#include "tessera/poses.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pose_model.hpp"

namespace tessera {
namespace {

constexpr std::uint8_t differences = 0, whole_frame = 1, packed_frame = 2;  // packed: added to the others
constexpr std::size_t head_bytes = 3, components = 7, first_of_rotation = 3;
constexpr std::int64_t farthest = farthest_pose_step;
constexpr auto largest_rotation = static_cast<std::int64_t>(pose_steps_per_unit);

void put_varint(std::string& bytes, std::uint64_t number) {
  for (; number >= 0x80; number >>= 7U) bytes += static_cast<char>((number & 0x7fU) | 0x80U);
  bytes += static_cast<char>(number);
}

/// nullopt: the bytes end within it, or it is too long.
[[nodiscard]] std::optional<std::uint64_t> take_varint(std::string_view& bytes) {
  std::uint64_t number = 0;
  for (unsigned shift = 0; shift < 63 && !bytes.empty(); shift += 7) {
    const auto byte = static_cast<std::uint8_t>(bytes.front());
    bytes.remove_prefix(1);
    number |= static_cast<std::uint64_t>(byte & 0x7fU) << shift;
    if ((byte & 0x80U) == 0) return number;
  }
  return std::nullopt;
}

/// Maps numbers near zero, of either sign, to small numbers.
[[nodiscard]] std::uint64_t zigzag(std::int64_t number) {
  return static_cast<std::uint64_t>(number) << 1U ^ static_cast<std::uint64_t>(number >> 63);
}
[[nodiscard]] std::int64_t unzigzag(std::uint64_t number) {
  return static_cast<std::int64_t>(number >> 1U ^ (~(number & 1U) + 1));
}

/// A quaternion and its negative are the same rotation: the one nearer to `before` has the smaller
/// differences.
void turn_towards(RoundedPose& pose, const RoundedPose& before) {
  std::int64_t product = 0;
  for (std::size_t at = first_of_rotation; at < components; ++at)
    product += pose.steps[at] * before.steps[at];
  if (product >= 0) return;
  for (std::size_t at = first_of_rotation; at < components; ++at) pose.steps[at] = -pose.steps[at];
}

void put_body(std::string& bytes, std::uint64_t left_out, const RoundedPose& pose, const RoundedPose& base) {
  put_varint(bytes, left_out);
  const std::size_t mask_at = bytes.size();
  bytes += '\0';
  std::uint8_t mask = 0;
  for (std::size_t at = 0; at < components; ++at) {
    const std::int64_t difference = pose.steps[at] - base.steps[at];
    if (difference == 0) continue;
    mask = static_cast<std::uint8_t>(mask | 1U << at);
    put_varint(bytes, zigzag(difference));
  }
  bytes[mask_at] = static_cast<char>(mask);
}

/// false: the bytes are damaged.
[[nodiscard]] bool take_body(std::string_view& bytes, RoundedPose& pose) {
  if (bytes.empty()) return false;
  const auto mask = static_cast<std::uint8_t>(bytes.front());
  bytes.remove_prefix(1);
  if (mask >= 1U << components) return false;
  for (std::size_t at = 0; at < components; ++at) {
    if ((mask & 1U << at) == 0) continue;
    const std::optional<std::uint64_t> number = take_varint(bytes);
    // The largest difference is far from the limits of the type, so that sums stay within it.
    if (!number || *number > zigzag(2 * farthest)) return false;
    pose.steps[at] += unzigzag(*number);
    const std::int64_t limit = at < first_of_rotation ? farthest : largest_rotation;
    if (pose.steps[at] < -limit || pose.steps[at] > limit) return false;
  }
  return true;
}

constexpr RoundedPose nothing{.steps = {}};

}  // namespace

std::optional<RoundedPose> rounded(const BodyPose& pose) {
  RoundedPose result;
  double length = 0;
  for (const double part : pose.rotation) length += part * part;
  length = std::sqrt(length);
  if (!std::isfinite(length) || length <= 0) return std::nullopt;
  for (std::size_t at = 0; at < components; ++at) {
    const bool is_position = at < first_of_rotation;
    const double steps = is_position ? pose.position_m[at] * pose_steps_per_metre
                                     : pose.rotation[at - first_of_rotation] / length * pose_steps_per_unit;
    if (!std::isfinite(steps)) return std::nullopt;
    const auto limit = static_cast<double>(is_position ? farthest : largest_rotation);
    result.steps[at] = std::llround(std::clamp(steps, -limit, limit));
  }
  return result;
}

BodyPose pose_of(const RoundedPose& rounded) {
  BodyPose pose;
  double length = 0;
  for (std::size_t at = 0; at < components; ++at) {
    const auto steps = static_cast<double>(rounded.steps[at]);
    if (at < first_of_rotation) {
      pose.position_m[at] = steps / pose_steps_per_metre;
    } else {
      pose.rotation[at - first_of_rotation] = steps;
      length += steps * steps;
    }
  }
  if (length <= 0) return {.position_m = pose.position_m};
  for (double& part : pose.rotation) part /= std::sqrt(length);
  return pose;
}

// ------------------------------------------------------------------------------------------------ encoder

PoseEncoder::PoseEncoder(std::size_t bodies, Form form, const PoseParents& parents)
    : last_(bodies), model_(form == Form::packed ? std::make_unique<PoseModel>(bodies, parents) : nullptr) {}
PoseEncoder::~PoseEncoder() = default;
PoseEncoder::PoseEncoder(PoseEncoder&&) noexcept = default;
PoseEncoder& PoseEncoder::operator=(PoseEncoder&&) noexcept = default;

std::string_view PoseEncoder::encode(std::int64_t time_ns, std::span<const BodyPose> poses) {
  rounded_ = last_;
  for (std::size_t body = 0; body < std::min(poses.size(), rounded_.size()); ++body)
    if (const std::optional<RoundedPose> now = rounded(poses[body])) rounded_[body] = *now;
  return encode(time_ns, rounded_);
}

std::string_view PoseEncoder::encode(std::int64_t time_ns, std::span<const RoundedPose> poses) {
  bool whole = !whole_ns_ || time_ns - *whole_ns_ >= whole_pose_period.count();
  bytes_.clear();
  std::vector<RoundedPose> now(
      poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(std::min(poses.size(), last_.size())));
  now.insert(now.end(), last_.begin() + static_cast<std::ptrdiff_t>(now.size()), last_.end());
  for (std::size_t body = 0; body < now.size(); ++body) turn_towards(now[body], last_[body]);
  if (!whole && now == last_) return {};
  if (model_) {
    last_ = std::move(now);
    put_packed(whole);
  } else {
    put_plain(whole, now);
    last_ = std::move(now);
  }
  if (whole) whole_ns_ = time_ns;
  ++number_;
  return bytes_;
}

void PoseEncoder::put_head(std::uint8_t form, std::uint16_t number) {
  bytes_ = {static_cast<char>(form), static_cast<char>(number & 0xffU), static_cast<char>(number >> 8U)};
}

void PoseEncoder::put_plain(bool whole, std::span<const RoundedPose> poses) {
  put_head(whole ? whole_frame : differences, number_);
  std::uint64_t left_out = 0;
  for (std::size_t body = 0; body < last_.size(); ++body) {
    if (!whole && poses[body] == last_[body])
      ++left_out;
    else
      put_body(bytes_, std::exchange(left_out, 0), poses[body], whole ? nothing : last_[body]);
  }
}

void PoseEncoder::put_packed(bool& whole) {
  put_head(static_cast<std::uint8_t>(packed_frame + (whole ? whole_frame : differences)), number_);
  model_->pack(whole, last_, bytes_);
  if (bytes_.size() <= longest_frame(last_.size())) return;
  whole = true;
  put_plain(whole, last_);
  model_->restart(last_);
}

std::string PoseEncoder::last_whole() const {
  if (!whole_ns_) return {};
  const auto number = static_cast<std::uint16_t>(number_ - 1);
  std::string bytes{static_cast<char>(whole_frame), static_cast<char>(number & 0xffU),
                    static_cast<char>(number >> 8U)};
  for (const RoundedPose& pose : last_) put_body(bytes, 0, pose, nothing);
  return bytes;
}

std::size_t PoseEncoder::longest_frame(std::size_t bodies) {
  constexpr std::size_t varint_of_index = 5, mask = 1, varint_of_position = 6, varint_of_rotation = 3;
  return head_bytes + bodies * (varint_of_index + mask + 3 * varint_of_position + 4 * varint_of_rotation);
}

// ------------------------------------------------------------------------------------------------ decoder

PoseDecoder::PoseDecoder(std::size_t bodies, PoseParents parents)
    : poses_(bodies), parents_(std::move(parents)) {}
PoseDecoder::~PoseDecoder() = default;
PoseDecoder::PoseDecoder(PoseDecoder&&) noexcept = default;
PoseDecoder& PoseDecoder::operator=(PoseDecoder&&) noexcept = default;

bool PoseDecoder::take(std::string_view frame) {
  const bool has_head =
      frame.size() >= head_bytes && static_cast<std::uint8_t>(frame[0]) <= packed_frame + whole_frame;
  if (!has_head) return known_ = false;
  const bool packed = static_cast<std::uint8_t>(frame[0]) >= packed_frame;
  const bool whole = static_cast<std::uint8_t>(frame[0]) % packed_frame == whole_frame;
  const auto number = static_cast<std::uint16_t>(static_cast<std::uint8_t>(frame[1]) |
                                                 static_cast<std::uint8_t>(frame[2]) << 8U);
  const bool follows = number_ && number == static_cast<std::uint16_t>(*number_ + 1);
  number_ = number;
  known_ = whole || (known_ && follows);
  if (!known_) return true;
  if (packed && !model_) {
    model_ = std::make_unique<PoseModel>(poses_.size(), parents_);
    model_->restart(poses_);
  }
  const std::string_view bytes = frame.substr(head_bytes);
  known_ = packed ? model_->unpack(whole, bytes, poses_) : apply(bytes, whole);
  if (known_ && !packed && model_) model_->restart(poses_);
  return known_;
}

bool PoseDecoder::apply(std::string_view bytes, bool whole) {
  std::size_t body = 0, listed = 0;
  for (; !bytes.empty(); ++body, ++listed) {
    const std::optional<std::uint64_t> left_out = take_varint(bytes);
    if (!left_out || *left_out >= poses_.size() || *left_out + body >= poses_.size()) return false;
    body += *left_out;
    if (whole) poses_[body] = nothing;
    if (!take_body(bytes, poses_[body])) return false;
  }
  return !whole || listed == poses_.size();
}

}  // namespace tessera
