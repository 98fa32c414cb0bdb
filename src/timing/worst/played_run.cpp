#include "timing/worst/played_run.hpp"

#include <algorithm>
#include <utility>

namespace tessera::timing {

PlayedRun::PlayedRun(const System& system, const Chain& chain)
    : system_(system),
      chain_(chain),
      states_(system.subsystems.size()),
      slots_(system.channels.size()),
      hops_of_channel_(system.channels.size()),
      hops_to_(system.subsystems.size()),
      mates_(system.subsystems.size()) {
  for (std::uint32_t h = 0; h < chain.size(); ++h) {
    const Channel& channel = system.channels[chain[h]];
    hops_.push_back({chain[h], channel.from, channel.to});
    hops_of_channel_[chain[h]].push_back(h);
    hops_to_[channel.to].push_back(h);
  }
  for (std::uint32_t i = 0; i < mates_.size(); ++i)
    for (std::uint32_t j = 0; j < mates_.size(); ++j)
      if (i != j && shares(i) && of(i).processor == of(j).processor) mates_[i].push_back(j);
  log_.calls.resize(states_.size());
  log_.writes.resize(hops_.size());
  log_.reads.resize(hops_.size());
  log_.uses.resize(hops_.size());
}

const RunLog& PlayedRun::play(const RunPlan& plan, Time until) {
  plan_ = &plan;
  now_ = 0;
  for (auto& list : log_.uses) list.clear();
  for (auto& list : log_.calls) list.clear();
  for (auto& list : log_.writes) list.clear();
  for (auto& list : log_.reads) list.clear();
  log_.commands.clear();
  log_.wakes_late.assign(states_.size(), false);
  log_.is_whole = false;
  for (Slot& slot : slots_) slot = {};
  for (Hop& hop : hops_) hop.held = -1;
  for (std::uint32_t i = 0; i < states_.size(); ++i) {
    State& state = states_[i];
    state = {.transfers = std::move(state.transfers)};
    arrive(i);
    if (const Time late = latency_of(i); late > 0) {  // its thread starts
      state.asleep = true;
      state.wakes = late;
    }
  }
  constexpr std::uint64_t most_steps = 200'000;
  const std::uint64_t from = steps_;
  for (;;) {
    for (std::int64_t next = next_turn(); next >= 0; next = next_turn()) {
      turn(static_cast<std::uint32_t>(next));
      if (steps_ - from > most_steps) return log_;
    }
    const Time next = next_instant();
    if (next > until) break;
    advance(next);
  }
  log_.is_whole = true;
  return log_;
}

// ---------------------------------------------------------------------------------------------- turns

PlannedCall PlayedRun::planned(std::uint32_t i) const {
  const State& state = states_[i];
  const std::size_t begun = log_.calls[i].size();
  const std::size_t call = state.at == At::released || begun == 0 ? begun : begun - 1;
  const std::vector<PlannedCall>& calls = (*plan_)[i];
  return call < calls.size() ? calls[call] : PlannedCall{of(i).shortest};
}

bool PlayedRun::is_able(std::uint32_t i) const {
  const State& state = states_[i];
  if (state.asleep) return now_ >= state.wakes && gets_processor(i);
  if (state.at == At::calling) return shares(i) ? state.left == 0 : now_ >= state.due;
  return true;
}

/// Nobody of higher priority wants the processor, and no equal came before.
bool PlayedRun::gets_processor(std::uint32_t i) const {
  return std::ranges::none_of(mates_[i], [&](std::uint32_t j) {
    const State& other = states_[j];
    if (of(j).priority < of(i).priority) return false;
    if (!other.asleep) return other.at == At::calling && other.left > 0;
    if (other.wakes > now_) return false;
    return of(j).priority > of(i).priority || other.wakes < states_[i].wakes;
  });
}

bool PlayedRun::is_running(std::uint32_t i) const {
  const State& state = states_[i];
  if (state.at != At::calling || state.asleep || state.left == 0) return false;
  return std::ranges::none_of(mates_[i], [&](std::uint32_t j) {
    const State& other = states_[j];
    if (other.at != At::calling || other.asleep || other.left == 0) return false;
    if (of(j).priority != of(i).priority) return of(j).priority > of(i).priority;
    return other.queued != state.queued ? other.queued < state.queued : j < i;
  });
}

/// -1: nobody can act at this instant.
std::int64_t PlayedRun::next_turn() const {
  std::int64_t first = -1;
  std::int8_t order = 0;
  for (std::uint32_t i = 0; i < states_.size(); ++i) {
    if (!is_able(i)) continue;
    const std::int8_t its = planned(i).order;
    if (first >= 0 && its >= order) continue;
    first = i;
    order = its;
  }
  return first;
}

Time PlayedRun::next_instant() const {
  Time next = unbounded;
  for (std::uint32_t i = 0; i < states_.size(); ++i) {
    const State& state = states_[i];
    if (state.asleep) {
      if (state.wakes > now_) next = std::min(next, state.wakes);  // else it waits for its processor
    } else if (state.at == At::calling && !shares(i)) {
      next = std::min(next, state.due);
    } else if (is_running(i)) {
      next = std::min(next, now_ + state.left);
    }
  }
  return next;
}

void PlayedRun::advance(Time to) {
  std::vector<std::uint32_t>& passed = running_;
  passed.clear();
  for (std::uint32_t i = 0; i < states_.size(); ++i)
    if (shares(i) && is_running(i)) passed.push_back(i);
  for (const std::uint32_t i : passed) states_[i].left -= to - now_;
  now_ = to;
}

void PlayedRun::wake_up(std::uint32_t i) {
  State& state = states_[i];
  if (!state.asleep) return;
  state.asleep = false;
  state.queued = std::exchange(state.wakes, unbounded);
  if (state.at == At::sending || state.at == At::receiving)
    if (latency_of(i) > 0 || state.queued < now_) log_.wakes_late[i] = true;
  if (state.blocked_since >= 0) state.waited += now_ - std::exchange(state.blocked_since, -1);
}

void PlayedRun::turn(std::uint32_t i) {
  wake_up(i);
  while (step(i)) continue;
}

/// false: it has to wait.
bool PlayedRun::step(std::uint32_t i) {
  ++steps_;
  State& state = states_[i];
  switch (state.at) {
    case At::released:
      if (now_ < state.due) {
        state.asleep = true;
        state.wakes = state.due + latency_of(i);
        return false;
      }
      begin_call(i);
      return true;
    case At::calling:
      if (shares(i) ? state.left > 0 : now_ < state.due) return false;
      end_call(i);
      return true;
    case At::sending:
    case At::receiving:
      break;
  }
  return transfer(i);
}

// ---------------------------------------------------------------------------------------------- iterations

/// The release of the next call (runtime: Releases::next).
void PlayedRun::arrive(std::uint32_t i) {
  State& state = states_[i];
  const Time period = of(i).period, waited = std::exchange(state.waited, 0);
  state.at = At::released;
  if (period == 0) {
    state.due = now_;
    return;
  }
  if (state.next_release < 0) {
    state.next_release = 0;
  } else {
    const Time missed = ceil_div(now_ - waited, period) - state.next_release;
    const Time made_up = of(i).catch_up ? std::max<Time>(0, missed) : 0;
    state.next_release = std::max(state.next_release, ceil_div(now_, period) - made_up);
  }
  state.due = period * state.next_release++;
}

void PlayedRun::begin_call(std::uint32_t i) {
  State& state = states_[i];
  const Time takes = planned(i).takes;
  for (const std::uint32_t h : hops_to_[i]) log_.uses[h].push_back(hops_[h].held);
  log_.calls[i].push_back({state.due, now_});
  state.at = At::calling;
  state.left = takes;
  if (!shares(i)) state.due = now_ + takes;
}

void PlayedRun::end_call(std::uint32_t i) {
  const auto call = static_cast<std::uint32_t>(log_.calls[i].size() - 1);
  log_.calls[i][call].end = now_;
  if (const std::size_t last = hops_.size() - 1; hops_[last].to == i)
    if (const std::int64_t read = log_.uses[last][call]; read >= 0) {
      const RunLog::Write& write = log_.writes[last][log_.reads[last][static_cast<std::size_t>(read)].write];
      if (write.reading >= 0) log_.commands.push_back({now_, call, write.reading});
    }
  begin_transfers(i, At::sending);
}

void PlayedRun::begin_transfers(std::uint32_t i, At at) {
  State& state = states_[i];
  state.at = at;
  state.transfers.clear();
  for (const std::uint32_t c : at == At::sending ? of(i).sends : of(i).receives)
    state.transfers.push_back({c});
}

bool PlayedRun::transfer(std::uint32_t i) {
  State& state = states_[i];
  Time deadline = unbounded;
  bool all = true;
  for (Transfer& one : state.transfers) {
    if (one.done) continue;
    if (state.at == At::sending ? send(one) : receive(one)) {
      one.done = true;
      continue;
    }
    all = false;
    const Channel& channel = system_.channels[one.channel];
    const Time timeout = state.at == At::sending ? channel.send_timeout : channel.receive_timeout;
    if (timeout > 0) deadline = std::min(deadline, one.since + timeout);
    if (!of(i).parallel) break;
  }
  if (all) {
    if (state.at == At::sending)
      begin_transfers(i, At::receiving);
    else
      arrive(i);
    return true;
  }
  state.blocked_since = now_;
  state.asleep = true;
  state.wakes = deadline >= unbounded ? unbounded : deadline + latency_of(i);
  return false;
}

// ---------------------------------------------------------------------------------------------- channels

bool PlayedRun::send(Transfer& transfer) {
  const Channel& channel = system_.channels[transfer.channel];
  Slot& slot = slots_[transfer.channel];
  if (transfer.since < 0) {
    transfer.since = now_;
    log_write(transfer.channel);
    slot.full = channel.send_blocks || channel.receive_blocks;
    notify(channel.to, At::receiving, transfer.channel);
    if (!channel.send_blocks) return true;
  }
  if (slot.acked) {
    slot.acked = false;
    return true;
  }
  if (channel.send_timeout == 0 || !slot.full || now_ < transfer.since + channel.send_timeout) return false;
  slot.full = false;
  return true;
}

bool PlayedRun::receive(Transfer& transfer) {
  const Channel& channel = system_.channels[transfer.channel];
  Slot& slot = slots_[transfer.channel];
  if (transfer.since < 0) transfer.since = now_;
  if (!channel.send_blocks && !channel.receive_blocks) {
    log_read(transfer.channel);
    return true;
  }
  if (slot.full) {
    slot.full = false;
    log_read(transfer.channel);
    if (channel.send_blocks) {
      slot.acked = true;
      notify(channel.from, At::sending, transfer.channel);
    }
    return true;
  }
  return !channel.receive_blocks ||
         (channel.receive_timeout > 0 && now_ >= transfer.since + channel.receive_timeout);
}

void PlayedRun::notify(std::uint32_t i, At at, std::uint32_t channel) {
  State& state = states_[i];
  if (!state.asleep || state.at != at) return;
  const auto one = std::ranges::find(state.transfers, channel, &Transfer::channel);
  if (one != state.transfers.end() && one->since >= 0 && !one->done)
    state.wakes = std::min(state.wakes, now_ + latency_of(i));
}

void PlayedRun::log_write(std::uint32_t channel) {
  for (const std::uint32_t h : hops_of_channel_[channel]) {
    const auto call = static_cast<std::uint32_t>(log_.calls[hops_[h].from].size() - 1);
    std::int64_t reading = call;
    if (h > 0) {
      const std::int64_t used = log_.uses[h - 1][call];
      reading =
          used < 0 ? -1 : log_.writes[h - 1][log_.reads[h - 1][static_cast<std::size_t>(used)].write].reading;
    }
    slots_[channel].write = static_cast<std::int64_t>(log_.writes[h].size());
    log_.writes[h].push_back({now_, call, reading});
  }
}

void PlayedRun::log_read(std::uint32_t channel) {
  // A channel that is on several hops has as many writes on each.
  const std::int64_t write = slots_[channel].write;
  if (write < 0) return;
  for (const std::uint32_t h : hops_of_channel_[channel]) {
    hops_[h].held = static_cast<std::int64_t>(log_.reads[h].size());
    log_.reads[h].push_back({now_, static_cast<std::uint32_t>(write)});
  }
}

}  // namespace tessera::timing
