#include "timing/worst/climb.hpp"

#include <algorithm>
#include <utility>

namespace tessera::timing {

std::int64_t call_at(const RunLog& log, std::uint32_t subsystem, Time at) {
  const std::vector<RunLog::Call>& calls = log.calls[subsystem];
  return std::ranges::upper_bound(calls, at, {}, &RunLog::Call::begin) - calls.begin() - 1;
}

Climb::Climb(const System& system, const Chain& chain, const Goal& goal, std::uint64_t most_steps,
             const StopAsked& stop)
    : system_(system), chain_(chain), goal_(goal), most_steps_(most_steps), stop_(stop), run_(system, chain) {
  for (const Subsystem& one : system.subsystems)
    longest_round_ = std::max({longest_round_, one.period, one.longest});
}

bool Climb::search() {
  // Only the chain, only others, all: each is the worst somewhere.
  const std::vector<Time> readings = readings_to_try();
  for (const Start start : {Start::quick, Start::slow, Start::chain_quick, Start::mixed})
    for (const Time reading : readings) {
      if (is_over()) return best_.time >= 0;
      until_ = reading + goal_.bound + longest_round_;
      improve(begin_with(start), reading);
    }
  climb_by_chance();
  return best_.time >= 0;
}

/// Readings after a while, since chances come one after the other, and in the pattern of the bound.
std::vector<Time> Climb::readings_to_try() const {
  const Time settled = goal_.bound + longest_round_;
  std::vector<Time> readings;
  if (goal_.reading >= 0 && goal_.pattern > 0) {
    const Time later = goal_.reading >= settled
                           ? goal_.reading
                           : goal_.reading + ceil_div(settled - goal_.reading, goal_.pattern) * goal_.pattern;
    if (later < settled + 64 * longest_round_) readings.push_back(later);
    readings.push_back(goal_.reading);
  }
  constexpr Time most = 12;
  const Subsystem& root = system_.subsystems[system_.channels[chain_.front()].from];
  const Time step = std::max<Time>(1, root.period > 0 ? root.period : longest_round_);
  const Time window = std::min(goal_.pattern > 0 ? goal_.pattern : 3 * longest_round_, 16 * longest_round_);
  const Time count = std::clamp<Time>(window / step, 1, most);
  for (Time k = 0; k < count; ++k) readings.push_back((settled + window * k / count) / step * step);
  return readings;
}

Time Climb::shortest(std::uint32_t i) const {
  // Time must go on.
  return std::max<Time>(system_.subsystems[i].period == 0 ? 1 : 0, system_.subsystems[i].shortest);
}

RunPlan Climb::begin_with(Start start) {
  constexpr Time most_calls = 4000;
  RunPlan plan(system_.subsystems.size());
  std::vector<bool> in_chain(plan.size());
  in_chain[system_.channels[chain_.front()].from] = true;
  for (const std::uint32_t c : chain_) in_chain[system_.channels[c].to] = true;
  for (std::uint32_t i = 0; i < plan.size(); ++i) {
    const Time round = std::max<Time>(1, std::max(system_.subsystems[i].period, shortest(i)));
    plan[i].resize(static_cast<std::size_t>(std::min(most_calls, until_ / round + 2)));
    for (PlannedCall& call : plan[i]) {
      const bool is_slow = start == Start::slow || (start == Start::chain_quick && !in_chain[i]) ||
                           (start == Start::mixed && draw(2) == 0);
      call = is_slow ? slow(i) : quick(i);
      call.order = 0;
    }
  }
  return plan;
}

std::uint64_t Climb::draw(std::uint64_t below) {
  // SplitMix64, as CallTimes of the runtime: the same numbers on every machine.
  std::uint64_t mixed = random_ += 0x9e3779b97f4a7c15U;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9U;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebU;
  return (mixed ^ (mixed >> 31)) % below;
}

// ---------------------------------------------------------------------------------------------- measures

Reached Climb::measure(const RunLog& log, std::optional<std::uint32_t> reading) const {
  if (!log.is_whole) return {};
  Reached reached = goal_.age ? measure_age(log, reading) : measure_reaction(log, reading);
  if (reached.time >= 0 || reading) reached.newer = newer_of(log, reading ? *reading : reached.reading);
  return reached;
}

Reached Climb::measure_age(const RunLog& log, std::optional<std::uint32_t> reading) const {
  const std::vector<RunLog::Call>& readings = log.calls[system_.channels[chain_.front()].from];
  Reached reached;
  for (std::uint32_t at = 0; at < log.commands.size(); ++at) {
    const RunLog::Command& command = log.commands[at];
    if (reading && command.reading > *reading) break;
    const Time age = command.at - readings[static_cast<std::size_t>(command.reading)].begin;
    if (age <= reached.time && !reading) continue;
    reached = {age, 0, static_cast<std::uint32_t>(command.reading), at};
  }
  return reached;
}

/// An event comes just after a reading: until the first command that reflects a later one.
Reached Climb::measure_reaction(const RunLog& log, std::optional<std::uint32_t> reading) const {
  const std::vector<RunLog::Call>& readings = log.calls[system_.channels[chain_.front()].from];
  Reached reached;
  std::uint32_t at = 0;
  for (std::uint32_t k = reading.value_or(0); k < readings.size(); ++k) {
    while (at < log.commands.size() && log.commands[at].reading <= k) ++at;
    if (at == log.commands.size()) break;
    const Time time = log.commands[at].at - readings[k].begin;
    if (time > reached.time) reached = {time, 0, k, at};
    if (reading) break;
  }
  return reached;
}

Time Climb::newer_of(const RunLog& log, std::int64_t reading) const {
  Time sum = 0;
  for (const std::vector<RunLog::Write>& writes : log.writes) {
    const auto newer = std::ranges::upper_bound(writes, reading, {}, &RunLog::Write::reading);
    sum += newer == writes.end() ? until_ : newer->at;
  }
  return sum;
}

Reached Climb::play(const RunPlan& plan, std::optional<std::uint32_t> reading) {
  check(stop_);
  return measure(run_.play(plan, until_), reading);
}

void Climb::keep(const Reached& reached, const RunPlan& plan) {
  if (reached.time <= best_.time) return;
  best_ = reached;
  best_plan_ = plan;
  best_until_ = until_;
}

// ---------------------------------------------------------------------------------------------- steps

/// Changes calls along the way of the values of one reading, as long as that makes them later.
void Climb::improve(RunPlan plan, Time at) {
  const std::uint32_t root = system_.channels[chain_.front()].from;
  const std::int64_t reading = call_at(run_.play(plan, until_), root, at);
  if (reading < 0) return;
  const auto target = static_cast<std::uint32_t>(reading);
  Reached reached = play(plan, target);
  keep(reached, plan);
  constexpr int most_rounds = 12;
  for (int round = 0; round < most_rounds && !is_over(); ++round) {
    std::vector<Changes> all =
        proposals(run_.play(plan, until_), plan, {reached.time, reached.newer, target, reached.command});
    bool better = false;
    for (Changes& changes : all) {
      if (!apply(plan, changes)) continue;
      const Reached next = play(plan, target);
      if (reached.is_before(next)) {
        reached = next;
        better = true;
        keep(reached, plan);
        if (is_over()) return;
      } else {
        apply(plan, changes);  // back
      }
    }
    if (!better) break;
  }
}

/// Exchanges what is planned and what the changes say. false: they change nothing.
bool Climb::apply(RunPlan& plan, Changes& changes) const {
  bool changes_something = false;
  for (Change& change : changes) {
    PlannedCall& planned = plan[change.call.subsystem][change.call.number];
    changes_something = changes_something || planned != change.planned;
    std::swap(planned, change.planned);
  }
  if (!changes_something) return false;
  return true;
}

std::vector<Climb::Changes> Climb::proposals(const RunLog& log, const RunPlan& plan, const Reached& reached) {
  std::vector<Changes> all;
  std::vector<std::vector<bool>> seen(plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) seen[i].resize(plan[i].size());
  const auto around = [&](std::uint32_t i, std::int64_t number) {
    for (std::int64_t near = number - 2; near <= number + 2; ++near) {
      if (near < 0 || near >= static_cast<std::int64_t>(plan[i].size())) continue;
      if (seen[i][static_cast<std::size_t>(near)]) continue;
      seen[i][static_cast<std::size_t>(near)] = true;
      propose_around({i, static_cast<std::uint32_t>(near)}, plan, all);
    }
  };
  const auto is_planned = [&](std::uint32_t i, std::int64_t number) {
    return number >= 0 && number < static_cast<std::int64_t>(plan[i].size());
  };
  for (std::size_t h = 0; h < chain_.size(); ++h) {
    const std::uint32_t from = system_.channels[chain_[h]].from, to = system_.channels[chain_[h]].to;
    const std::vector<RunLog::Write>& writes = log.writes[h];
    const auto newer = std::ranges::upper_bound(writes, static_cast<std::int64_t>(reached.reading), {},
                                                &RunLog::Write::reading);
    if (newer == writes.end()) continue;
    // The value comes late, and the receiver has just looked.
    const auto read = std::ranges::find_if(log.reads[h], [&](const RunLog::Read& one) {
      return one.write >= static_cast<std::uint32_t>(newer - writes.begin());
    });
    if (read != log.reads[h].end() && is_planned(from, newer->call)) {
      const std::int64_t taker = call_at(log, to, read->at);
      for (std::int64_t looks = taker; looks >= taker - 1; --looks) {
        if (!is_planned(to, looks)) continue;
        const auto number = static_cast<std::uint32_t>(looks);
        all.push_back({{{from, newer->call}, slow(from)}, {{to, number}, quick(to)}});
        PlannedCall meets = quick(to);
        meets.takes =
            std::clamp(newer->at - log.calls[to][number].begin, meets.takes, system_.subsystems[to].longest);
        all.push_back({{{to, number}, meets}});
        all.push_back({{{from, newer->call}, slow(from)}, {{to, number}, meets}});
      }
      for (const std::uint32_t i : {to, from}) {
        if (system_.subsystems[i].period > 0) continue;
        const std::int64_t last = i == to ? taker : newer->call;
        for (const Time by : {newer->at - read->at, read->at - newer->at})
          propose_shifts(i, last, by, plan, all);
      }
      around(to, taker);
    }
    around(from, newer->call);
  }
  if (reached.command < log.commands.size())
    around(system_.channels[chain_.back()].to, log.commands[reached.command].call);
  // Others that these wait for, or share a processor with.
  const Time from = log.calls[system_.channels[chain_.front()].from][reached.reading].begin,
             to = std::max(from + reached.time, from + longest_round_);
  for (std::uint32_t i = 0; i < plan.size(); ++i) {
    constexpr std::int64_t most = 10;
    const std::int64_t first = std::max<std::int64_t>(0, call_at(log, i, from)), last = call_at(log, i, to);
    for (std::int64_t number = first; number <= std::min(last, first + most); ++number) around(i, number);
  }
  return all;
}

void Climb::propose_around(Call call, const RunPlan& plan, std::vector<Changes>& all) const {
  const PlannedCall now = plan[call.subsystem][call.number];
  PlannedCall slow_first = slow(call.subsystem), quick_last = quick(call.subsystem), other = now;
  slow_first.order = -1;
  quick_last.order = 1;
  other.order = static_cast<std::int8_t>(now.order > 0 ? -1 : 1);
  for (const PlannedCall& planned :
       {slow(call.subsystem), quick(call.subsystem), slow_first, quick_last, other})
    all.push_back({{call, planned}});
}

/// Calls without a rate follow one another: a longer one makes all later ones later.
void Climb::propose_shifts(std::uint32_t subsystem, std::int64_t number, Time by, const RunPlan& plan,
                           std::vector<Changes>& all) const {
  for (std::int64_t one = number; one >= std::max<std::int64_t>(0, number - 4); --one) {
    if (one >= static_cast<std::int64_t>(plan[subsystem].size())) continue;
    PlannedCall planned = plan[subsystem][static_cast<std::size_t>(one)];
    planned.takes =
        std::clamp(planned.takes + by, shortest(subsystem), system_.subsystems[subsystem].longest);
    all.push_back({{{subsystem, static_cast<std::uint32_t>(one)}, planned}});
  }
}

/// Changes some calls of the best run, for any reading.
void Climb::climb_by_chance() {
  if (best_plan_.empty()) return;
  until_ = best_until_;
  RunPlan plan = best_plan_;
  Reached reached = play(plan, std::nullopt);
  while (!is_over()) {
    Changes changes;
    const Time around = best_until_ - goal_.bound - 2 * longest_round_;
    for (std::uint64_t left = 1 + draw(4); left > 0; --left) {
      const auto i = static_cast<std::uint32_t>(draw(plan.size()));
      if (plan[i].empty()) continue;
      const RunPlan& known = plan;
      const std::size_t calls = known[i].size();
      const auto share =
          static_cast<std::size_t>(around <= 0 ? 0
                                               : static_cast<double>(calls) * static_cast<double>(around) /
                                                     static_cast<double>(best_until_));
      const auto number = static_cast<std::uint32_t>(share + draw(std::max<std::size_t>(1, calls - share)));
      PlannedCall planned = draw(2) == 0 ? slow(i) : quick(i);
      if (draw(4) == 0)
        planned.takes = shortest(i) + static_cast<Time>(draw(static_cast<std::uint64_t>(
                                          system_.subsystems[i].longest - shortest(i) + 1)));
      planned.order = static_cast<std::int8_t>(static_cast<int>(draw(3)) - 1);
      planned.late = draw(2) == 0;
      changes.push_back(
          {{i, std::min<std::uint32_t>(number, static_cast<std::uint32_t>(calls - 1))}, planned});
    }
    // The same call twice: taking the changes back would not give what was.
    bool twice = false;
    for (std::size_t one = 0; one < changes.size(); ++one)
      for (std::size_t other = 0; other < one; ++other)
        twice = twice || (changes[one].call.subsystem == changes[other].call.subsystem &&
                          changes[one].call.number == changes[other].call.number);
    if (twice || !apply(plan, changes)) continue;
    const Reached next = play(plan, std::nullopt);
    if (next.is_before(reached)) {
      apply(plan, changes);
      continue;
    }
    reached = next;
    keep(reached, plan);
  }
}

}  // namespace tessera::timing
