#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

/// Specifications of fleets for tests and benchmarks: every agent has a control subsystem, a receptor and an
/// effector with two behaviours each, which follow each other for ever whenever they like.
namespace tessera::test {

/// How both ends of a channel behave, producer first.
enum class Mix { async, both_block, receiver_blocks, sender_blocks };
/// Agents alone, in a ring (each control sends to that of the next agent), or in a ring in both directions.
enum class Topology { alone, ring, both_ways };
/// One template and `count`, or every agent and channel written out.
enum class Form { one_template, written_out };

struct Fleet {
  unsigned agents = 1;
  Mix inside = Mix::async;   ///< of the channels within an agent
  Mix between = Mix::async;  ///< of the channels between agents
  Topology topology = Topology::alone;
  Form form = Form::one_template;
  /// In the second behaviour, the control does not use the channels between agents, and
  /// the motor does not receive.
  bool differing = false;
};

inline constexpr std::array<std::string_view, 7> fleet_names{"async",  "bb",       "nb_b", "b_nb",
                                                             "nbring", "bbnbring", "nbbi"};

/// The fleets of docs/inside/performance.md by name; nullopt for another name.
inline std::optional<Fleet> fleet_named(std::string_view name, unsigned agents) {
  const auto fleet = [&](Mix inside, Mix between, Topology topology) {
    return Fleet{.agents = agents, .inside = inside, .between = between, .topology = topology};
  };
  if (name == "async") return fleet(Mix::async, Mix::async, Topology::alone);
  if (name == "bb") return fleet(Mix::both_block, Mix::both_block, Topology::alone);
  if (name == "nb_b") return fleet(Mix::receiver_blocks, Mix::receiver_blocks, Topology::alone);
  if (name == "b_nb") return fleet(Mix::sender_blocks, Mix::sender_blocks, Topology::alone);
  if (name == "nbring") return fleet(Mix::receiver_blocks, Mix::receiver_blocks, Topology::ring);
  if (name == "bbnbring") return fleet(Mix::both_block, Mix::receiver_blocks, Topology::ring);
  if (name == "nbbi") return fleet(Mix::receiver_blocks, Mix::receiver_blocks, Topology::both_ways);
  return std::nullopt;
}

namespace fleet_text {

inline std::string modes(Mix mix) {
  std::string text;
  if (mix == Mix::both_block || mix == Mix::sender_blocks) text += ", send: blocking";
  if (mix == Mix::both_block || mix == Mix::receiver_blocks) text += ", receive: blocking";
  return text;
}

inline std::string channel(const std::string& from, const std::string& to, Mix mix) {
  return "  - { from: \"" + from + "\", to: \"" + to + "\"" + modes(mix) + " }\n";
}

/// used: the channels of the second behaviour, if not all: ", receive: []".
inline std::string behaviours(const std::string& pad, const std::string& value,
                              const std::string& used = {}) {
  return pad + "behaviours:\n" + pad + "  first:  { terminal: " + value + ".v > 1, next: second }\n" + pad +
         "  second: { terminal: " + value + ".v < -1, next: first" + used + " }\n";
}

/// The body of an agent, indented by `pad`.
inline std::string agent(const Fleet& fleet, const std::string& pad) {
  const bool ring = fleet.topology != Topology::alone, both = fleet.topology == Topology::both_ways;
  const std::string in = pad + "  ", deep = pad + "    ";
  std::string text = pad + "control:\n" + in + "rate: 20 Hz\n";
  text += in + "inputs:  { line: Value" + (ring ? ", from_last: Value" : "") +
          (both ? ", from_next: Value" : "") + " }\n";
  text += in + "outputs: { motion: Value" + (ring ? ", to_next: Value" : "") +
          (both ? ", to_last: Value" : "") + " }\n";
  text += behaviours(in, "in.line", fleet.differing ? ", send: [motion], receive: [line]" : "");
  text += pad + "receptors:\n" + in + "sensor:\n" + deep + "rate: 50 Hz\n" + deep +
          "real: { eye: float64 }\n" + deep + "outputs: { line: Value }\n" + behaviours(deep, "out.line");
  text += pad + "effectors:\n" + in + "motor:\n" + deep + "rate: 50 Hz\n" + deep +
          "inputs: { velocity: Value }\n" + deep + "real: { wheel: float64 }\n" + deep +
          "safe: { wheel: 0 }\n" + behaviours(deep, "in.velocity", fleet.differing ? ", receive: []" : "");
  return text;
}

/// The channels of an agent with the given path, and those to the agent after it, if any.
inline std::string channels(const Fleet& fleet, const std::string& path, const std::string& next) {
  std::string text = channel(path + ".sensor.line", path + ".control.line", fleet.inside) +
                     channel(path + ".control.motion", path + ".motor.velocity", fleet.inside);
  if (fleet.topology != Topology::alone)
    text += channel(path + ".control.to_next", next + ".control.from_last", fleet.between);
  if (fleet.topology == Topology::both_ways)
    text += channel(next + ".control.to_last", path + ".control.from_next", fleet.between);
  return text;
}

}  // namespace fleet_text

/// The specification as YAML.
inline std::string fleet_spec(const Fleet& fleet) {
  std::string text = "tessera: 1\nsystem: fleet\ntypes:\n  Value: { v: float64 }\n";
  if (fleet.form == Form::one_template) {
    text += "templates:\n  unit:\n" + fleet_text::agent(fleet, "    ");
    text += "agents:\n  robot: { use: unit, count: " + std::to_string(fleet.agents) +
            (fleet.topology == Topology::alone ? "" : ", ring: true") + " }\nchannels:\n";
    return text + fleet_text::channels(fleet, "robot[i]", "robot[i+1]");
  }
  const auto name = [&](unsigned number) { return "robot_" + std::to_string(number % fleet.agents); };
  text += "agents:\n";
  for (unsigned number = 0; number < fleet.agents; ++number)
    text += "  " + name(number) + ":\n" + fleet_text::agent(fleet, "    ");
  text += "channels:\n";
  for (unsigned number = 0; number < fleet.agents; ++number)
    text += fleet_text::channels(fleet, name(number), name(number + 1));
  return text;
}

/// The same mix inside and between the agents.
inline std::string fleet_spec(unsigned agents, Mix mix, Topology topology, Form form = Form::one_template) {
  return fleet_spec(
      Fleet{.agents = agents, .inside = mix, .between = mix, .topology = topology, .form = form});
}

}  // namespace tessera::test
