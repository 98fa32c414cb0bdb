#include "tessera/poses.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera {
namespace {

constexpr std::uint8_t whole_frame = 1;  // 0: differences
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

/// before: the frame before; nullptr: the frame is whole.
[[nodiscard]] std::string frame_of(std::uint16_t number, const std::vector<RoundedPose>& poses,
                                   const std::vector<RoundedPose>* before) {
  std::string bytes{static_cast<char>(before == nullptr ? whole_frame : 0), static_cast<char>(number & 0xffU),
                    static_cast<char>(number >> 8U)};
  std::uint64_t left_out = 0;
  for (std::size_t body = 0; body < poses.size(); ++body) {
    if (before != nullptr && poses[body] == (*before)[body])
      ++left_out;
    else
      put_body(bytes, std::exchange(left_out, 0), poses[body], before == nullptr ? nothing : (*before)[body]);
  }
  return bytes;
}

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

std::string_view PoseEncoder::encode(std::int64_t time_ns, std::span<const BodyPose> poses) {
  rounded_ = last_;
  for (std::size_t body = 0; body < std::min(poses.size(), rounded_.size()); ++body)
    if (const std::optional<RoundedPose> now = rounded(poses[body])) rounded_[body] = *now;
  return encode(time_ns, rounded_);
}

std::string_view PoseEncoder::encode(std::int64_t time_ns, std::span<const RoundedPose> poses) {
  std::vector<RoundedPose> now(last_);
  std::copy_n(poses.begin(), std::min(poses.size(), now.size()), now.begin());
  for (std::size_t body = 0; body < now.size(); ++body) turn_towards(now[body], last_[body]);
  const bool whole = !whole_ns_ || time_ns - *whole_ns_ >= whole_pose_period.count();
  if (!whole && now == last_) return {};
  bytes_ = frame_of(number_++, now, whole ? nullptr : &last_);
  last_ = std::move(now);
  if (whole) whole_ns_ = time_ns;
  return bytes_;
}

std::string PoseEncoder::last_whole() const {
  if (!whole_ns_) return {};
  return frame_of(static_cast<std::uint16_t>(number_ - 1), last_, nullptr);
}

std::size_t PoseEncoder::longest_frame(std::size_t bodies) {
  constexpr std::size_t varint_of_index = 5, mask = 1, varint_of_position = 6, varint_of_rotation = 3;
  return head_bytes + bodies * (varint_of_index + mask + 3 * varint_of_position + 4 * varint_of_rotation);
}

// ------------------------------------------------------------------------------------------------ decoder

bool PoseDecoder::take(std::string_view frame) {
  if (frame.size() < head_bytes || static_cast<std::uint8_t>(frame[0]) > whole_frame) return known_ = false;
  const bool whole = static_cast<std::uint8_t>(frame[0]) == whole_frame;
  const auto number = static_cast<std::uint16_t>(static_cast<std::uint8_t>(frame[1]) |
                                                 static_cast<std::uint8_t>(frame[2]) << 8U);
  const bool follows = number_ && number == static_cast<std::uint16_t>(*number_ + 1);
  number_ = number;
  known_ = whole || (known_ && follows);
  if (!known_) return true;
  return known_ = apply(frame.substr(head_bytes), whole);
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
