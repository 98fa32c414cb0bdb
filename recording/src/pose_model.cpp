#include "pose_model.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace tessera {
namespace {

constexpr std::size_t rotation_begins = 3;
constexpr std::int64_t unit = 8191;

/// How the body goes on if it moves and turns steadily. A point that turns steadily about a fixed axis has
/// next = 2 cos(angle) * last - before, in each of its coordinates; the same holds for quaternions.
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

[[nodiscard]] bool within_limits(const RoundedPose& pose) {
  for (std::size_t at = 0; at < pose.steps.size(); ++at) {
    const std::int64_t limit = at < rotation_begins ? farthest_pose_step : unit;
    if (pose.steps[at] < -limit || pose.steps[at] > limit) return false;
  }
  return true;
}

}  // namespace

void PoseModel::forget() {
  rests_ = {};
  moved_ = {};
  whole_ = {};
  for (Body& body : bodies_) body.sizes = {}, body.misses = {}, body.rested = false;
}

void PoseModel::restart(const std::vector<RoundedPose>& poses) {
  forget();
  for (std::size_t index = 0; index < bodies_.size(); ++index)
    bodies_[index].last = bodies_[index].before = poses[index];
}

/// The coder of the encoder writes the number; that of the decoder sets it.
template <class Coder>
bool PoseModel::code_number(Coder& coder, NumberModel& model, std::int64_t& number) {
  bool zero = number == 0, negative = number < 0;
  coder.bit(model.zero, zero);
  if (zero) return number = 0, true;
  coder.bit(model.sign, negative);
  // As in Elias' gamma code: the length of the number, then its bits after the first.
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
  for (std::size_t at = 0; at < components; ++at) {
    std::array<std::uint32_t, 2>& misses = body.misses[at];
    const std::array<std::int64_t, 2> guesses{body.last.steps[at], on.steps[at]};
    const std::int64_t guess = guesses[misses[1] <= misses[0] ? 1 : 0];
    std::int64_t surprise = pose.steps[at] - guess;
    NumberModel& model = moved_[at < rotation_begins ? 0 : 1][body.sizes[at]];
    if (!code_number(coder, model, surprise)) return false;
    pose.steps[at] = guess + surprise;
    const auto width = std::bit_width(static_cast<std::uint64_t>(std::abs(surprise)));
    body.sizes[at] =
        static_cast<std::uint8_t>(std::min<std::size_t>(static_cast<std::size_t>(width), classes - 1));
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
      body.before = neighbour = pose;
    } else {
      bool rests = pose == body.last;
      coder.bit(rests_[body.rested ? 1 : 0], rests);
      body.rested = rests;
      if (rests)
        pose = body.last;
      else if (!code_moved(coder, body, pose))
        return false;
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
