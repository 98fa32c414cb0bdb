// The members of the messages of the control socket. A header of control_messages.cpp alone.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "tessera/control_messages.hpp"

namespace tessera {

/// A member that is `by_need` is left out of a line while it has its default.
enum class Presence : std::uint8_t { always, by_need };
using enum Presence;

// The members of each message and their names in a line. `each` writes them or reads them.

template <class One, class Message>
concept Is = std::same_as<std::remove_const_t<One>, Message>;

void members(Is<Snapshot::MemoryField> auto& one, auto& each) {
  each("name", one.name);
  each("value", one.value);
}

void members(Is<Snapshot::Subsystem> auto& one, auto& each) {
  each("path", one.path);
  each("behaviour", one.behaviour);
  each("calling", one.calling), each("ended", one.ended);
  each("iterations", one.iterations);
  each("firings", one.firings);
  each("overruns", one.overruns);
  each("errors", one.errors);
  each("period_s", one.period_s);
  each("called_at_s", one.called_at_s);
  each("call_s", one.call_s), each("longest_call_s", one.longest_call_s);
  each("slow_calls", one.slow_calls, by_need), each("late_wakeups", one.late_wakeups, by_need);
  each("latest_wakeup_s", one.latest_wakeup_s, by_need);
  each("memory", one.memory, by_need);
}

void members(Is<Snapshot::Channel> auto& one, auto& each) {
  each("name", one.name);
  each("marked", one.marked);
  each("sending_since_s", one.sending_since_s, by_need);
}

void members(Is<Snapshot::Wait> auto& one, auto& each) {
  each("subsystem", one.subsystem);
  each("waits_for", one.waits_for);
  each("channel", one.channel);
  each.word("what", one.for_answer, "value", "answer");
  each("process", one.process, by_need);
  each("since_s", one.since_s);
}

void members(Is<Snapshot::Chain> auto& one, auto& each) {
  each("name", one.name);
  each("members", one.members);
  each("commands", one.commands);
  each("over", one.over);
  each("age_s", one.age_s, by_need);
  each("longest_age_s", one.longest_age_s, by_need);
  each("reaction_s", one.reaction_s, by_need);
  each("longest_reaction_s", one.longest_reaction_s, by_need);
  each("proved_age_s", one.proved_age_s, by_need);
  each("proved_reaction_s", one.proved_reaction_s, by_need);
}

void members(Is<Snapshot::Link> auto& one, auto& each) {
  each("process", one.process);
  each("host", one.host, by_need);
  each("reachable", one.reachable);
  each("since_s", one.since_s);
  each("heard_s", one.heard_s, by_need);
  each("sent", one.sent);
  each("repeated", one.repeated);
  each("received", one.received);
  each("duplicates", one.duplicates);
  each("signs", one.signs);
  each("signs_lost", one.signs_lost);
  each("clock_ahead_s", one.clock_ahead_s, by_need);
  each("clock_uncertainty_s", one.clock_uncertainty_s, by_need);
}

void members(Is<Snapshot::Deployment::Process> auto& one, auto& each) {
  each("name", one.name);
  each("host", one.host, by_need);
}

void members(Is<Snapshot::Deployment> auto& one, auto& each) {
  each("domain", one.domain);
  each("interface", one.interface);
  each("peers", one.peers);
  each("processes", one.processes);
}

void members(Is<Snapshot::Control> auto& one, auto& each) {
  each("paused", one.paused);
  each("pauses", one.pauses);
  each("speed", one.speed);
  each("broke_at", one.broke_at);
}

void members(Is<Snapshot> auto& one, auto& each) {
  each("system", one.system);
  each("pid", one.pid);
  each("net_hash", one.net_hash);
  each("time_s", one.time_s);
  each("recording", one.recording, by_need);
  each("emergency", one.emergency, by_need);
  each("process", one.process, by_need);
  each("host", one.host, by_need);
  each("incarnation", one.incarnation, by_need);
  each("subsystems", one.subsystems);
  each("channels", one.channels);
  each("waits", one.waits);
  each("chains", one.chains, by_need);
  each("links", one.links, by_need);
  each.flat("paused", one.control);
  each("deployment", one.deployment, by_need);
  each("brief", one.brief, by_need);
  each("left_out", one.left_out, by_need);
}

void members(Is<Offered::Value> auto& one, auto& each) {
  each("path", one.path);
  each("value", one.value);
  each("unit", one.unit, by_need);
  each("minimum", one.minimum, by_need);
  each("maximum", one.maximum, by_need);
}

void members(Is<Offered::Panel> auto& one, auto& each) {
  each("path", one.path);
  each("stale_s", one.stale_s);
  each("operated", one.operated);
  each("controls", one.controls);
}

void members(Is<Offered> auto& one, auto& each) {
  each("parameters", one.parameters);
  each("panels", one.panels);
}

void members(Is<PieceHead> auto& one, auto& each) {
  each("recording_bytes", one.bytes);
  each("begins", one.begins);
  each("more", one.more);
}

void members(Is<SceneHead> auto& one, auto& each) {
  each("scene_bytes", one.bytes);
  each("from", one.from);
  each("total", one.total);
}

void members(Is<command::Scene> auto& one, auto& each) { each("from", one.from); }

void members(Is<command::Set> auto& one, auto& each) {
  each("path", one.path);
  each("value", one.value);
  each("try", one.only_try, by_need);
}

void members(Is<command::Panel> auto& one, auto& each) {
  each("path", one.path);
  each("operator", one.who, by_need);
  each("values", one.values, by_need);
}

void members(Is<command::EmergencyStop> auto& one, auto& each) { each("why", one.why, by_need); }

void members(Is<command::StepIteration> auto& one, auto& each) { each("subsystem", one.subsystem, by_need); }

void members(Is<command::Speed> auto& one, auto& each) { each("value", one.value); }

void members(Is<command::Breakpoints> auto& one, auto& each) {
  each("places", one.places, by_need);
  each("transitions", one.transitions, by_need);
  each("conditions", one.conditions, by_need);
}

/// Commands without members.
template <class One>
requires std::is_empty_v<One>
void members(One& /*one*/, auto& /*each*/) {}

}  // namespace tessera
