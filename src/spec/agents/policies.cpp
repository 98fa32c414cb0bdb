#include "spec/agents/policies.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// The index of the word among the choices; the first one after an error, if it is none of them.
std::size_t read_choice(const Entry& entry, const std::vector<std::string>& words, Diagnostics& out) {
  std::string either = words.front();
  for (std::size_t at = 1; at < words.size(); ++at)
    either += (at + 1 == words.size() ? " or " : ", ") + words[at];
  const Node* text = text_of(*entry.value, entry.span, entry.key, out, "write " + either);
  if (text == nullptr) return 0;
  const auto found = std::ranges::find(words, text->text);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  out.error("E104", text->span, entry.key + " must be " + either + ", not " + in_quotes(text->text),
            did_you_mean(text->text, words));
  return 0;
}

/// A whole number from least to most; nullopt after an error, if it is none.
std::optional<std::uint32_t> read_whole(const Entry& entry, std::uint32_t least, std::uint32_t most,
                                        Diagnostics& out) {
  const Node* text = text_of(*entry.value, entry.span, entry.key, out);
  if (text == nullptr) return std::nullopt;
  std::uint32_t value = 0;
  const char* end = text->text.data() + text->text.size();
  const auto [behind, problem] = std::from_chars(text->text.data(), end, value);
  if (problem == std::errc{} && behind == end && value >= least && value <= most) return value;
  out.error("E204", text->span,
            entry.key + " must be a whole number from " + std::to_string(least) + " to " +
                std::to_string(most) + ", not " + in_quotes(text->text));
  return std::nullopt;
}

RealTime read_realtime(const Entry& entry, Diagnostics& out) {
  const Section section(*entry.value, entry.span, "realtime", {"policy", "priority", "cpu"}, out);
  RealTime realtime;
  const Entry* policy = section.find("policy");
  if (policy != nullptr)
    realtime.policy = read_choice(*policy, {"fifo", "round_robin"}, out) == 0 ? RealTime::Policy::fifo
                                                                              : RealTime::Policy::round_robin;
  if (const Entry* priority = section.find("priority"))
    realtime.priority = read_whole(*priority, 1, 99, out).value_or(realtime.priority);
  if (const Entry* cpu = section.find("cpu")) realtime.cpu = read_whole(*cpu, 0, 1023, out);
  return realtime;
}

/// A behaviour and a channel have keys of the same name with other values.
void read_receive(const Section& section, const Entry& receive, Subsystem& subsystem, Diagnostics& out) {
  const Node& value = *receive.value;
  if (value.is_map()) {
    const Section order(value, receive.span, "receive", {"first", "last"}, out);
    if (value.entries.size() != 1)
      out.error("E104", receive.span, "receive has one of 'first' and 'last'",
                "write receive: { first: [A, B] }");
    subsystem.receive_first = order.find("first") != nullptr;
    return;
  }
  if (value.is_sequence()) return;  // of inputs, received last
  if (value.is_scalar() && (value.text == "blocking" || value.text == "non_blocking")) {
    out.error("E104", value.span, "receive must be last or first, not " + in_quotes(value.text),
              "whether a receiver waits is said by its channel: { from: ..., to: ..., receive: blocking }");
    return;
  }
  subsystem.receive_first = read_choice(receive, {"last", "first"}, out) == 1;
  if (section.find("inputs") == nullptr)
    out.error("E110", receive.span, "'receive' belongs to subsystems with inputs",
              "without one there is nothing to receive; real buffers are always read before the function");
}

}  // namespace

const Entry* list_of(const Entry& entry) {
  const Node& value = *entry.value;
  if (value.is_map()) return value.entries.empty() ? nullptr : &value.entries.front();
  return !value.is_sequence() && entry.key == "receive" ? nullptr : &entry;
}

void read_policies(const Section& section, Subsystem& subsystem, Diagnostics& out) {
  if (const Entry* overrun = section.find("overrun")) {
    subsystem.overrun =
        static_cast<Overrun>(read_choice(*overrun, {overrun_names.begin(), overrun_names.end()}, out));
    if (section.find("rate") == nullptr)
      out.error("E110", overrun->span, "'overrun' belongs to subsystems with a rate",
                "without one there is no instant to miss");
  }
  if (const Entry* overtime = section.find("overtime"))
    subsystem.overtime =
        static_cast<Overtime>(read_choice(*overtime, {overtime_names.begin(), overtime_names.end()}, out));
  if (const Entry* receive = section.find("receive")) read_receive(section, *receive, subsystem, out);
  if (const Entry* watchdog = section.find("watchdog"))
    subsystem.watchdog = read_duration(*watchdog->value, watchdog->span, "watchdog", out);
  if (const Entry* recovery = section.find("recovery"))
    subsystem.operator_resets = read_choice(*recovery, {"automatic", "operator"}, out) == 1;
  if (const Entry* non_finite = section.find("non_finite"))
    subsystem.non_finite_allowed = read_choice(*non_finite, {"fault", "allowed"}, out) == 1;
  if (const Entry* realtime = section.find("realtime")) subsystem.realtime = read_realtime(*realtime, out);
}

void check_overtime(const Section& section, const Subsystem& subsystem, Diagnostics& out) {
  const Entry* const overtime = section.find("overtime");
  const auto declares = [](const Behaviour& behaviour) { return behaviour.takes.is_declared(); };
  if (overtime != nullptr && std::ranges::none_of(subsystem.behaviours, declares))
    out.error("E110", overtime->span, "'overtime' belongs to subsystems with a behaviour that has `takes`",
              "without it no call is too long: behaviours: { run: { takes: 1..3 ms } }");
}

}  // namespace tessera::spec
