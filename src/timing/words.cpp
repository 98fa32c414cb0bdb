#include "timing/words.hpp"

#include <fmt/format.h>

namespace tessera::timing {
namespace {

/// round: to a multiple of the step.
template <class Round>
std::string four_digits(Time time, Round round) {
  struct Unit {
    Time ns;
    const char* name;
  };
  for (const Unit unit : {Unit{1'000'000'000, "s"}, Unit{1'000'000, "ms"}, Unit{1'000, "us"}})
    if (time >= unit.ns) {
      Time step = unit.ns / 1000;
      while (time / step >= 10'000) step *= 10;
      return fmt::format(
          "{:g} {}", static_cast<double>(round(time, step) * step) / static_cast<double>(unit.ns), unit.name);
    }
  return fmt::format("{} ns", time);
}

}  // namespace

const char* word_of(Answer answer) {
  switch (answer) {
    case Answer::holds:
      return "holds";
    case Answer::violated:
      return "violated";
    case Answer::unknown:
      return "unknown";
    case Answer::none:
      return "none";
    case Answer::not_asked:
      break;
  }
  return "not_asked";
}

const char* word_of(Step::Kind kind) {
  using Kind = Step::Kind;
  switch (kind) {
    case Kind::next_reading:
      return "next_reading";
    case Kind::network:
      return "network";
    case Kind::foreign:
      return "foreign";
    case Kind::until_read:
      return "until_read";
    case Kind::until_begin:
      return "until_begin";
    case Kind::latency:
      return "latency";
    case Kind::processor:
      return "processor";
    case Kind::takes:
      return "takes";
    case Kind::until_sent:
      break;
  }
  return "until_sent";
}

const char* word_of(Change::Kind kind) {
  using Kind = Change::Kind;
  switch (kind) {
    case Kind::twice_the_rate:
      return "twice_the_rate";
    case Kind::event_driven:
      return "event_driven";
    case Kind::receive_waits:
      return "receive_blocking";
    case Kind::receive_goes_on:
      return "receive_non_blocking";
    case Kind::send_waits:
      return "send_blocking";
    case Kind::send_goes_on:
      return "send_non_blocking";
    case Kind::own_processor:
      break;
  }
  return "own_processor";
}

std::string time_text(Time time) { return four_digits(time, ceil_div); }
std::string least_time_text(Time time) { return four_digits(time, floor_div); }
std::string bound_text(Time time) { return time >= unbounded ? "no bound" : time_text(time); }

}  // namespace tessera::timing
