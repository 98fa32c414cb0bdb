#include "ros2/tf/transform_buffer.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace tessera::ros2 {
namespace {

using Outcome = TransformBuffer::Answer::Outcome;

constexpr std::int64_t second_of_tf_ns = 1'000'000'000;
constexpr std::size_t most_frames = 10'000, most_samples = 100'000;
/// Clocks of two machines may differ by less.
constexpr std::int64_t late_ns = second_of_tf_ns;
constexpr std::size_t late_in_a_row = 3;
/// An arm may put something down and take it up again.
constexpr std::size_t turns_of_a_quarrel = 4;

std::string_view without_slash(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return name;
}

std::optional<std::int64_t> time_of(const Stamp& stamp) {
  if (stamp.sec < 0 || stamp.nanosec >= second_of_tf_ns) return std::nullopt;
  return stamp.sec * second_of_tf_ns + stamp.nanosec;
}

TransformBuffer::Refusal refusal_of(const StampedTransform& one) {
  using enum TransformBuffer::Refusal;
  const std::string_view parent = without_slash(one.parent), child = without_slash(one.child);
  if (parent.empty() || child.empty()) return no_name;
  if (parent == child) return own_parent;
  if (!is_finite(one.transform)) return not_finite;
  if (!is_unit(one.transform.rotation)) return not_unit;
  if (!time_of(one.stamp)) return bad_stamp;
  return none;
}

}  // namespace

