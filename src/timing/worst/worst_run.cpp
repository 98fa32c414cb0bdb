#include "timing/worst/worst_run.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "timing/worst/climb.hpp"

namespace tessera::timing {
namespace {

/// The run as it is told: from the command back to the reading.
WorstRun told(const System& system, const Chain& chain, const RunLog& log, const RunPlan& plan,
              const Reached& reached, bool reaches) {
  const RunLog::Command& command = log.commands[reached.command];
  WorstRun run;
  run.from = log.calls[system.channels[chain.front()].from][reached.reading].begin;
  run.to = command.at;
  run.reaches = reaches;
  std::uint32_t call = command.call;
  for (std::size_t h = chain.size(); h-- > 0;) {
    const RunLog::Read& read = log.reads[h][static_cast<std::size_t>(log.uses[h][call])];
    const RunLog::Write& write = log.writes[h][read.write];
    run.hops.insert(run.hops.begin(), {chain[h], write.at, read.at});
    call = write.call;
  }
  for (std::uint32_t i = 0; i < log.calls.size(); ++i) {
    if (log.wakes_late[i]) run.on_simulated_clock = false;
    for (std::uint32_t number = 0; number < log.calls[i].size(); ++number) {
      const RunLog::Call& one = log.calls[i][number];
      if (one.begin > run.to) break;
      const std::int8_t order = number < plan[i].size() ? plan[i][number].order : std::int8_t{0};
      const Time end = one.end < 0 ? one.begin + system.subsystems[i].shortest : one.end;
      run.calls.push_back({i, number, one.begin, end, one.begin - one.release, order});
    }
  }
  std::ranges::stable_sort(run.calls, {}, &CallOfRun::begin);
  return run;
}

}  // namespace

std::vector<std::uint32_t> WorstRunSearch::depends_on(const Chain& way) const {
  const System& system = bounds_.occurrences().system();
  std::vector<std::uint32_t> all;
  std::set<std::uint32_t> seen;
  const auto reach = [&](std::uint32_t i) {
    if (seen.insert(i).second) all.push_back(i);
  };
  reach(system.channels[way.front()].from);
  for (const std::uint32_t c : way) reach(system.channels[c].to);
  for (std::size_t at = 0; at < all.size(); ++at) {
    const Subsystem& one = system.subsystems[all[at]];
    for (const std::uint32_t c : one.receives)
      if (system.channels[c].receive_blocks) reach(system.channels[c].from);
    for (const std::uint32_t c : one.sends)
      if (system.channels[c].send_blocks) reach(system.channels[c].to);
    if (one.processor < 0) continue;
    for (std::uint32_t other = 0; other < system.subsystems.size(); ++other)
      if (system.subsystems[other].processor == one.processor) reach(other);
  }
  return all;
}

std::optional<WorstRunSearch::Obstacle> WorstRunSearch::obstacle(
    const std::vector<std::uint32_t>& subsystems) const {
  const System& system = bounds_.occurrences().system();
  for (const std::uint32_t i : subsystems) {
    if (!declared_.missing[i].empty() || system.subsystems[i].longest >= unbounded)
      return Obstacle{Obstacle::Kind::missing, i};
    if (declared_.differ[i]) return Obstacle{Obstacle::Kind::differ, i};
    const auto is_equal = [&](std::uint32_t other) {
      return other != i && system.subsystems[other].processor == system.subsystems[i].processor &&
             system.subsystems[other].priority == system.subsystems[i].priority;
    };
    if (declared_.takes_turns[i] && std::ranges::any_of(subsystems, is_equal))
      return Obstacle{Obstacle::Kind::takes_turns, i};
  }
  if (subsystems.size() > most_subsystems) return Obstacle{Obstacle::Kind::too_many, subsystems.front()};
  return std::nullopt;
}

std::string WorstRunSearch::obstacle(const Chain& way, const spec::Model& model) const {
  const std::optional<Obstacle> found = obstacle(depends_on(way));
  if (!found) return {};
  const std::string path = model.instance_path(spec::InstanceId{found->subsystem});
  switch (found->kind) {
    case Obstacle::Kind::missing:
      return declared_.missing[found->subsystem];
    case Obstacle::Kind::differ:
      return "the behaviours of " + path + " do not all take the same time";
    case Obstacle::Kind::takes_turns:
      return path + " takes turns with others on its processor (`round_robin`)";
    case Obstacle::Kind::too_many:
      break;
  }
  return "the chain depends on more than " + std::to_string(most_subsystems) + " subsystems";
}

WorstRunSearch::Part WorstRunSearch::part_of(const Chain& way) const {
  const System& whole = bounds_.occurrences().system();
  Part part;
  part.system.latency = whole.latency;
  part.subsystems = depends_on(way);
  std::vector<int> processors;
  std::vector<std::int64_t> number_of(whole.subsystems.size(), -1), channel_of(whole.channels.size(), -1);
  for (std::size_t at = 0; at < part.subsystems.size(); ++at)
    number_of[part.subsystems[at]] = static_cast<std::int64_t>(at);
  const auto inside = [&](std::uint32_t c) {
    const Channel& channel = whole.channels[c];
    if (number_of[channel.from] < 0 || number_of[channel.to] < 0) return false;
    if (channel_of[c] >= 0) return true;
    channel_of[c] = static_cast<std::int64_t>(part.system.channels.size());
    Channel& mine = part.system.channels.emplace_back(channel);
    mine.from = static_cast<std::uint32_t>(number_of[channel.from]);
    mine.to = static_cast<std::uint32_t>(number_of[channel.to]);
    return true;
  };
  for (const std::uint32_t i : part.subsystems) {
    Subsystem& mine = part.system.subsystems.emplace_back(whole.subsystems[i]);
    for (std::vector<std::uint32_t>* const list : {&mine.sends, &mine.receives}) {
      std::vector<std::uint32_t> kept;
      for (const std::uint32_t c : *list)
        if (inside(c)) kept.push_back(static_cast<std::uint32_t>(channel_of[c]));
      *list = std::move(kept);
    }
    if (mine.processor < 0) continue;
    auto known = std::ranges::find(processors, mine.processor);
    if (known == processors.end()) known = processors.insert(processors.end(), mine.processor);
    mine.processor = static_cast<int>(known - processors.begin());
  }
  for (const std::uint32_t c : way) part.chain.push_back(static_cast<std::uint32_t>(channel_of[c]));
  return part;
}

std::vector<Time> WorstRunSearch::Part::key() const {
  std::vector<Time> all{system.latency, static_cast<Time>(system.subsystems.size())};
  const auto add = [&](const std::vector<std::uint32_t>& list) {
    all.push_back(static_cast<Time>(list.size()));
    all.insert(all.end(), list.begin(), list.end());
  };
  for (const Subsystem& one : system.subsystems) {
    for (const Time part : {one.period, one.shortest, one.longest, Time{one.catch_up}, Time{one.parallel},
                            Time{one.processor}, Time{one.priority}})
      all.push_back(part);
    add(one.sends);
    add(one.receives);
  }
  for (const Channel& one : system.channels)
    for (const Time part : {Time{one.from}, Time{one.to}, Time{one.send_blocks}, Time{one.receive_blocks},
                            one.send_timeout, one.receive_timeout})
      all.push_back(part);
  add(chain);
  return all;
}

WorstRuns WorstRunSearch::find(const DeclaredChain& chain) {
  const Chain *oldest = nullptr, *slowest = nullptr;
  Time age = -1, reaction = -1;
  for (const Chain& way : chain.ways) {
    const ChainBound bound = bounds_.chain(way);
    if (bound.reaction >= unbounded) return {};
    if (bound.age > age) oldest = &way;
    if (bound.reaction > reaction) slowest = &way;
    age = std::max(age, bound.age);
    reaction = std::max(reaction, bound.reaction);
  }
  if (oldest == nullptr) return {};
  return {find(*oldest, true), find(*slowest, false)};
}

std::optional<WorstRun> WorstRunSearch::find(const Chain& way, bool age) {
  if (left_ == 0 || obstacle(depends_on(way))) return std::nullopt;
  const ChainBound bound = bounds_.chain(way);
  if (bound.reaction >= unbounded) return std::nullopt;
  const Part part = part_of(way);
  std::vector<Time> key = part.key();
  key.push_back(age ? 1 : 0);
  auto known = std::ranges::find(found_, key, &Found::key);
  if (known == found_.end()) {
    const ChainRoutes routes = bounds_.routes(way);
    const Route& route = age ? routes.age : routes.reaction;
    const std::uint64_t most = std::min(left_, most_steps_of_one);
    Climb climb(part.system, part.chain,
                {age, age ? bound.age : bound.reaction, route.reading, route.pattern}, most, stop_);
    Found found{std::move(key), std::nullopt};
    if (climb.search())
      found.run = told(part.system, part.chain, climb.replay(), climb.plan(), climb.best(),
                       climb.best().time >= (age ? bound.age : bound.reaction));
    left_ -= std::min(left_, climb.steps());
    known = found_.insert(found_.end(), std::move(found));
  }
  std::optional<WorstRun> run = known->run;
  if (!run) return run;
  for (CallOfRun& call : run->calls) call.subsystem = part.subsystems[call.subsystem];
  for (std::size_t h = 0; h < way.size(); ++h) run->hops[h].channel = way[h];
  return run;
}

}  // namespace tessera::timing
