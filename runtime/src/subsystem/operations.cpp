#include "subsystem/operations.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "chains/followed_chains.hpp"
#include "system/console.hpp"

namespace tessera {
namespace {

/// 3 for "robot[3].control"; 0 for an agent that is in no fleet.
std::uint32_t index_of_agent(std::string_view path) {
  std::uint32_t index = 0;
  const std::size_t open = path.find('[');
  if (open != std::string_view::npos)
    std::from_chars(path.data() + open + 1, path.data() + path.size(), index);
  return index;
}

}  // namespace

Operations::Operations(SubsystemParts parts, RunControl& control, const Clock& clock, RecordingLane* lane)
    : parts_(std::move(parts)),
      context_(parts_.subsystem->context()),
      control_(control),
      clock_(clock),
      lane_(lane),
      reports_(parts_, control, clock, lane),
      channels_(parts_, control),
      devices_(parts_, channels_, reports_, control, clock, lane),
      written_(parts_),
      goals_(parts_, reports_),
      overtimes_(*parts_.instance, parts_.latency, parts_.processor),
      present_(parts_.instance->net->behaviours) {
  if (!parts_.instance->policies.non_finite_allowed)
    for (const Bindings::Outgoing& output : parts_.bindings.outputs)
      if (output.finite != nullptr) checked_.push_back(&output);
  for (const Bindings::Outgoing& output : parts_.bindings.outputs)
    if (output.skipped != nullptr) skippable_.push_back(&output);
  for (const Fact& fact : parts_.instance->net->facts) {
    KeptCell& kept = kept_.emplace_back();
    if (fact.kind != Fact::Kind::memory) continue;
    for (const Bindings::KeptCell& cell : parts_.bindings.kept)
      if (fact.name.substr(fact.name.find('.') + 1) == cell.name) kept.cell = &cell;
  }
  context_.attach(this);
  context_.period = parts_.instance->period;
  context_.index = index_of_agent(parts_.path);
}

/// Runs user code; false: it threw. No exception of a user passes. activity: comes before the text of the
/// exception.
template <class Code>
bool Operations::survives(Fault fault, std::uint16_t behaviour, std::string_view activity, Code&& code) {
  try {
    std::forward<Code>(code)();
    return true;
  } catch (const abi::__forced_unwind&) {  // the thread ends
    throw;
  } catch (const std::exception& exception) {
    fail_in(fault, behaviour, activity, exception.what());
  } catch (...) {
    fail_in(fault, behaviour, activity, "an exception that is no std::exception");
  }
  return false;
}

void Operations::fail_in(Fault fault, std::uint16_t behaviour, std::string_view activity,
                         std::string_view what) {
  std::array<char, 512> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}{}", activity, what);
  fail(fault, behaviour, {text.data(), std::min(end.size, text.size())});
}

void Operations::fail(Fault fault, std::uint16_t behaviour, std::string_view what) {
  devices_.make_safe_after_fault();  // before the report
  reports_.report(fault, place_of_call(behaviour), what);
  devices_.note_fault(what);
  failed_ = true;
  parts_.subsystem->restore_outputs();
  goals_.write();
  written_.undo();
}

/// The place of the token while that behaviour's transition function runs.
std::string_view Operations::place_of_call(std::uint16_t behaviour) const {
  const SubsystemNet& net = *parts_.instance->net;
  const auto place = std::find_if(net.places.begin(), net.places.end(), [&](const Place& one) {
    return one.does.kind == Does::Kind::call && one.does.subject == behaviour;
  });
  return place == net.places.end() ? net.behaviours[behaviour].name : place->name;
}

// -------------------------------------------------------------------------------------------- calls

void Operations::take_changes(Time now) {
  if (parts_.changes == nullptr) return;
  parts_.changes->take(parts_.index, [&](const std::string& change) {
    if (lane_ != nullptr) lane_->text(Event::Kind::parameter, now, 0, change);
    console::print(LogLevel::info, now, "tessera", change);
  });
}

/// A goal is ordered before anything of the behaviour runs: what comes then is told of the new one.
void Operations::begin_behaviour(std::uint16_t behaviour) {
  if (goals_.empty() || !has_ended_ || std::exchange(begun_, true)) return;
  goals_.begin(behaviour);
}