std::optional<TransformBuffer::Id> TransformBuffer::find(std::string_view name) const {
  const auto found = ids_.find(name);
  return found == ids_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<TransformBuffer::Id> TransformBuffer::add(std::string_view name) {
  if (const auto known = find(name)) return known;
  if (all_.size() >= most_frames) return std::nullopt;
  const Id id = all_.size();
  ids_.emplace(name, id);
  all_.push_back({std::string(name)});
  return id;
}

TransformBuffer::Taken TransformBuffer::take(const StampedTransform& one, bool fixed,
                                             std::uint64_t publisher) {
  if (const Refusal refusal = refusal_of(one); refusal != Refusal::none) return {refusal};
  const auto child = add(without_slash(one.child)), parent = add(without_slash(one.parent));
  if (!child || !parent) return {Refusal::too_many};
  const Sample sample{
      *time_of(one.stamp), *parent, {one.transform.translation, normalized(one.transform.rotation)}};
  Frame& frame = all_[*child];
  const bool other_kind = !frame.samples.empty() && frame.fixed != fixed;
  if (other_kind) frame = Frame{frame.name};
  frame.fixed = fixed;
  Taken taken = fixed ? take_fixed(frame, sample) : take_moving(*child, sample, publisher);
  if (other_kind) taken.oddity = Oddity::moves_and_not;
  return taken;
}

TransformBuffer::Taken TransformBuffer::take_fixed(Frame& frame, const Sample& sample) {
  Taken taken;
  if (!frame.samples.empty()) {
    const Sample& last = frame.samples.front();
    if (last.parent == sample.parent && last.transform == sample.transform) return taken;
    if (last.parent != sample.parent) {
      taken.oddity = Oddity::two_parents;
      taken.other = all_[last.parent].name;
    }
  }
  frame.samples.assign(1, sample);
  ++fixed_changes_;
  return taken;
}

TransformBuffer::Taken TransformBuffer::take_moving(Id id, const Sample& sample, std::uint64_t publisher) {
  Taken taken;
  Frame& frame = all_[id];
  if (!frame.samples.empty()) {
    const std::int64_t back_ns = frame.samples.back().stamp_ns - sample.stamp_ns;
    frame.late = back_ns > late_ns ? frame.late + 1 : 0;
    if (back_ns > kept_ns || frame.late >= late_in_a_row) {
      forget_moving();
      ++jumps_;
      taken.oddity = Oddity::went_back;
      taken.back_ns = back_ns;
    } else {
      const std::string former = all_[frame.samples.back().parent].name;
      taken.oddity = note_turn(frame, sample, publisher);
      if (taken.oddity == Oddity::two_parents) taken.other = former;
    }
  }
  frame.publisher = publisher;
  auto& samples = frame.samples;
  const auto place = std::ranges::lower_bound(samples, sample.stamp_ns, {}, &Sample::stamp_ns);
  if (place != samples.end() && place->stamp_ns == sample.stamp_ns)
    *place = sample;
  else
    samples.insert(place, sample);
  while (samples.front().stamp_ns < samples.back().stamp_ns - kept_ns || samples.size() > most_samples)
    samples.pop_front();
  return taken;
}

/// A frame may get another parent, and a publisher may start anew. Both are mistakes if they go back and forth.
TransformBuffer::Oddity TransformBuffer::note_turn(Frame& frame, const Sample& sample,
                                                   std::uint64_t publisher) {
  const bool other_parent = frame.samples.back().parent != sample.parent;
  if (!other_parent && frame.publisher == publisher) return Oddity::none;
  if (frame.turns == 0 || std::max(sample.stamp_ns, frame.turns_began_ns) - frame.turns_began_ns > kept_ns) {
    frame.turns = 0;
    frame.turns_began_ns = sample.stamp_ns;
  }
  if (++frame.turns < turns_of_a_quarrel) return Oddity::none;
  frame.turns = 0;
  return other_parent ? Oddity::two_parents : Oddity::two_publishers;
}

void TransformBuffer::forget_moving() {
  for (Frame& frame : all_)
    if (!frame.fixed) frame = Frame{frame.name};
}

std::optional<TransformBuffer::Sample> TransformBuffer::sample_at(const Frame& frame, std::int64_t stamp_ns) {
  if (frame.samples.empty()) return std::nullopt;
  if (frame.fixed) return frame.samples.front();
  const auto next = std::ranges::lower_bound(frame.samples, stamp_ns, {}, &Sample::stamp_ns);
  if (next == frame.samples.end()) return std::nullopt;
  if (next->stamp_ns == stamp_ns) return *next;
  if (next == frame.samples.begin()) return std::nullopt;
  const Sample& last = *std::prev(next);
  if (last.parent != next->parent) return last;  // it has got another parent only then
  const double share =
      static_cast<double>(stamp_ns - last.stamp_ns) / static_cast<double>(next->stamp_ns - last.stamp_ns);
  return Sample{stamp_ns, last.parent, interpolated(last.transform, next->transform, share)};
}

TransformBuffer::Ascent TransformBuffer::ascend(Id from, const SampleOf& sample_of) const {
  Ascent ascent{{}, from};
  for (;;) {
    const Frame& frame = all_[ascent.root];
    if (frame.samples.empty()) return ascent;
    const std::optional<Sample> sample = sample_of(frame);
    if (!sample) {
      ascent.cut = ascent.root;
      return ascent;
    }
    ascent.steps.emplace_back(ascent.root, *sample);
    ascent.root = sample->parent;
    if (ascent.steps.size() > all_.size()) {
      ascent.loops = true;
      return ascent;
    }
  }
}

/// The last step is inside the loop.
std::vector<std::string> TransformBuffer::loop_in(const Ascent& ascent) const {
  std::vector<std::string> names;
  const auto& steps = ascent.steps;
  for (std::size_t index = steps.size(); index-- > 0;) {
    const std::string& name = all_[steps[index].first].name;
    if (std::ranges::find(names, name) != names.end()) break;
    names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

TransformBuffer::Way TransformBuffer::way(std::string_view frame, std::string_view in,
                                          const SampleOf& sample_of) const {
  const auto from = find(frame), to = find(in);
  if (!from || !to) return {{Outcome::unknown_frame, {}, 0, false, {std::string(from ? in : frame)}}};
  const Ascent up = ascend(*from, sample_of), down = ascend(*to, sample_of);
  for (const Ascent* const one : {&up, &down})
    if (one->loops) return {{Outcome::loop, {}, 0, false, loop_in(*one)}};
  if (up.root != down.root) {
    if (up.cut || down.cut)
      return {{Outcome::no_common_time, {}, 0, false, {all_[up.cut ? *up.cut : *down.cut].name}}};
    return {{Outcome::unconnected, {}, 0, false, {all_[up.root].name, all_[down.root].name}}};
  }
  Way way{{}, up.steps, down.steps};
  while (!way.up.empty() && !way.down.empty() && way.up.back().first == way.down.back().first) {
    way.up.pop_back();
    way.down.pop_back();
  }
  return way;
}

TransformBuffer::Answer TransformBuffer::latest(std::string_view frame, std::string_view in) const {
  const auto newest = [](const Frame& one) { return std::optional(one.samples.back()); };
  const Way found = way(frame, in, newest);
  if (found.answer.outcome != Outcome::found) return found.answer;
  std::int64_t common_ns = std::numeric_limits<std::int64_t>::max();
  bool fixed = true;
  for (const auto* const steps : {&found.up, &found.down})
    for (const auto& [id, sample] : *steps) {
      if (all_[id].fixed) continue;
      fixed = false;
      common_ns = std::min(common_ns, sample.stamp_ns);
    }
  Answer answer = at(frame, in, fixed ? 0 : common_ns);
  answer.fixed = fixed;
  return answer;
}

TransformBuffer::Answer TransformBuffer::at(std::string_view frame, std::string_view in,
                                            std::int64_t stamp_ns) const {
  const Way found = way(frame, in, [&](const Frame& one) { return sample_at(one, stamp_ns); });
  Answer answer = found.answer;
  if (answer.outcome != Outcome::found) return answer;
  answer.stamp_ns = stamp_ns;
  answer.fixed = true;
  const auto composed = [&](const std::vector<std::pair<Id, Sample>>& steps) {
    Transform all;
    for (const auto& [id, sample] : steps) {
      all = sample.transform * all;
      answer.fixed = answer.fixed && all_[id].fixed;
    }
    return all;
  };
  const Transform up = composed(found.up), down = composed(found.down);
  answer.transform = inverse(down) * up;
  answer.transform.rotation = normalized(answer.transform.rotation);
  return answer;
}

std::vector<std::string> TransformBuffer::frames() const {
  std::vector<std::string> names;
  for (const auto& [name, id] : ids_) names.push_back(name);
  return names;
}

}  // namespace tessera::ros2
