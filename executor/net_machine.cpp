#include "executor/net_machine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>
#include <utility>

#include "tessera/firing.hpp"

namespace tessera {

using firing::after;
using firing::suffices;

NetMachine::NetMachine(ExecutableNet net, NetExecutor::Options options, FiringProgram program)
    : net_(std::move(net)), options_(std::move(options)), program_(std::move(program)) {
  const bool any_on_worker = std::ranges::any_of(net_.places, [](const ExecutableNet::Place& place) {
    return place.operation && place.runs == ExecutableNet::Runs::on_worker;
  });
  if (any_on_worker)
    workers_ = std::make_unique<WorkerPool>(std::max(options_.workers, 1U),
                                            [this] { call_attention(operation_finished); });
  for (std::uint32_t t = 0; t < program_.hops.size(); ++t)
    if (net_.transitions[program_.original_transition[t]].condition) conditional_.push_back(t);

  std::vector<std::uint32_t> sizes(program_.ranks, 0);
  for (const std::uint32_t rank : program_.rank) ++sizes[rank];
  for (std::uint32_t& size : sizes) size = std::bit_ceil(size);
  rings_.resize(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
  std::size_t first = 0;
  for (const std::uint32_t size : sizes) {
    ranks_.emplace_back(std::span(rings_).subspan(first, size));
    first += size;
  }
  if (program_.ranks == 1 && options_.ties == NetExecutor::Ties::fair) {
    fair_.push_back(ranks_.front());
  } else {
    occupied_.assign((program_.ranks + 63) / 64, 0);
    ranked_.emplace_back(program_.rank, ranks_, occupied_);
    if (options_.ties == NetExecutor::Ties::random) ranked_.front().draw_lots(options_.seed);
  }
  mark_initially();
}

void NetMachine::mark_initially() {
  tokens_.assign(program_.places.size(), 0);
  in_work_.assign(program_.places.size(), 0);
  for (std::uint32_t place = 0; place < program_.places.size(); ++place) {
    const std::uint32_t count = net_.places[program_.original_place[place]].tokens;
    (program_.places[place].operates ? in_work_ : tokens_)[place] = count;
    if (program_.places[place].operates) unstarted_.insert(unstarted_.end(), count, place);
  }
  status_.assign(program_.hops.size(), 0);
  for (const std::uint32_t t : program_.number_of_transition) {
    const FiringProgram::Arcs& arcs = program_.arcs[t];
    for (std::uint32_t arc = arcs.takes; arc < arcs.takes_end; ++arc)
      if (!suffices(tokens_[program_.takes[arc].place], program_.takes[arc].weight))
        status_[t] += missing_one;
    if (status_[t] != 0) continue;
    if (program_.hops[t].kind == Hop::Kind::general) status_[t] = waiting;
    fair_.empty() ? ranked_.front().push(t) : fair_.front().push(t);
  }
}

NetExecutor::Outcome NetMachine::run(std::uint64_t most) {
  return fair_.empty() ? run_with(ranked_.front(), most) : run_with(fair_.front(), most);
}

// -------------------------------------------------------------------------------------------- firing

bool NetMachine::condition_holds(std::uint32_t original) {
  const ExecutableNet::Transition& transition = net_.transitions[original];
  try {
    return transition.condition();
  } catch (...) {
    fault_by(std::current_exception(), "the condition of transition", transition.name);
    return false;
  }
}

[[gnu::always_inline]] inline bool NetMachine::within_bound(const FiringProgram::Arcs& arcs) {
  for (std::uint32_t arc = arcs.gives; arc < arcs.gives_end; ++arc) {
    const FiringProgram::Give& give = program_.gives[arc];
    std::uint64_t held = tokens_[give.place];
    if (arcs.operates) held += in_work_[give.place];
    if (held - give.taken + give.weight <= options_.bound) continue;
    fault_by_bound(give.place);
    return false;
  }
  return true;
}

[[gnu::always_inline]] inline void NetMachine::take_from(std::uint32_t place, std::uint32_t count) {
  const FiringProgram::PlaceRecord& record = program_.places[place];
  const std::uint32_t before = tokens_[place], now = after(before, count, 0);
  assert(suffices(before, count));
  tokens_[place] = now;
  if (record.sole.valid()) return;
  for (std::uint32_t i = record.first; i < record.last; ++i) {
    const FiringProgram::Consumer& consumer = program_.consumers[i];
    if (suffices(before, consumer.weight) && !suffices(now, consumer.weight))
      status_[consumer.transition] += missing_one;
  }
}

template <class Turns>
[[gnu::always_inline]] inline void NetMachine::give_to(std::uint32_t place, std::uint32_t count,
                                                       Turns& turns) {
  const FiringProgram::PlaceRecord& record = program_.places[place];
  const std::uint32_t before = tokens_[place], now = after(before, 0, count);
  tokens_[place] = now;
  if (record.sole.valid()) {
    if (before == 0) turns.push(record.sole.value);
    return;
  }
  for (std::uint32_t i = record.first; i < record.last; ++i) {
    const FiringProgram::Consumer& consumer = program_.consumers[i];
    std::uint32_t& status = status_[consumer.transition];
    if (!suffices(before, consumer.weight) && suffices(now, consumer.weight)) status -= missing_one;
    if (status != 0) continue;
    status = waiting;
    turns.push(consumer.transition);
  }
}

/// After its firing: it waits for another turn if it is still enabled and does not wait already.
template <class Turns>
[[gnu::always_inline]] inline void NetMachine::wait_again(std::uint32_t transition, Turns& turns) {
  const Hop& hop = program_.hops[transition];
  if (hop.kind != Hop::Kind::general) {
    if (tokens_[hop.from] != 0) turns.push(transition);
  } else if (status_[transition] == 0) {
    status_[transition] = waiting;
    turns.push(transition);
  }
}

template <class Turns>
[[gnu::noinline]] bool NetMachine::try_fire(std::uint32_t transition, Turns& turns) {
  const FiringProgram::Arcs arcs = program_.arcs[transition];
  const bool sole = program_.hops[transition].kind != Hop::Kind::general;
  if (!sole) {
    status_[transition] -= waiting;
    if (status_[transition] != 0) return false;
    if (arcs.condition.valid() && !condition_holds(arcs.condition.value)) {
      if (faulted_) wait_again(transition, turns);  // the condition threw; the next run asks it again
      return false;
    }
  }
  if (!within_bound(arcs)) {
    if (!sole) status_[transition] = waiting;
    turns.push(transition);
    return false;
  }
  for (std::uint32_t arc = arcs.takes; arc < arcs.takes_end; ++arc)
    take_from(program_.takes[arc].place, program_.takes[arc].weight);
  for (std::uint32_t arc = arcs.gives; arc < arcs.gives_end; ++arc) {
    const FiringProgram::Give& give = program_.gives[arc];
    if (program_.places[give.place].operates)
      in_work_[give.place] += give.weight;
    else
      give_to(give.place, give.weight, turns);
  }
  wait_again(transition, turns);
  if (options_.on_firing) options_.on_firing(program_.original_transition[transition]);
  if (arcs.operates) start_operations(arcs, turns);
  return true;
}

// -------------------------------------------------------------------------------------------- the run

template <class Turns>
NetExecutor::Outcome NetMachine::run_with(Turns& turns, std::uint64_t most) {
  NetExecutor::Outcome outcome;
  faulted_ = false;
  const auto ended = [&](NetExecutor::End end) {
    if (end == NetExecutor::End::stopped || faulted_) halt_workers(turns);
    outcome.end = faulted_ ? NetExecutor::End::fault : end;
    if (faulted_) outcome.fault = std::move(fault_);
    return outcome;
  };
  if ((attention_.load(std::memory_order_relaxed) & stop_asked) == 0) start_unstarted(turns);
  for (;;) {
    if (faulted_) return ended(NetExecutor::End::fault);
    const std::uint32_t asked = attention_.exchange(0, std::memory_order_acquire);
    if ((asked & reconsider_asked) != 0) reconsider_conditions(turns);
    if ((asked & operation_finished) != 0) collect_finished(turns);
    if ((asked & stop_asked) != 0) return ended(NetExecutor::End::stopped);
    if (faulted_) continue;
    if (outcome.firings == most) return ended(NetExecutor::End::limit);
    outcome.firings += options_.on_firing ? fire_while_undisturbed<true>(turns, most - outcome.firings)
                                          : fire_while_undisturbed<false>(turns, most - outcome.firings);
    if (faulted_ || attention_.load(std::memory_order_relaxed) != 0 || !turns.empty()) continue;
    if (outcome.firings == most) continue;
    if (submitted_ == 0)
      return ended(some_condition_is_false() ? NetExecutor::End::blocked : NetExecutor::End::dead);
    sleep_until_attention();
  }
}

/// The loop that takes most of the time. `turns` are kept in registers, except for general firings.
template <bool observed, class Turns>
std::uint64_t NetMachine::fire_while_undisturbed(Turns& turns, std::uint64_t most) {
  const Hop* const hops = program_.hops.data();
  std::uint32_t* const tokens = tokens_.data();
  const std::uint32_t bound = options_.bound;
  std::uint64_t firings = 0;
  Turns own = turns;
  while (firings < most && !own.empty() && attention_.load(std::memory_order_relaxed) == 0) {
    const std::uint32_t transition = own.pop();
    const Hop hop = hops[transition];
    if (hop.kind != Hop::Kind::direct) {
      turns = own;
      firings += try_fire(transition, turns) ? 1 : 0;
      own = turns;
      if (faulted_) break;
      continue;
    }
    const std::uint32_t held = tokens[hop.to];
    if (held >= bound) [[unlikely]] {
      own.push(transition);
      fault_by_bound(hop.to);
      break;
    }
    tokens[hop.to] = held + 1;
    if (held == 0) own.push(hop.next);
    if (--tokens[hop.from] != 0) own.push(transition);
    ++firings;
    if constexpr (observed) options_.on_firing(program_.original_transition[transition]);
  }
  turns = own;
  return firings;
}

// -------------------------------------------------------------------------------------------- operations

template <class Turns>
void NetMachine::start_operation(std::uint32_t place, Turns& turns) {
  const ExecutableNet::Place& original = net_.places[program_.original_place[place]];
  if (faulted_) return unstarted_.push_back(place);
  if (original.runs == ExecutableNet::Runs::on_worker) {
    ++submitted_;
    return workers_->submit(place, original.operation);
  }
  try {
    original.operation();
  } catch (...) {
    fault_by(std::current_exception(), "the operation of place", original.name);
    return unstarted_.push_back(place);
  }
  --in_work_[place];
  give_to(place, 1, turns);
}

template <class Turns>
void NetMachine::start_operations(const FiringProgram::Arcs& arcs, Turns& turns) {
  for (std::uint32_t arc = arcs.gives; arc < arcs.gives_end; ++arc)
    if (program_.places[program_.gives[arc].place].operates)
      for (std::uint32_t token = 0; token < program_.gives[arc].weight; ++token)
        start_operation(program_.gives[arc].place, turns);
}

template <class Turns>
void NetMachine::start_unstarted(Turns& turns) {
  for (const std::uint32_t place : std::exchange(unstarted_, {})) start_operation(place, turns);
}

template <class Turns>
void NetMachine::collect_finished(Turns& turns) {
  finished_.clear();
  workers_->collect(finished_);
  submitted_ -= finished_.size();
  for (const WorkerPool::Finished& done : finished_) {
    if (done.thrown) {
      fault_by(done.thrown, "the operation of place", net_.places[program_.original_place[done.place]].name);
      unstarted_.push_back(done.place);
    } else {
      --in_work_[done.place];
      give_to(done.place, 1, turns);
    }
  }
}

template <class Turns>
void NetMachine::halt_workers(Turns& turns) {
  if (workers_ == nullptr) return;
  const std::size_t before = unstarted_.size();
  workers_->halt(unstarted_);
  submitted_ -= unstarted_.size() - before;
  collect_finished(turns);
}

// -------------------------------------------------------------------------------------------- conditions

template <class Turns>
void NetMachine::reconsider_conditions(Turns& turns) {
  for (const std::uint32_t transition : conditional_)
    if (status_[transition] == 0) wait_again(transition, turns);
}

bool NetMachine::some_condition_is_false() const {
  return std::ranges::any_of(conditional_, [this](std::uint32_t t) { return status_[t] == 0; });
}

// -------------------------------------------------------------------------------------------- attention

void NetMachine::call_attention(std::uint32_t bits) {
  attention_.fetch_or(bits, std::memory_order_release);
  attention_.notify_one();
}

void NetMachine::sleep_until_attention() { attention_.wait(0, std::memory_order_acquire); }

void NetMachine::fault_by(std::exception_ptr thrown, const char* what, const std::string& name) {
  if (std::exchange(faulted_, true)) return;  // only the first fault is reported
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const std::exception& exception) {
    fault_ = fmt::format("{} '{}' threw: {}", what, name, exception.what());
  } catch (...) {
    fault_ = fmt::format("{} '{}' threw something that is no std::exception", what, name);
  }
}

void NetMachine::fault_by_bound(std::uint32_t place) {
  if (std::exchange(faulted_, true)) return;
  fault_ = fmt::format("place '{}' would hold more than {} tokens",
                       net_.places[program_.original_place[place]].name, options_.bound);
}

// -------------------------------------------------------------------------------------------- inspection

std::vector<std::uint32_t> NetMachine::marking() const {
  std::vector<std::uint32_t> marking;
  marking.reserve(tokens_.size());
  for (const std::uint32_t place : program_.number_of_place)
    marking.push_back(tokens_[place] + in_work_[place]);
  return marking;
}

bool NetMachine::enabled(std::uint32_t transition) const {
  const Hop& hop = program_.hops[transition];
  return hop.kind == Hop::Kind::general ? status_[transition] <= waiting : tokens_[hop.from] != 0;
}

std::vector<std::uint32_t> NetMachine::enabled() const {
  std::vector<std::uint32_t> transitions;
  for (std::uint32_t t = 0; t < program_.number_of_transition.size(); ++t)
    if (enabled(program_.number_of_transition[t])) transitions.push_back(t);
  return transitions;
}

}  // namespace tessera