/// The conditions of the last iteration saw which values were fresh in it.
void Operations::begin_iteration(std::uint16_t behaviour) {
  receives_first_ = true;
  begin_behaviour(behaviour);
  if (calls_ > 0) count();  // the first iteration has number 0
  channels_.mark_seen();
}

void Operations::start_call(std::uint16_t behaviour, Time now, std::uint64_t missed) {
  take_changes(now);
  present_.begin(behaviour, now);
  behaviour_ = behaviour;
  called_at_ = now;
  overtimes_.begin_call(now);
  failed_ = false;
  ++calls_;
  channels_.await_inputs(behaviour);
  parts_.subsystem->keep_outputs();
  begin_behaviour(behaviour);
  goals_.write();
  for (const Bindings::Outgoing* output : skippable_) *output->skipped = false;
  written_.keep();
  context_.now = now;
  context_.iteration = iteration_;
  if (std::exchange(has_ended_, false)) began_at_ = now;
  context_.in_behaviour = now - began_at_;
  if (parts_.values != nullptr) parts_.values->call(now, behaviour, iteration_);
  if (parts_.readings != nullptr) parts_.readings->begin_call(now);
  if (missed > 0) return fail_late(missed);
  if (!parts_.receptors.empty()) {
    const bool read =
        survives(Fault::device, behaviour, "reading a real receptor: ", [&] { read_receptors(now); });
    reading_.store(0, std::memory_order_relaxed);
    if (!read) return;
  }
  refresh_ages(now);
  written_.before_call();
  if (survives(Fault::exception, behaviour, "", [&] { parts_.subsystem->call(behaviour); })) {
    goals_.write();
    written_.after_call();
  }
  check_skips(behaviour);
}

/// A skip without permission is a failure: a receiver may wait for the value.
void Operations::check_skips(std::uint16_t behaviour) {
  for (const Bindings::Outgoing* output : skippable_) {
    if (failed_ || !*output->skipped) continue;
    const auto number = static_cast<std::uint32_t>(output - parts_.bindings.outputs.data());
    Sending sending = Sending::sends;
    if (!survives(Fault::exception, behaviour,
                  "a condition of `send`: ", [&] { sending = parts_.subsystem->sends(behaviour, number); }) ||
        sending == Sending::by_function)
      continue;
    const std::string_view name = parts_.instance->net->behaviours[behaviour].name;
    std::array<char, 256> text;
    const auto end = fmt::format_to_n(
        text.data(), text.size(),
        "out.{0}.skip() in behaviour '{1}', whose `send` does not allow it (write send: {{ {0}: {{ skip: "
        "allowed }} }} there)",
        output->name, name);
    fail(Fault::exception, behaviour, {text.data(), std::min(end.size, text.size())});
  }
}

void Operations::write(std::uint32_t port, std::uint16_t slot, Time now) {
  const std::uint32_t output = parts_.ports[port].buffer;
  const bool valid = !failed_ && written_.has(output);
  channels_.write(port, slot, now, valid);
  if (valid && !goals_.empty()) goals_.note_sent(parts_.bindings.outputs[output].value);
  if (failed_ || written_.has(output) || !written_.should_explain(output)) return;
  const std::string_view name = parts_.bindings.outputs[output].name;
  std::array<char, 256> text;
  const auto end = fmt::format_to_n(
      text.data(), text.size(),
      "output '{}' is sent as invalid: nothing was written to it, or only fields with the values that they "
      "began with (if you mean those, assign the whole: out.{} = {{...}})",
      name, name);
  reports_.log(LogLevel::info, {text.data(), std::min(end.size, text.size())});
}

void Operations::fail_late(std::uint64_t missed) {
  std::array<char, 128> text;
  const auto end =
      fmt::format_to_n(text.data(), text.size(), "its work made it miss {} instant{} of its rate", missed,
                       missed == 1 ? "" : "s");
  fail(Fault::overrun, behaviour_, {text.data(), std::min(end.size, text.size())});
}

