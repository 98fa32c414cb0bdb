#include "layers/networked.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "layers/layers.hpp"
#include "layers/pair_invariants.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"

namespace tessera::layers {
namespace {

/// "t2: 2 + idle -> wait + sent"
std::vector<std::string> transitions_of(const spec::CommunicationModel& model, const spec::ModelSide& side) {
  std::vector<std::string> lines;
  for (const spec::ModelSide::Transition& transition : side.transitions) {
    std::string line = transition.name + ": " + side.places[transition.from].name;
    for (const std::uint32_t place : transition.takes) line += " + " + model.shared[place].name;
    line += " -> " + side.places[transition.to].name;
    for (const std::uint32_t place : transition.gives) line += " + " + model.shared[place].name;
    lines.push_back(line + (transition.elapsed ? " [elapsed]" : ""));
  }
  return lines;
}

std::vector<std::string> medium_of(const spec::CommunicationModel& model) {
  std::vector<std::string> lines;
  for (const spec::MediumTransition& transition : model.medium) {
    std::string line = transition.name + ":";
    for (const std::uint32_t place : transition.takes) line += " " + model.shared[place].name;
    line += " ->";
    for (const std::uint32_t place : transition.gives) line += " " + model.shared[place].name;
    lines.push_back(line);
  }
  return lines;
}

using Lines = std::vector<std::string>;
constexpr SideMode free_side{false, false}, strict_side{true, false}, patient_side{true, true};

TEST(Networked, ASenderThatDoesNotWaitHasAnyNumberOfValuesOnTheWay) {
  const spec::CommunicationModel model = networked(free_side, strict_side);
  EXPECT_EQ(transitions_of(model, model.send),
            (Lines{"t1: in -> 2", "t2: 2 + idle -> out + sent", "t2n: 2 + sent -> out + more",
                   "t2m: 2 + more -> out + more"}));
  EXPECT_EQ(transitions_of(model, model.receive), (Lines{"t1: in + full -> 2", "t2: 2 -> out + empty"}));
  EXPECT_EQ(medium_of(model), (Lines{"deliver: sent empty -> idle full", "replace: sent full -> idle full",
                                     "older: more empty -> more full", "lost: more -> sent"}));
}

TEST(Networked, ASenderThatWaitsHasOneValueOnTheWay) {
  const spec::CommunicationModel model = networked(strict_side, free_side);
  EXPECT_EQ(transitions_of(model, model.send), (Lines{"t1: in -> 2", "t2: 2 + idle -> wait + sent",
                                                      "t3: wait + idle + empty -> out + idle + empty"}));
  EXPECT_EQ(transitions_of(model, model.receive),
            (Lines{"t1: in + full -> 2", "t2: 2 -> out + empty", "skip: in + empty -> out + empty"}));
  EXPECT_EQ(medium_of(model), (Lines{"deliver: sent empty -> idle full"}));
}

TEST(Networked, ATimeoutOfASenderHasFourEnds) {
  const spec::CommunicationModel model = networked(patient_side, patient_side);
  EXPECT_EQ(transitions_of(model, model.send),
            (Lines{"t1: in -> 2", "t2: 2 + idle -> wait + sent", "t2n: 2 + sent -> wait + more",
                   "t2m: 2 + more -> wait + more", "t3: wait + idle + empty -> out + idle + empty",
                   "timeout: wait -> out [elapsed]", "withdraw: wait + sent -> out + idle [elapsed]",
                   "withdraw_m: wait + more -> out + sent [elapsed]",
                   "recall: wait + idle + full -> out + idle + empty [elapsed]"}));
  EXPECT_EQ(transitions_of(model, model.receive), (Lines{"t1: in + full -> 2", "t2: 2 -> out + empty",
                                                         "timeout: in + empty -> out + empty [elapsed]"}));
  EXPECT_EQ(medium_of(model).size(), 4U);
}

TEST(Networked, NothingJoinsTwoSidesThatNeverWait) {
  const spec::CommunicationModel model = networked(free_side, free_side);
  EXPECT_EQ(transitions_of(model, model.send),
            (Lines{"t1: in + sent_memory -> 2", "t2: 2 -> out + sent_memory"}));
  EXPECT_EQ(transitions_of(model, model.receive),
            (Lines{"t1: in + received_memory -> 2", "t2: 2 -> out + received_memory"}));
  EXPECT_TRUE(model.medium.empty());
}

TEST(Networked, EveryFormHasAnInvariantForWhatIsOnTheWayAndOneForTheSlot) {
  for (const SideMode send : {free_side, strict_side, patient_side})
    for (const SideMode receive : {free_side, strict_side, patient_side}) {
      std::size_t units = 0;
      for (const PairInvariant& invariant : pair_invariants(networked(send, receive)))
        units += invariant.is_unit() ? 1 : 0;
      EXPECT_EQ(units, 2U);
    }
}

std::string system(const std::string& deployment) {
  return R"(tessera: 1
system: pair
agents:
  a:
    control:
      rate: 10 Hz
      outputs: { y: float64, z: float64 }
      inputs: { w: float64 }
      behaviours: { run: { transfer: parallel } }
  b:
    control:
      rate: 10 Hz
      inputs: { x: float64, z: float64 }
      outputs: { w: float64 }
      behaviours: { run: {} }
channels:
  - { from: a.control.y, to: b.control.x, send: blocking, timeout: 1 s }
  - a.control.z -> b.control.z
  - { from: b.control.w, to: a.control.w, receive: blocking }
)" + deployment;
}

struct Built {
  spec::Model model;
  net::HierarchicalNet pages;
  net::Net flat;
};

Built built(const std::string& deployment) {
  diagnostics::Diagnostics out("pair.yaml", system(deployment));
  std::optional<spec::Model> model = spec::parse(out);
  EXPECT_TRUE(model) << diagnostics::render(out);
  auto pages = build(*model, out);
  auto flat = net::flatten(*pages, out);
  return {std::move(*model), std::move(*pages), std::move(*flat)};
}

constexpr const char* apart = "deploy: { processes: { left: a, right: b } }\n";
constexpr const char* together = "deploy: { processes: { both: [a, b] } }\n";

TEST(Networked, TheMediumBelongsToNoSubsystemAndTouchesOneChannel) {
  const Built deployed = built(apart);
  std::size_t medium = 0;
  for (std::uint32_t index = 0; index < deployed.flat.transitions().size(); ++index) {
    const net::Transition& transition = deployed.flat.transitions()[index];
    if (!is_of_medium(transition.role)) continue;
    ++medium;
    EXPECT_FALSE(transition.subsystem.valid());
    EXPECT_TRUE(deployed.flat.channel_of({index}).valid());
    for (const net::Arc& arc : deployed.flat.preset({index})) EXPECT_TRUE(deployed.flat[arc.place].fused());
  }
  EXPECT_EQ(medium, 8U) << "four for each of the two channels at which a side waits";
}

TEST(Networked, ADeploymentIntoOneProcessIsTheNetWithoutDeployment) {
  const auto names = [](const net::Net& net) {
    Lines all;
    for (const net::Place& place : net.places()) all.push_back(place.name);
    for (const net::Transition& transition : net.transitions()) all.push_back(transition.name);
    return all;
  };
  EXPECT_EQ(names(built(together).flat), names(built("").flat));
  EXPECT_NE(names(built(apart).flat), names(built("").flat));
}

TEST(Networked, InProcessesOfTheirOwnMemoriesAreGuardedByTheTokensOfTheSubsystems) {
  const Built deployed = built(apart);
  const auto all = invariants(deployed.model, deployed.pages, deployed.flat);
  EXPECT_EQ(std::ranges::count_if(all,
                                  [](const net::Invariant& invariant) {
                                    return invariant.name.find("by the branches that send a.control.z") !=
                                           std::string::npos;
                                  }),
            1);
}

}  // namespace
}  // namespace tessera::layers
