// Specifications with one mistake each, and their corrected twins.

#include <gmock/gmock.h>

#include <algorithm>

#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"
#include "verify/verify.hpp"

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

struct Fault {
  const char* name;
  std::string faulty, corrected;
  const char* property;
};

std::vector<Fault> faults() {
  const std::string listens_first =
      "hear: { send: [], terminal: true, next: tell }, tell: { receive: [], terminal: true, next: hear }";
  const std::string tells_first =
      "tell: { receive: [], terminal: true, next: hear }, hear: { send: [], terminal: true, next: tell }";
  const std::string once = "go: { terminal: true, next: end }";
  return {
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
       line("go: { next: go }", "go: { next: go }", receives), "survives_exceptions"},
  };
}

struct Proved {
  net::Net net;
  Report report;

  [[nodiscard]] const PropertyResult& operator[](const std::string& name) const {
    return *std::ranges::find(report.properties, name, &PropertyResult::name);
  }
};

Proved proved(const std::string& text) {
  diagnostics::Diagnostics source("spec.yaml", text);
  const auto model = spec::parse(source);
  const auto pages = model ? layers::build(*model, source) : std::nullopt;
  auto net = pages ? net::flatten(*pages, source) : std::nullopt;
  if (!net) throw std::runtime_error(render(source) + text);
  ProveOptions options;
  options.time = std::chrono::seconds(20);
  Report report = prove({*net, &*pages, layers::invariants(*model, *pages, *net)}, options);
  return {std::move(*net), std::move(report)};
}

TEST(Faults, AreFoundAndTheirCorrectedTwinsPass) {
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.name);
    const Proved faulty = proved(fault.faulty);
    const PropertyResult& bad = faulty[fault.property];
    EXPECT_EQ(bad.verdict, Verdict::violated) << bad.method << ": " << bad.why;
    EXPECT_NE(bad.why, "");
    if (std::string(fault.property) != "live_behaviours") {
      EXPECT_TRUE(bad.has_trace) << bad.why;
      EXPECT_FALSE(bad.waits.empty() && std::string(fault.property) != "channels_flow") << bad.why;
    }
    const Proved corrected = proved(fault.corrected);
    const PropertyResult& good = corrected[fault.property];
    EXPECT_EQ(good.verdict, Verdict::holds) << good.method << ": " << good.why;
  }
}

TEST(Faults, OneStuckAgentIsNoDeadlock) {
  const Proved fleet_of_51 = proved(fleet("go: { terminal: true, next: end }"));
  EXPECT_EQ(fleet_of_51["deadlock_free"].verdict, Verdict::holds);
  EXPECT_EQ(fleet_of_51["goes_on"].verdict, Verdict::violated);
  EXPECT_THAT(
      fleet_of_51["goes_on"].waits,
      testing::Contains(testing::HasSubstr("odd.control waits for a value of odd.eye.y->odd.control.x")));
}

TEST(Faults, AWarningIsNoViolation) {
  const Proved pair = proved(line("go: {}", "go: {}", receives));
  EXPECT_EQ(pair["survives_exceptions"].verdict, Verdict::violated);
  EXPECT_EQ(pair.report.overall(), Verdict::holds);
}

TEST(Faults, AStoppedProofSaysSo) {
  const std::atomic<bool> stop{true};
  net::Net net;
  net::Place place;
  place.name = "p";
  place.tokens = 1;
  net.add(place);
  net::Transition loop;
  loop.name = "t";
  const std::vector<net::Arc> arcs{{net::PlaceId{0}, 1}};
  net.add(loop, arcs, arcs);
  ProveOptions options;
  options.stop = &stop;
  options.only = {"safe"};
  const std::vector<net::Invariant> none;
  const Report report = prove({net, nullptr, none}, options);
  ASSERT_EQ(report.properties.size(), 1U);
  EXPECT_EQ(report.properties[0].verdict, Verdict::unknown);
  EXPECT_EQ(report.properties[0].why, "it was interrupted");
}

}  // namespace
}  // namespace tessera::verify
