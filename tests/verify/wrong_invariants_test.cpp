// A decider that can say nothing leaves every subject of a question open.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "layers/layers.hpp"
#include "layers/properties.hpp"
#include "net/flatten.hpp"
#include "proved.hpp"
#include "spec/parser.hpp"

namespace tessera::verify {
namespace {

/// Two agents; `a` sends under a condition. The property is violated from the start.
std::string with_condition(const std::string& condition) {
  return R"(tessera: 1
system: s
types: { V: { v: float64 } }
agents:
  a:
    control:
      rate: 50 Hz
      inputs: { x: V }
      outputs: { y: V }
      memory: { c: { counts: 0..1 } }
      behaviours: { run: { send: { y: { when: ")" +
         condition + R"(" } }, transfer: parallel } }
  b:
    control:
      rate: 50 Hz
      inputs: { x: V }
      memory: { c: { values: [v0, v1] } }
      behaviours: { run: {} }
channels: [a.control.y -> b.control.x, a.control.y -> a.control.x]
properties: [{ name: no, never: b.control.memory.c == v0 }]
)";
}

TEST(WrongInvariants, ProveNothing) {
  diagnostics::Diagnostics source("spec.yaml", with_condition("memory.c == 1"));
  const auto model = spec::parse(source);
  const auto pages = layers::build(*model, source);
  const auto net = net::flatten(*pages, source);
  const auto properties = layers::properties(*model, *pages, *net, source);
  std::vector<net::Invariant> invariants = layers::invariants(*model, *pages, *net);
  for (net::Invariant& one : invariants) one.terms.front().weight += 1;
  const Report report = prove({*net, &*pages, invariants, *properties}, {});
  for (const PropertyResult& property : report.properties) {
    if (property.name == "no") EXPECT_EQ(property.verdict, Verdict::violated) << property.method;
    if (property.verdict == Verdict::holds) EXPECT_NE(property.explanation, "") << property.name;
  }
}

TEST(WrongInvariants, AreNotDrawnForASendWhoseConditionNeverHolds) {
  const Proved all = proved(with_condition("memory.c == 1 && memory.c != 1"));
  EXPECT_EQ(all["safe"].method, "place invariants");
  EXPECT_EQ(all["safe"].verdict, Verdict::holds);
  EXPECT_EQ(all["no"].verdict, Verdict::violated);
}

}  // namespace
}  // namespace tessera::verify
