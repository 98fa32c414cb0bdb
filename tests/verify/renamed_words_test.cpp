// Names are for people: a word that the layers write into names may change, without any effect except on the
// names themselves.
#include <gtest/gtest.h>

#include "faults.hpp"
#include "layers/layers.hpp"
#include "layers/properties.hpp"
#include "net/flatten.hpp"
#include "renamed.hpp"
#include "spec/parser.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/counterexample/narrative.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {
namespace {

/// All that is said of a net, a line each.
std::string told_of(const net::Net& net, const Report& report) {
  std::string text;
  for (const PropertyResult& property : report.properties) {
    text += property.name + " " + std::to_string(static_cast<int>(property.verdict)) + " " + property.method +
            " " + property.why + " " + property.meaning + " " + property.explanation + "\n";
    for (const SubsystemAtEnd& wait : property.waits) text += wait.text + "\n";
    for (const PropertyResult::Behaviour& behaviour : property.behaviours) text += behaviour.path + "\n";
    const Assume assume = property.exceptions ? Assume::exceptions : Assume::conditions;
    for (const Act& act : narrate(abstract_net(net, assume), property.trace))
      text += act.who + " " + act.text + "\n";
  }
  return test::without_strange_words(text);
}

void judge_renamed(const std::string& text) {
  diagnostics::Diagnostics source("spec.yaml", text);
  const auto model = spec::parse(source);
  const auto pages = model ? layers::build(*model, source) : std::nullopt;
  ASSERT_TRUE(pages) << render(source);
  const net::HierarchicalNet other_pages = test::renamed(*pages);
  const auto net = net::flatten(*pages, source), other = net::flatten(other_pages, source);
  ASSERT_TRUE(net && other) << render(source);
  const auto properties = layers::properties(*model, *pages, *net, source);
  ASSERT_TRUE(properties) << render(source);
  const std::vector<net::Invariant> invariants = layers::invariants(*model, *pages, *net);
  const std::vector<net::Invariant> others = layers::invariants(*model, other_pages, *other);
  ProveOptions options;
  options.time = std::chrono::seconds(20);
  const Report report = prove({*net, &*pages, invariants, *properties}, options);
  const Report renamed = prove({*other, &other_pages, others, *properties}, options);
  EXPECT_NE(report.net_hash, renamed.net_hash) << "the names are part of the net's identity";
  EXPECT_EQ(told_of(*net, report), told_of(*other, renamed));
}

TEST(RenamedWords, ChangeNoVerdictAndNoStory) {
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.name);
    judge_renamed(fault.faulty);
    judge_renamed(fault.corrected);
  }
}

}  // namespace
}  // namespace tessera::verify
