#include "faults.hpp"

#include <algorithm>
#include <stdexcept>

namespace tessera::verify {
namespace {

/// An agent with a control subsystem: input and output buffers, and the body of `behaviours`.
std::string agent(const std::string& name, const std::string& inputs, const std::string& outputs,
                  const std::string& behaviours) {
  std::string text = "  " + name + ":\n    control:\n      rate: 10 Hz\n";
  if (!inputs.empty()) text += "      inputs: { " + inputs + " }\n";
  if (!outputs.empty()) text += "      outputs: { " + outputs + " }\n";
  return text + "      behaviours: { " + behaviours + " }\n";
}

std::string channel(const std::string& from, const std::string& to, const std::string& modes) {
  return "  - { from: " + from + ", to: " + to + (modes.empty() ? "" : ", " + modes) + " }\n";
}

std::string system(const std::string& agents, const std::string& channels,
                   const std::string& templates = "") {
  return "tessera: 1\nsystem: s\ntypes: { V: { v: float64 } }\n" + templates + "agents:\n" + agents +
         "channels:\n" + channels;
}

const std::string both = "send: blocking, receive: blocking";
const std::string receives = "receive: blocking";
const std::string in = "x: V", out = "y: V";

/// Two agents that talk to each other.
std::string pair(const std::string& a, const std::string& b, const std::string& there,
                 const std::string& back) {
  return system(agent("a", in, out, a) + agent("b", in, out, b),
                channel("a.control.y", "b.control.x", there) + channel("b.control.y", "a.control.x", back));
}

/// One agent that sends to another.
std::string line(const std::string& a, const std::string& b, const std::string& modes) {
  return system(agent("a", "", out, a) + agent("b", in, "", b), channel("a.control.y", "b.control.x", modes));
}

std::string ring(const std::string& last) {
  return system(agent("a", in, out, "go: {}") + agent("b", in, out, "go: {}") + agent("c", in, out, "go: {}"),
                channel("a.control.y", "b.control.x", both) + channel("b.control.y", "c.control.x", both) +
                    channel("c.control.y", "a.control.x", last));
}

/// Fifty agents that run freely, and one whose control waits for a sensor.
std::string fleet(const std::string& sensor) {
  const std::string free =
      "templates:\n  unit:\n    control: { rate: 10 Hz, inputs: { x: V }, behaviours: { go: {} } }\n"
      "    receptors: { eye: { rate: 10 Hz, outputs: { y: V }, behaviours: { go: {} } } }\n";
  const std::string odd =
      "  robot: { use: unit, count: 50 }\n  odd:\n"
      "    control: { rate: 10 Hz, inputs: { x: V }, behaviours: { go: {} } }\n"
      "    receptors: { eye: { rate: 10 Hz, outputs: { y: V }, behaviours: { " +
      sensor + " } } }\n";
  return system(odd,
                channel("\"robot[i].eye.y\"", "\"robot[i].control.x\"", "") +
                    channel("odd.eye.y", "odd.control.x", receives),
                free);
}

/// Sends y and then z, to a subsystem that receives z and then y.
std::string crossed(const std::string& transfer) {
  return system(agent("a", "", "y: V, z: V", "go: { send: [y, z] }") +
                    agent("b", "p: V, q: V", "", "go: { receive: [q, p]" + transfer + " }"),
                channel("a.control.y", "b.control.p", both) + channel("a.control.z", "b.control.q", both));
}

/// a to b to c.
std::string relay(const std::string& b) {
  return system(agent("a", "", out, "go: {}") + agent("b", in, out, b) + agent("c", in, "", "go: {}"),
                channel("a.control.y", "b.control.x", "") + channel("b.control.y", "c.control.x", receives));
}

/// Three agents of which the first is given, and the others listen before they tell.
std::string listening_ring(const std::string& first) {
  const std::string listens =
      "hear: { send: [], terminal: true, next: tell }, tell: { receive: [], terminal: true, next: hear }";
  return system(agent("a", in, out, first) + agent("b", in, out, listens) + agent("c", in, out, listens),
                channel("a.control.y", "b.control.x", receives) +
                    channel("b.control.y", "c.control.x", receives) +
                    channel("c.control.y", "a.control.x", receives));
}

/// Four robots of one template, each joined to the next.
std::string circle(const std::string& modes) {
  const std::string unit =
      "templates:\n  unit:\n    control: { rate: 10 Hz, inputs: { x: V }, outputs: { y: V }, "
      "behaviours: { go: {} } }\n";
  return system("  robot: { use: unit, count: 4, ring: true }\n",
                channel("\"robot[i].control.y\"", "\"robot[i+1].control.x\"", modes), unit);
}

std::string two_consumers(const std::string& second) {
  return system(agent("a", "", out, "go: {}") + agent("b", in, "", "go: {}") + agent("c", in, "", second),
                channel("a.control.y", "b.control.x", both) + channel("a.control.y", "c.control.x", both));
}

std::vector<Fault> made() {
  const std::string listens_first =
      "hear: { send: [], terminal: true, next: tell }, tell: { receive: [], terminal: true, next: hear }";
  const std::string tells_first =
      "tell: { receive: [], terminal: true, next: hear }, hear: { send: [], terminal: true, next: tell }";
  const std::string once = "go: { terminal: true, next: end }";
  const std::string again = "go: { next: { to: go, when: error } }";
  const std::string waits_to_start = "init: { send: [], terminal: true, next: run }, run: {}";
  const std::string says_it_starts = "init: { receive: [], terminal: true, next: run }, run: {}";
  const auto handles_error = [](const std::string& handler) {
    return "go: { error: in.x.v < 0, next: [{ to: safe, when: error }, go] }, safe: { " + handler + " }";
  };
  const auto of_author = [](const std::string& text, const std::string& property) {
    return text + "properties:\n  - { name: mine, " + property + " }\n";
  };
  const std::string turns = "go: { terminal: in.x.v > 1, next: wait }, wait: { terminal: true, next: go }";
  return {
      {"two in the workspace at once",
       of_author(pair("enter: {}", "enter: {}", "", ""), "never: a.control.enter.in and b.control.enter.in"),
       of_author(pair("hear: { send: [], terminal: true, next: enter }, enter: { send: [], terminal: true, "
                      "next: tell }, tell: { receive: [], terminal: true, next: hear }",
                      "enter: { send: [], receive: [], terminal: true, next: tell }, tell: { receive: [], "
                      "terminal: true, next: hear }, hear: { send: [], terminal: true, next: enter }",
                      receives, receives),
                 "never: a.control.enter.in and b.control.enter.in"),
       "mine"},
      {"a state that is never left",
       of_author(line("go: {}", "go: { terminal: in.x.v > 1, next: stop }, stop: {}", ""),
                 "always_reachable: b.control.go"),
       of_author(line("go: {}", turns, ""), "always_reachable: b.control.go"), "mine"},
      {"a request without an answer",
       of_author(line("ask: { terminal: true, next: rest }, rest: {}", "wait: {}, grant: {}", ""),
                 "leads_to: [a.control.ask, b.control.grant]"),
       of_author(line("ask: { terminal: true, next: rest }, rest: {}",
                      "wait: { terminal: in.x.v > 1, next: grant }, grant: {}", ""),
                 "leads_to: [a.control.ask, b.control.grant]"),
       "mine"},
      {"crossed blocking receives", pair(listens_first, listens_first, receives, receives),
       pair(tells_first, tells_first, receives, receives), "deadlock_free"},
      {"crossed blocking sends", pair("go: {}", "go: {}", both, both),
       pair("go: {}", "go: {}", both, receives), "deadlock_free"},
      {"a ring that waits on itself", ring(both), ring(receives), "goes_on"},
      {"a behaviour nobody can reach", line("go: {}, lost: {}", "go: {}", ""),
       line("go: { terminal: true, next: lost }, lost: { terminal: true, next: go }", "go: {}", ""),
       "live_behaviours"},
      {"a producer that outwaits a dead consumer", line("go: {}", once, both),
       line("go: {}", once, both + ", send_timeout: 100 ms"), "goes_on"},
      {"a consumer that outwaits a dead producer", line(once, "go: {}", receives),
       line(once, "go: {}", receives + ", timeout: 100 ms"), "goes_on"},
      {"one stuck agent of 51", fleet(once), fleet("go: {}"), "goes_on"},
      {"a starved channel",
       line("go: {}", "first: { terminal: true, next: rest }, rest: { receive: [] }", ""),
       line("go: {}", "first: { terminal: true, next: rest }, rest: {}", ""), "channels_flow"},
      {"a value that is sent only once",
       line("first: { terminal: true, next: rest }, rest: { send: [] }", "go: {}", receives),
       line("first: { terminal: true, next: rest }, rest: {}", "go: {}", receives), "goes_on"},
      {"no initial condition may hold",
       line("go: {}", "go: { terminal: true, next: [{ to: go, when: in.x.v > 1 }] }", ""),
       line("go: {}", "go: { terminal: true, next: [{ to: go, when: in.x.v > 1 }, go] }", ""), "goes_on"},
      {"a request that is taken back", pair("go: {}", "go: {}", both + ", send_timeout: 100 ms", receives),
       pair("go: {}", "go: {}", both + ", send_timeout: 100 ms", receives + ", timeout: 1 s"), "goes_on"},
      {"an error that ends what others wait for", line("go: {}", "go: {}", receives),
       line(again, again, receives), "survives_exceptions"},
      {"receives crossed with sends, sequentially", crossed(""), crossed(", transfer: parallel"),
       "deadlock_free"},
      {"a timeout is missing on both sides", pair(listens_first, listens_first, receives, receives),
       pair(listens_first, listens_first, receives, receives + ", timeout: 100 ms"), "goes_on"},
      {"a relay that ends", relay("go: { terminal: in.x.v > 3, next: end }"),
       relay("go: { terminal: in.x.v > 3, next: go }"), "goes_on"},
      {"both wait to be told that the other has started",
       pair(waits_to_start, waits_to_start, receives, receives),
       pair(waits_to_start, says_it_starts, receives, receives), "deadlock_free"},
      {"a consumer that forgets to acknowledge",
       line("go: {}", "first: { terminal: true, next: rest }, rest: { receive: [] }", both),
       line("go: {}", "first: { terminal: true, next: rest }, rest: {}", both), "goes_on"},
      {"an error that leads to where nobody receives", line("go: {}", handles_error("receive: []"), both),
       line("go: {}", handles_error(""), both), "goes_on"},
      {"a ring in which all listen first", listening_ring(listens_first), listening_ring(tells_first),
       "deadlock_free"},
      {"a fleet that waits in a circle", circle("send: blocking, receive: blocking"),
       circle("receive: blocking"), "deadlock_free"},
      {"a rest from which nobody returns",
       line("talk: { terminal: true, next: rest }, rest: { send: [], terminal: out.y.v > 1, next: rest }",
            "go: {}", receives),
       line("talk: { terminal: true, next: rest }, rest: { send: [], terminal: out.y.v > 1, next: talk }",
            "go: {}", receives),
       "goes_on"},
      {"one of two consumers ends", two_consumers(once), two_consumers("go: {}"), "goes_on"},
      {"two behaviours that only lead to each other",
       line("go: {}", "go: {}, lost: { terminal: true, next: found }, found: { terminal: true, next: lost }",
            ""),
       line("go: {}",
            "go: { terminal: true, next: lost }, lost: { terminal: true, next: found }, "
            "found: { terminal: true, next: lost }",
            ""),
       "live_behaviours"},
      {"a behaviour behind one that never ends", line("go: {}", "go: { next: later }, later: {}", ""),
       line("go: {}", "go: { terminal: in.x.v > 1, next: later }, later: {}", ""), "live_behaviours"},
      {"half of the system ends", line(once, "go: {}", receives), line(once, once, receives),
       "deadlock_free"},
      {"a failure of the consumer stops its producer", line(again, "go: {}", both), line(again, again, both),
       "survives_exceptions"},
      {"a failure that no entry of next names",
       line("go: { terminal: out.y.v > 1, next: go }", again, receives),
       line("go: { terminal: out.y.v > 1, next: [{ to: go, when: error }, go] }", again, receives),
       "survives_exceptions"},
      {"a behaviour that a failure would have to reach without being named",
       line("go: { terminal: out.y.v > 1, next: [{ to: limp, when: false }, go] }, limp: {}", "go: {}", ""),
       line("go: { terminal: out.y.v > 1, next: [{ to: limp, when: out.y.v > 2 }, go] }, limp: {}", "go: {}",
            ""),
       "live_behaviours"},
      {"an answer that is never sent", pair("ask: {}", "go: { send: [] }", both, receives),
       pair("ask: {}", "go: {}", both, receives), "goes_on"},
  };
}

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = made();
  return all;
}

const Fault& fault(const std::string& name) {
  const auto found =
      std::ranges::find(faults(), name, [](const Fault& one) { return std::string(one.name); });
  if (found == faults().end()) throw std::runtime_error("there is no fault '" + name + "'");
  return *found;
}

}  // namespace tessera::verify
