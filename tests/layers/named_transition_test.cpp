// The reader of names in recordings knows what the layers draw: it agrees with the roles and conditions of
// every transition of a subsystem.
#include "tessera/named_transition.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "diagnostics/source.hpp"
#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"

namespace tessera::layers {
namespace {

using Kind = NamedTransition::Kind;
using Condition = net::Condition::Kind;

bool calculates(const net::Net& net, net::TransitionId id) {
  for (const net::Arc& arc : net.preset(id))
    if (net[arc.place].operation.kind == net::Operation::Kind::transition_function) return true;
  return false;
}

Kind drawn_as(const net::Net& net, net::TransitionId id) {
  const net::Transition& transition = net[id];
  if (transition.layer == net::Layer::communication) return Kind::communication;
  if (transition.layer == net::Layer::subsystem)
    return transition.role == net::TransitionRole::start ? Kind::start : Kind::leave;
  if (transition.condition.kind == Condition::go_on) return Kind::go_on;
  if (transition.condition.kind == Condition::terminal) return Kind::terminal;
  if (transition.condition.kind == Condition::error) return Kind::error;
  return calculates(net, id) ? Kind::begin_iteration : Kind::other;
}

TEST(NamedTransition, AgreesWithTheRolesOfWhatTheLayersDraw) {
  std::set<Kind> met;
  const std::filesystem::path root = TESSERA_SOURCE_DIR;
  for (const char* folder : {"examples", "tests/golden/spec/valid"})
    for (const auto& file : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (file.path().extension() != ".yaml") continue;
      diagnostics::Diagnostics source = diagnostics::load(file.path());
      const auto model = spec::parse(source);
      ASSERT_TRUE(model) << diagnostics::render(source);
      const auto pages = build(*model, source);
      const auto net = pages ? net::flatten(*pages, source) : std::nullopt;
      if (!net) continue;  // not every valid file has a net
      for (std::uint32_t index = 0; index < net->transitions().size(); ++index) {
        const net::Transition& transition = net->transitions()[index];
        if (!transition.subsystem.valid()) continue;
        const net::Parts::Subsystem& owner = net->parts()[transition.subsystem];
        const NamedTransition read = named_transition(transition.name, owner.path);
        EXPECT_EQ(read.kind, drawn_as(*net, {index})) << transition.name;
        met.insert(read.kind);
        if (transition.behaviour.valid()) {
          EXPECT_EQ(read.behaviour, owner.behaviours[transition.behaviour.value]) << transition.name;
        }
        EXPECT_EQ(read.overwrite, transition.role == net::TransitionRole::overwrite) << transition.name;
        EXPECT_EQ(read.skip, transition.role == net::TransitionRole::skip) << transition.name;
      }
    }
  EXPECT_EQ(met.size(), 8U) << "some kind of transition was not met";
}

}  // namespace
}  // namespace tessera::layers