void Operations::finish_call(Time now) {
  // Real inputs stay fresh for the conditions of this iteration; the next one reads them again.
  if (!receives_first_) channels_.mark_seen();
  devices_.beat(now, place_of_call(behaviour_));
  check_watchdog(now);
  check_outputs();
  if (overtimes_.fail()) check_overtime(now);  // the devices get no command then
  if (!devices_.none() && !failed_) {
    static_cast<void>(
        survives(Fault::device, behaviour_, "writing a real effector: ", [&] { send_commands(now); }));
    if (overtimes_.fail()) check_overtime(clock_.now());
  }
  if (parts_.readings != nullptr) finish_readings(now);
  if (parts_.values != nullptr) parts_.values->results(now);
  if (overtimes_.judge_calls()) tell_overtime(clock_.now());
}

/// The writing of the devices belongs to the age of a command.
void Operations::finish_readings(Time now) {
  CarriedReadings& readings = *parts_.readings;
  readings.end_call(failed_);
  if (!readings.has_ends()) return;
  const bool given = !failed_ && (devices_.none() || devices_.have_command());
  readings.end_command(
      devices_.none() ? now : clock_.now(), given, failed_, [this](const ChainExcess& excess) {
        std::array<char, 384> room;
        reports_.tell(Fault::overtime, place_of_call(behaviour_), text_of(excess, room), lane_);
      });
}

void Operations::send_commands(Time now) {
  std::array<char, 256> room;
  if (const std::optional<DeviceCommands::Failure> failure =
          devices_.send(now, place_of_call(behaviour_), room))
    fail(failure->fault, behaviour_, failure->what);
}

void Operations::check_watchdog(Time now) {
  const Duration allowed = parts_.instance->policies.watchdog;
  if (allowed == Duration::zero() || failed_ || now - called_at_ <= allowed) return;
  std::array<char, 128> text;
  const auto end =
      fmt::format_to_n(text.data(), text.size(), "took {:.6g} s, and its watchdog allows {:.6g} s",
                       seconds(now - called_at_), seconds(allowed));
  fail(Fault::stall, behaviour_, {text.data(), std::min(end.size, text.size())});
}

void Operations::check_outputs() {
  if (failed_) return;
  for (const Bindings::Outgoing* output : checked_) {
    if (output->finite(output->value)) continue;
    std::array<char, 256> text;
    const auto end = fmt::format_to_n(text.data(), text.size(), "output '{}' is not finite", output->name);
    return fail(Fault::not_finite, behaviour_, {text.data(), std::min(end.size, text.size())});
  }
}

void Operations::read_receptors(Time now) {
  for (const Bindings::Incoming& input : parts_.bindings.real_inputs) input.arrival->fresh = false;
  for (std::size_t index = 0; index < parts_.receptors.size(); ++index) {
    Arrival& arrival = *parts_.bindings.real_inputs[index].arrival;
    reading_.store(static_cast<std::uint32_t>(index) + 1, std::memory_order_relaxed);
    const bool was_valid = std::exchange(arrival.valid, false);
    const bool had_failed = std::exchange(arrival.failed, true);
    const bool read = read_receptor(index, now);  // if it throws, the input has failed
    arrival.valid = read || was_valid;
    arrival.failed = !read && had_failed;
    if (!read) continue;
    arrival.fresh = true;
    arrival.stamp = now;
    arrival.age = Duration::zero();
  }
}

std::string Operations::driver_being_read() const {
  const std::uint32_t reading = reading_.load(std::memory_order_relaxed);
  if (reading == 0) return "";
  const auto driver = std::ranges::find_if(parts_.drivers, [&](const DriverInUse& one) {
    return !one.effector && one.first < reading && reading <= one.first + one.count;
  });
  return fmt::format("read() of {}", driver == parts_.drivers.end() ? parts_.path : driver->path);
}

