#include "pose_model.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace tessera {
namespace {

constexpr std::size_t rotation_begins = 3;
constexpr std::int64_t unit = 8191;

/// Predicts the next pose of a body that moves and turns steadily. A point that turns steadily about a fixed
/// axis has next = 2 cos(angle) * last - before, in each of its coordinates; the same holds for quaternions.
[[nodiscard]] RoundedPose going_on(const RoundedPose& last, const RoundedPose& before) {
  RoundedPose next;
  std::int64_t cosine = 0;
  for (std::size_t at = rotation_begins; at < next.steps.size(); ++at)
    cosine += last.steps[at] * before.steps[at];
  for (std::size_t at = 0; at < next.steps.size(); ++at) {
    const bool is_position = at < rotation_begins;
    next.steps[at] =
        (is_position ? 2 * last.steps[at]
                     : (4 * cosine * last.steps[at] / (unit * unit) + (last.steps[at] < 0 ? -1 : 1)) / 2) -
        before.steps[at];
    if (!is_position) next.steps[at] = std::clamp(next.steps[at], -unit, unit);
  }
  return next;
}

using Quaternion = std::array<std::int64_t, 4>;

[[nodiscard]] Quaternion rotation_of(const RoundedPose& pose) {
  return {pose.steps[3], pose.steps[4], pose.steps[5], pose.steps[6]};
}
[[nodiscard]] Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}
[[nodiscard]] Quaternion conjugate(const Quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }
[[nodiscard]] std::int64_t divided(std::int64_t number, std::int64_t by) {
  return (number >= 0 ? number + by / 2 : number - by / 2) / by;
}

/// Finer than the steps of a pose, so that rounding does not add up.
constexpr std::int64_t finer = 64, fine_unit = unit * unit / 1024;

/// The rotation of a body in the frame of its parent, in parts of fine_unit.
[[nodiscard]] Quaternion relative(const RoundedPose& parent, const RoundedPose& child) {
  Quaternion q = product(conjugate(rotation_of(parent)), rotation_of(child));
  for (std::int64_t& part : q) part = divided(part, 1024);
  return q;
}

