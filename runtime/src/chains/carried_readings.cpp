#include "chains/carried_readings.hpp"

#include <algorithm>

namespace tessera {
namespace {

[[nodiscard]] std::int64_t ns_of(Time time) { return time.time_since_epoch().count(); }

[[nodiscard]] bool is_power_of_ten(std::uint64_t number) {
  while (number > 1 && number % 10 == 0) number /= 10;
  return number == 1;
}

}  // namespace

CarriedReadings::CarriedReadings(const Layout& layout, std::size_t ports)
    : held_(layout.readings, none),
      readings_(layout.readings, none),
      arrivals_(ports),
      departures_(ports),
      begun_(layout.begun) {
  for (const Layout::Arrival& arrival : layout.arrivals)
    arrivals_[arrival.port] = {arrival.first, arrival.count};
  for (const Layout::Departure& departure : layout.departures) {
    departures_[departure.port] = {static_cast<std::uint32_t>(sources_.size()),
                                   static_cast<std::uint32_t>(departure.readings.size())};
    sources_.insert(sources_.end(), departure.readings.begin(), departure.readings.end());
  }
  for (const Layout::End& end : layout.ends) ends_.push_back({end.reading, end.member});
  // The subsystem may have started again.
  for (ChainMember* const member : begun_) member->gauges.first_reading_ns = AgeGauges::none;
}

void CarriedReadings::end_call(bool failed) {
  if (failed) return;
  std::ranges::copy(held_, readings_.begin());
  // The channel that the value goes through makes this visible to the end of the chain.
  for (ChainMember* const member : begun_)
    if (member->gauges.first_reading_ns.load(std::memory_order_relaxed) == AgeGauges::none)
      member->gauges.first_reading_ns.store(ns_of(readings_[0]), std::memory_order_relaxed);
}

/// An event just after a reading is the worst one. Its reaction ends with the first command that reflects a later
/// reading. If that command is not given, the event has none.
void CarriedReadings::end_command(Time now, bool given, bool failed,
                                  const std::function<void(const ChainExcess&)>& tell) {
  for (End& end : ends_) {
    const Time reading = failed ? held_[end.reading] : readings_[end.reading];
    if (reading == none) continue;
    AgeGauges& gauges = end.member->gauges;
    if (end.reflected == none) {
      const std::int64_t first = gauges.first_reading_ns.load(std::memory_order_relaxed);
      end.reflected = first == AgeGauges::none ? reading : Time(Duration(first));
    }
    const bool is_newer = reading > end.reflected;
    const Time event = end.reflected;
    if (is_newer) end.reflected = reading;
    if (!given) continue;
    const Duration age = now - reading, reaction = is_newer ? now - event : Duration::zero();
    gauges.commands.fetch_add(1, std::memory_order_relaxed);
    gauges.add_age(age.count());
    if (is_newer) gauges.add_reaction(reaction.count());
    const Chain& chain = *end.member->chain;
    const bool is_old = chain.age > Duration::zero() && age > chain.age;
    const bool is_slow = chain.reaction > Duration::zero() && reaction > chain.reaction;
    if (!is_old && !is_slow) continue;
    if (is_power_of_ten(gauges.over.fetch_add(1, std::memory_order_relaxed) + 1))
      tell({end.member, !is_old, is_old ? age : reaction});
  }
}

}  // namespace tessera