/// Records the result.
bool Operations::read_receptor(std::size_t index, Time now) {
  using Reading = ValueRecorder::Reading;
  const Bindings::Incoming& input = parts_.bindings.real_inputs[index];
  const std::span<std::byte> value(static_cast<std::byte*>(input.value), input.size);
  if (parts_.values == nullptr) return parts_.receptors[index]->read(value);
  Reading reading = Reading::failed;
  try {
    reading = parts_.receptors[index]->read(value) ? Reading::value : Reading::silent;
  } catch (...) {
    parts_.values->real_input(index, now, reading);
    throw;
  }
  parts_.values->real_input(index, now, reading);
  return reading == Reading::value;
}

void Operations::refresh_ages(Time now) {
  context_.in_behaviour = now - began_at_;
  channels_.refresh_ages(now);
  for (const Bindings::Incoming& input : parts_.bindings.real_inputs)
    if (input.arrival->age != Duration::max()) input.arrival->age = now - input.arrival->stamp;
}

// -------------------------------------------------------------------------------------------- conditions

void Operations::learn(std::uint16_t fact, std::uint16_t value, Time now) {
  channels_.learn(fact, value);
  goals_.learn(fact, value);
  KeptCell& kept = kept_[fact];
  if (kept.cell == nullptr || std::exchange(kept.value, value) == value) return;
  kept.cell->set(kept.cell->value, value);
  if (parts_.values != nullptr) parts_.values->memory(now);
}

Outcome Operations::decide(std::uint16_t behaviour, Time now) {
  refresh_ages(now);
  const ChannelValues::OutcomesShown shown(channels_);
  Outcome outcome = Outcome::error;
  if (!survives(Fault::exception, behaviour,
                "a condition: ", [&] { outcome = parts_.subsystem->decide(behaviour, failed_); }))
    outcome = parts_.subsystem->decide(behaviour, /*failed=*/true);  // no named condition has held
  if (failed_) outcome = Outcome::error;
  accept_outcome(outcome);
  return outcome;
}

void Operations::accept_outcome(Outcome outcome) {
  erroneous_ = outcome == Outcome::error;
  has_ended_ = outcome != Outcome::go_on;
  begun_ = begun_ && !has_ended_;
  if (erroneous_) ++errors_;
}

int Operations::route(std::uint16_t behaviour, Time now) {
  refresh_ages(now);
  const ChannelValues::OutcomesShown shown(channels_);
  int entry = no_entry;
  const bool known = survives(Fault::exception, behaviour, "a condition of `next`: ", [&] {
    entry = parts_.subsystem->route(behaviour, erroneous_);
  });
  return known ? entry : unknown_entry;
}

/// If a condition throws, the iteration has failed. Then the output is sent, as invalid.
bool Operations::sends(std::uint16_t behaviour, std::uint16_t port, Time now) {
  refresh_ages(now);
  const std::uint32_t output = parts_.ports[port].buffer;
  const ChannelValues::OutcomesShown shown(channels_);
  Sending sending = Sending::sends;
  if (!survives(Fault::exception, behaviour,
                "a condition of `send`: ", [&] { sending = parts_.subsystem->sends(behaviour, output); }))
    return true;
  if (sending != Sending::by_function) return sending == Sending::sends;
  const bool skipped = !failed_ && *parts_.bindings.outputs[output].skipped;
  return !skipped && written_.has(output);
}

// -------------------------------------------------------------------------------------------- services

void Operations::report_stall(std::uint16_t behaviour, RecordingLane* lane) const {
  std::array<char, 256> text;
  const std::string driver = driver_being_read();
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}{}has not returned for {:.6g} s", driver,
                                    driver.empty() ? "" : " ", seconds(parts_.instance->policies.watchdog));
  reports_.report(Fault::stall, place_of_call(behaviour), {text.data(), std::min(end.size, text.size())},
                  lane);
}

void Operations::broken(std::string_view assertion) {
  reports_.report(Fault::assertion, place_of_call(behaviour_), assertion);
  std::array<char, 512> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "broken assertion: {}", assertion);
  reports_.fail_run({text.data(), std::min(end.size, text.size())});
}

void Operations::emergency_stop(std::string_view reason) {
  std::array<char, 512> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}: {}", parts_.path, reason);
  control_.begin_emergency({text.data(), std::min(end.size, text.size())});
}

void Operations::stop(std::string_view reason) { control_.request_stop(reason, /*fault=*/false); }

}  // namespace tessera
