#include "replay/timeline.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "tessera/transition_role.hpp"

namespace tessera::replay {
namespace {

/// Builds the lane of one subsystem from its firings.
class LaneBuilder {
 public:
  explicit LaneBuilder(std::string path) { lane_.path = std::move(path); }

  void fire(const TransitionRole& role, double at_s) {
    switch (role.step) {
      case Step::start:
        begin(at_s);
        break;
      case Step::leave:
        running_ = behaviour(role.behaviour);
        end(at_s);
        begin(at_s);
        break;
      case Step::begin_receiving:  // it may wait before its first call
        running_ = behaviour(role.behaviour);
        if (!since_s_) since_s_ = at_s;
        break;
      case Step::begin_sending:
        running_ = behaviour(role.behaviour);
        if (!since_s_) since_s_ = at_s;
        ++lane_.iterations;
        break;
      case Step::error:
        lane_.errors_s.push_back(at_s);
        break;
      default:
        break;
    }
  }

  Lane finish(double at_s) {
    end(at_s);
    return std::move(lane_);
  }

 private:
  void begin(double at_s) {
    since_s_ = at_s;
    running_.reset();
  }
  void end(double at_s) {
    if (since_s_ && running_) lane_.stretches.push_back({*running_, *since_s_, at_s});
    since_s_.reset();
  }
  std::size_t behaviour(std::string_view name) {
    const auto found = std::ranges::find(lane_.behaviours, name);
    const auto index = static_cast<std::size_t>(found - lane_.behaviours.begin());
    if (found == lane_.behaviours.end()) lane_.behaviours.emplace_back(name);
    return index;
  }

  Lane lane_;
  std::optional<double> since_s_;
  std::optional<std::size_t> running_;
};

}  // namespace

Timeline timeline_of(const Recording& recording) {
  std::vector<LaneBuilder> builders;
  for (const std::string& path : recording.instances) builders.emplace_back(path);
  Timeline timeline;
  for (const auto& [event, text] : recording.entries) {
    const double at_s = static_cast<double>(event.time_ns) * 1e-9;
    timeline.end_s = std::max(timeline.end_s, at_s);
    if (event.kind() != Event::Kind::firing || event.subject >= recording.transitions.size()) continue;
    const auto& transition = recording.transitions[event.subject];
    if (transition.instance >= builders.size()) continue;
    builders[transition.instance].fire(transition.role, at_s);
  }
  for (LaneBuilder& builder : builders) timeline.lanes.push_back(builder.finish(timeline.end_s));
  return timeline;
}

std::vector<Lane::Stretch> thinned(const Lane& lane, double end_s, std::size_t columns) {
  if (lane.stretches.size() <= columns || end_s <= 0) return lane.stretches;
  std::vector<std::vector<double>> share(columns, std::vector<double>(lane.behaviours.size()));
  const double column_s = end_s / static_cast<double>(columns);
  for (const auto& [behaviour, from_s, to_s] : lane.stretches) {
    for (auto c = static_cast<std::size_t>(std::max(0.0, from_s / column_s));
         c < columns && static_cast<double>(c) * column_s < to_s; ++c) {
      const double start = static_cast<double>(c) * column_s;
      share[c][behaviour] += std::min(to_s, start + column_s) - std::max(from_s, start);
    }
  }
  std::vector<Lane::Stretch> result;
  for (std::size_t c = 0; c < columns; ++c) {
    const auto most = std::ranges::max_element(share[c]);
    if (most == share[c].end() || *most <= 0) continue;
    const auto behaviour = static_cast<std::size_t>(most - share[c].begin());
    const double from_s = static_cast<double>(c) * column_s;
    if (!result.empty() && result.back().behaviour == behaviour && result.back().to_s >= from_s) {
      result.back().to_s = from_s + column_s;
    } else {
      result.push_back({behaviour, from_s, from_s + column_s});
    }
  }
  return result;
}

}  // namespace tessera::replay