/// `way` turned by the quaternion, or back; times `by`. The quaternion need not be of length 1.
[[nodiscard]] std::array<std::int64_t, 3> turned(const Quaternion& q, const std::array<std::int64_t, 3>& way,
                                                 std::int64_t by, std::int64_t through) {
  const auto [w, x, y, z] = q;
  const std::int64_t size = std::max<std::int64_t>(1, w * w + x * x + y * y + z * z);
  const std::array<std::array<std::int64_t, 3>, 3> rows{
      {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
       {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
       {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}}};
  std::array<std::int64_t, 3> result{};
  for (std::size_t row = 0; row < 3; ++row)
    result[row] =
        divided((rows[row][0] * way[0] + rows[row][1] * way[1] + rows[row][2] * way[2]) * by, size * through);
  return result;
}

/// Predicts the pose of a body that keeps its place in the frame of its parent, and turns steadily in it.
/// `then` and `now` are the last pose of the parent and its pose in this frame.
[[nodiscard]] RoundedPose going_along(const RoundedPose& last, const RoundedPose& before,
                                      const RoundedPose& parent_before, const RoundedPose& parent_then,
                                      const RoundedPose& parent_now) {
  constexpr std::int64_t farthest_from_parent = 1'000'000;  // 100 m
  RoundedPose next = last;
  std::array<std::int64_t, 3> way{};
  for (std::size_t at = 0; at < 3; ++at) {
    way[at] = last.steps[at] - parent_then.steps[at];
    if (std::abs(way[at]) > farthest_from_parent) return next;
  }
  way = turned(conjugate(rotation_of(parent_then)), way, finer, 1);
  way = turned(rotation_of(parent_now), way, 1, finer);
  for (std::size_t at = 0; at < 3; ++at) next.steps[at] = parent_now.steps[at] + way[at];
  const Quaternion one = relative(parent_before, before), other = relative(parent_then, last);
  std::int64_t cosine = 0;
  for (std::size_t at = 0; at < 4; ++at) cosine += one[at] * other[at];
  Quaternion on{};
  for (std::size_t at = 0; at < 4; ++at)
    on[at] = divided(2 * cosine / fine_unit * other[at], fine_unit) - one[at];
  on = product(rotation_of(parent_now), on);
  for (std::size_t at = 0; at < 4; ++at)
    next.steps[rotation_begins + at] = std::clamp(divided(on[at], fine_unit), -unit, unit);
  return next;
}

[[nodiscard]] std::size_t largest_of_rotation(const RoundedPose& pose) {
  std::size_t largest = rotation_begins;
  for (std::size_t at = rotation_begins; at < pose.steps.size(); ++at)
    if (std::abs(pose.steps[at]) > std::abs(pose.steps[largest])) largest = at;
  return largest;
}

/// The value of the part that makes the length of the quaternion 1, with the sign that was predicted.
[[nodiscard]] std::int64_t rest_of_rotation(const RoundedPose& pose, std::size_t part,
                                            const RoundedPose& expected) {
  std::int64_t rest = unit * unit, root = 0;
  for (std::size_t at = rotation_begins; at < pose.steps.size(); ++at)
    if (at != part) rest -= pose.steps[at] * pose.steps[at];
  for (std::int64_t bit = 1 << 13; bit > 0; bit /= 2)
    if ((root + bit) * (root + bit) <= rest) root += bit;
  if (rest - root * root > root) ++root;  // to the nearest
  return expected.steps[part] < 0 ? -root : root;
}

[[nodiscard]] bool within_limits(const RoundedPose& pose) {
  for (std::size_t at = 0; at < pose.steps.size(); ++at) {
    const std::int64_t limit = at < rotation_begins ? farthest_pose_step : unit;
    if (pose.steps[at] < -limit || pose.steps[at] > limit) return false;
  }
  return true;
}

}  // namespace

PoseModel::PoseModel(std::size_t bodies, const PoseParents& parents) : bodies_(bodies) {
  for (std::size_t index = 0; index < std::min(bodies, parents.size()); ++index)
    if (parents[index] && *parents[index] < index) bodies_[index].parent = parents[index];
}

void PoseModel::forget() {
  rests_ = {};
  moved_ = {};
  whole_ = {};
  for (Body& body : bodies_) body.sizes = {}, body.misses = {}, body.rested = false;
}

void PoseModel::restart(const std::vector<RoundedPose>& poses) {
  forget();
  for (std::size_t index = 0; index < bodies_.size(); ++index)
    bodies_[index].last = bodies_[index].before = bodies_[index].older = poses[index];
}

/// The coder of the encoder writes the number; that of the decoder sets it.
template <class Coder>
bool PoseModel::code_number(Coder& coder, NumberModel& model, std::int64_t& number) {
  bool zero = number == 0, negative = number < 0;
  coder.bit(model.zero, zero);
  if (zero) return number = 0, true;
  coder.bit(model.sign, negative);
  // Elias' gamma code: the length of the number, then its bits after the first.
  std::uint64_t size = static_cast<std::uint64_t>(std::abs(number));
  std::size_t length = 0;
  const std::size_t its_length = static_cast<std::size_t>(std::bit_width(size));
  for (bool longer = true; length < longest_number; ++length) {
    longer = its_length > length + 1;
    coder.bit(model.length[length], longer);
    if (!longer) break;
  }
  if (length >= longest_number) return false;
  std::uint64_t coded = 1;
  for (std::size_t left = length; left-- > 0;) {
    bool one = (size >> left & 1U) != 0;
    if (left + 1 == length)
      coder.bit(model.next[length], one);
    else
      coder.even_bit(one);
    coded = coded << 1U | static_cast<std::uint64_t>(one);
  }
  number = negative ? -static_cast<std::int64_t>(coded) : static_cast<std::int64_t>(coded);
  return true;
}

