#include "project/process/network_processes.hpp"

#include <charconv>
#include <cstdint>
#include <utility>

namespace tessera::project {

namespace {

/// One that the middleware forgets earlier has taken its leave: it forgets a silent one after 20 s.
constexpr std::chrono::seconds surely_no_silence{8};
/// The last texts of a process may overtake each other.
constexpr std::chrono::seconds aftermath{1};

std::uint64_t number_of(std::string_view incarnation) {
  std::uint64_t number = 0;
  std::from_chars(incarnation.data(), incarnation.data() + incarnation.size(), number);
  return number;
}

/// Takes a brief text of a process whose lists are known.
void take_brief(Snapshot& known, const Snapshot& brief) {
  known.time_s = brief.time_s;
  known.pid = brief.pid;
  known.host = brief.host;
  known.net_hash = brief.net_hash;
  known.emergency = brief.emergency;
}

}  // namespace

bool NetworkProcesses::take(
    StatusFeed& feed,
    const std::function<void(const WatchedProcess& process, std::string_view line)>& each_line) {
  bool changed = false;
  for (HeardStatus& heard : feed.take()) {
    const std::string line = std::move(heard.line);
    const WatchedProcess* const process = take(std::move(heard));
    changed = changed || process != nullptr;
    if (process != nullptr && !line.empty() && each_line) each_line(*process, line);
  }
  return changed;
}

/// nullptr: it says nothing new.
const WatchedProcess* NetworkProcesses::take(HeardStatus heard) {
  const Clock::time_point now = Clock::now();
  const auto known = all_.find(heard.process);
  const std::uint64_t before = known == all_.end() ? 0 : number_of(known->second.snapshot.incarnation);
  const std::uint64_t number = number_of(heard.incarnation);
  if (number < before) return nullptr;
  if (heard.what != HeardStatus::What::told) {
    if (known == all_.end() || number != before || !known->second.is_there()) return nullptr;
    WatchedProcess& process = known->second;
    const bool left = heard.what == HeardStatus::What::ended || now - process.heard < surely_no_silence;
    process.state = left ? WatchedProcess::State::ended : WatchedProcess::State::gone;
    process.since = left ? now : process.heard;
    return &process;
  }
  if (!net_hash_.empty() && heard.snapshot.net_hash != net_hash_) {
    ++of_another_net_;
    return nullptr;
  }
  if (known != all_.end() && number == before) {
    WatchedProcess& process = known->second;
    if (!process.is_there() && now - *process.since < aftermath) return nullptr;
    if (process.state != WatchedProcess::State::running) process.since = now;
    process.state = WatchedProcess::State::running;
    process.heard = now;
    if (heard.snapshot.brief)
      take_brief(process.snapshot, heard.snapshot);
    else
      process.snapshot = std::move(heard.snapshot);
    return &process;
  }
  return &(all_[heard.process] =
               WatchedProcess{.since = now,
                              .heard = now,
                              .socket = "network:" + heard.process + ":" + heard.incarnation,
                              .is_local = false,
                              .by_network = true,
                              .snapshot = std::move(heard.snapshot)});
}

bool NetworkProcesses::notice_silence() {
  bool changed = false;
  for (auto& [name, process] : all_) {
    if (process.state != WatchedProcess::State::running) continue;
    if (Clock::now() < process.heard + longest_silence) continue;
    process.state = WatchedProcess::State::silent;
    process.since = process.heard;
    changed = true;
  }
  return changed;
}

const WatchedProcess* NetworkProcesses::find(std::string_view name) const {
  const auto found = all_.find(name);
  return found == all_.end() ? nullptr : &found->second;
}

const WatchedProcess* shown_of(const WatchedProcess* here, const WatchedProcess* elsewhere) {
  if (here == nullptr || elsewhere == nullptr) return here == nullptr ? elsewhere : here;
  if (here->is_there() || !elsewhere->is_there()) return here;
  const bool is_later = number_of(elsewhere->snapshot.incarnation) > number_of(here->snapshot.incarnation);
  return is_later ? elsewhere : here;
}

}  // namespace tessera::project