template <class Coder>
bool PoseModel::code_moved(Coder& coder, Body& body, RoundedPose& pose) {
  const RoundedPose on = going_on(body.last, body.before);
  RoundedPose along = on;
  if (body.parent) {
    const Body& parent = bodies_[*body.parent];  // the frame of the parent has been coded
    along = going_along(body.last, body.before, parent.older, parent.before, parent.last);
  }
  const std::size_t largest = largest_of_rotation(along);
  for (std::size_t turn = 0; turn < components; ++turn) {
    // The largest part of the rotation comes last, since it follows from the others.
    const std::size_t at = turn + 1 == components ? largest : turn + (turn >= largest ? 1 : 0);
    std::array<std::uint32_t, ways>& misses = body.misses[at];
    const std::array<std::int64_t, ways> guesses{body.last.steps[at], on.steps[at], along.steps[at]};
    std::size_t best = body.parent ? 2 : 1;
    for (std::size_t way = best; way-- > 0;)
      if (misses[way] < misses[best]) best = way;
    const std::int64_t guess = at == largest ? rest_of_rotation(pose, largest, along) : guesses[best];
    std::int64_t surprise = pose.steps[at] - guess;
    std::array<NumberModel, classes>& models = moved_[at < rotation_begins ? 0 : at == largest ? 2 : 1];
    if (!code_number(coder, models[body.sizes[at]], surprise)) return false;
    pose.steps[at] = guess + surprise;
    const auto width =
        static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(std::abs(surprise))));
    body.sizes[at] = static_cast<std::uint8_t>(std::min(width, classes - 1));
    for (std::size_t way = 0; way < guesses.size(); ++way) {
      constexpr std::int64_t most = 1000;
      const std::int64_t miss = std::min(most, std::abs(pose.steps[at] - guesses[way]));
      misses[way] = misses[way] - misses[way] / 4 + static_cast<std::uint32_t>(4 * miss);
    }
  }
  return true;
}

template <class Coder>
bool PoseModel::code_frame(Coder& coder, bool whole, std::vector<RoundedPose>& poses) {
  if (whole) forget();
  RoundedPose neighbour{.steps = {}};
  for (std::size_t index = 0; index < bodies_.size(); ++index) {
    Body& body = bodies_[index];
    RoundedPose& pose = poses[index];
    if (whole) {
      // Bodies of one robot are near each other.
      for (std::size_t at = 0; at < components; ++at) {
        const std::int64_t base = at < rotation_begins ? neighbour.steps[at] : 0;
        std::int64_t number = pose.steps[at] - base;
        if (!code_number(coder, whole_[at], number)) return false;
        pose.steps[at] = base + number;
      }
      body.older = body.before = neighbour = pose;
    } else {
      bool rests = pose == body.last;
      coder.bit(rests_[body.rested ? 1 : 0], rests);
      body.rested = rests;
      if (rests)
        pose = body.last;
      else if (!code_moved(coder, body, pose))
        return false;
      body.older = body.before;
      body.before = body.last;
    }
    if (!within_limits(pose)) return false;
    body.last = pose;
  }
  return true;
}

void PoseModel::pack(bool whole, const std::vector<RoundedPose>& poses, std::string& bytes) {
  const std::size_t begin = bytes.size();
  RangeEncoder coder(bytes);
  std::vector<RoundedPose> coded = poses;
  static_cast<void>(code_frame(coder, whole, coded));
  coder.finish(begin);
}

bool PoseModel::unpack(bool whole, std::string_view bytes, std::vector<RoundedPose>& poses) {
  RangeDecoder coder(bytes);
  return code_frame(coder, whole, poses) && coder.has_read_all();
}

}  // namespace tessera
