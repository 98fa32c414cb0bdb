#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include "../environment.hpp"
#include "deployed_run.hpp"
#include "layers/models.hpp"
#include "naive_legality.hpp"
#include "net/token_game.hpp"
#include "replay/legality.hpp"

namespace tessera::replay {
namespace {

using Verdict = Legality::Verdict;
using test::B;
using test::N;

/// Two to three agents and a few channels of all modes between them and within them.
spec::Model small_model(std::mt19937& engine) {
  const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
  test::ModelBuilder builder;
  const std::uint32_t agents = 2 + random() % 2;
  std::vector<spec::ChannelEnd> outputs, inputs;
  for (std::uint32_t agent = 0; agent < agents; ++agent) {
    std::vector<spec::Subsystem> parts;
    const std::uint32_t count = 1 + random() % 5 / 4;
    for (std::uint32_t part = 0; part < count; ++part) {
      spec::Behaviour first = test::behaviour("first", {0});
      if (random() % 3 == 0) first.transfer = spec::Transfer::parallel;
      first.next.front().behaviour = random() % 4 == 0 ? spec::BehaviourId{} : spec::BehaviourId{0};
      parts.push_back(test::subsystem(spec::SubsystemKind::receptor, "s" + std::to_string(part), {"p", "q"},
                                      {"p", "q"}, {first}));
    }
    const spec::InstanceId first = builder.agent("a" + std::to_string(agent), std::move(parts));
    for (std::uint32_t part = 0; part < count; ++part)
      for (const spec::BufferId buffer : Ids<spec::BufferId>(2)) {
        outputs.push_back({{first.value + part}, buffer});
        inputs.push_back({{first.value + part}, buffer});
      }
  }
  std::ranges::shuffle(inputs, engine);
  const std::size_t count = 1 + random() % 3;
  for (std::size_t number = 0; number < std::min(count, inputs.size()); ++number) {
    const spec::ChannelEnd& to = inputs[number];
    const spec::ChannelEnd& from = outputs[random() % outputs.size()];
    if (from.instance == to.instance) continue;
    spec::Channel& channel = builder.channel(from, to);
    channel.send = random() % 2 == 0 ? N : B;
    channel.receive = random() % 2 == 0 ? N : B;
    if (channel.send == B && random() % 2 == 0) channel.send_timeout = std::chrono::milliseconds(10);
    if (channel.receive == B && random() % 2 == 0) channel.receive_timeout = std::chrono::milliseconds(10);
  }
  return builder.result();
}

TEST(DeployedLegality, RandomRunsOfDeployedSystemsAreLegal) {
  std::mt19937 random(3);
  std::size_t networked = 0;
  for (std::uint32_t seed = 0; seed < share_of(150); ++seed) {
    const Deployed system = each_apart(seed % 2 == 0 ? test::random_model(seed) : small_model(random));
    const std::vector<Recording> run = deployed_run(system, 600, random);
    EXPECT_EQ(cannot_be_joined(run, system.processes), std::nullopt);
    const Legality judged = check_legal(run, system.net, system.processes);
    EXPECT_EQ(judged.verdict, Verdict::legal) << seed << ": " << judged.why;
    std::size_t firings = 0;
    for (const Recording& one : run)
      for (const Recording::Entry& entry : one.entries) {
        firings += entry.event.kind() == Event::Kind::firing ? 1 : 0;
        networked += entry.event.kind() == Event::Kind::peer ? 1 : 0;
      }
    EXPECT_EQ(judged.firings, firings) << seed;
    const Recording simulated = simulated_run(system, 600, random);
    const Legality in_order = check_legal({&simulated, 1}, system.net, system.processes);
    EXPECT_EQ(in_order.verdict, Verdict::legal) << seed << ": " << in_order.why;
    EXPECT_EQ(in_order.firings, simulated.entries.size()) << seed;
  }
  EXPECT_GT(networked, share_of(100)) << "channels between processes were used";
}

void renumber(Recording& recording) {
  std::map<std::uint32_t, std::uint32_t> sequences;
  for (Recording::Entry& entry : recording.entries)
    entry.event.sequence = sequences[entry.event.instance()]++;
}

/// Each makes something of the event with that number that is seldom a run.
const std::map<std::string, std::function<void(Recording&, std::size_t, std::mt19937&)>> mutations = {
    {"left out",
     [](Recording& run, std::size_t at, std::mt19937&) {
       run.entries.erase(run.entries.begin() + static_cast<std::ptrdiff_t>(at));
     }},
    {"exchanged with the next",
     [](Recording& run, std::size_t at, std::mt19937&) {
       if (at + 1 < run.entries.size()) std::swap(run.entries[at], run.entries[at + 1]);
     }},
    {"another number",
     [](Recording& run, std::size_t at, std::mt19937& random) {
       if (run.entries[at].event.kind() == Event::Kind::firing)
         run.entries[at].event.version += random() % 2 == 0 ? 1U : UINT32_MAX;
     }},
    {"another transition",
     [](Recording& run, std::size_t at, std::mt19937& random) {
       const Event other = run.entries[random() % run.entries.size()].event;
       Event& event = run.entries[at].event;
       if (event.kind() == Event::Kind::firing && other.kind() == Event::Kind::firing &&
           other.instance() == event.instance())
         event.subject = other.subject;
     }},
    {"moved",
     [](Recording& run, std::size_t at, std::mt19937& random) {
       const std::size_t to = random() % run.entries.size();
       const auto from = run.entries.begin() + static_cast<std::ptrdiff_t>(at);
       const auto target = run.entries.begin() + static_cast<std::ptrdiff_t>(to);
       from < target ? std::rotate(from, from + 1, target) : std::rotate(target, from, from + 1);
     }},
    {"repeated", [](Recording& run, std::size_t at, std::mt19937&) {
       run.entries.insert(run.entries.begin() + static_cast<std::ptrdiff_t>(at), run.entries[at]);
     }}};

/// TESSERA_DEPLOYED_RUNS=2000 asks for more. The naive search tries all orders of all firings and all firings of the media.
TEST(DeployedLegality, AgreesWithTheSearchOfAllOrdersOnRunsAndOnMutatedOnes) {
  std::mt19937 random(7);
  std::map<bool, std::size_t> verdicts;
  const std::uint64_t runs = from_environment("TESSERA_DEPLOYED_RUNS", share_of(30));
  for (std::uint32_t seed = 0; seed < runs; ++seed) {
    const Deployed system = each_apart(small_model(random));
    const std::vector<Recording> run = deployed_run(system, 40, random);
    EXPECT_TRUE(naive_legality(run, system.net)) << seed;
    for (const auto& [name, mutate] : mutations) {
      std::vector<Recording> wrong = run;
      Recording& changed = wrong[random() % wrong.size()];
      if (changed.entries.empty()) continue;
      mutate(changed, random() % changed.entries.size(), random);
      renumber(changed);
      const bool possible = naive_legality(wrong, system.net);
      const Legality judged = check_legal(wrong, system.net, system.processes);
      EXPECT_EQ(judged.verdict, possible ? Verdict::legal : Verdict::illegal)
          << seed << ", " << name << ": " << judged.why;
      ++verdicts[possible];
    }
  }
  EXPECT_GT(verdicts[true], share_of(10));
  EXPECT_GT(verdicts[false], share_of(50));
}

/// A simulated run in which the order alone tells what came first.
Recording timeless_run(const Deployed& system, std::size_t firings, std::mt19937& random) {
  Recording run = simulated_run(system, firings, random);
  for (Recording::Entry& entry : run.entries) entry.event.time_ns = 0;
  return run;
}

/// The part of a simulated run that a limit leaves: it begins with the marking at this entry, in which nobody
/// knows the places between the processes.
Recording left_by_a_limit(const Deployed& system, Recording run, std::size_t from) {
  const DeployedNet deployed(system.net, system.processes);
  std::map<std::string, net::TransitionId> by_name;
  for (std::uint32_t index = 0; index < system.net.transitions().size(); ++index)
    by_name[system.net.transitions()[index].name] = {index};
  net::Marking marking = net::initial_marking(system.net);
  for (std::size_t at = 0; at < from; ++at) {
    const Event& event = run.entries[at].event;
    if (event.kind() != Event::Kind::firing) continue;
    const net::TransitionId id = by_name.at(run.transitions[event.subject].name);
    for (const net::Arc& arc : system.net.preset(id))
      if (!deployed.is_hidden(arc.place)) marking[arc.place.value] -= arc.weight;
    for (const net::Arc& arc : system.net.postset(id))
      if (!deployed.is_hidden(arc.place)) marking[arc.place.value] += arc.weight;
  }
  Recording::Entry begins{
      .event = {.origin = system_instance << 8U | static_cast<std::uint32_t>(Event::Kind::marking)},
      .text = {}};
  for (std::uint32_t place = 0; place < marking.size(); ++place)
    if (marking[place] > 0 && !deployed.is_hidden({place}))
      begins.text += (begins.text.empty() ? "" : "\n") + system.net.places()[place].name;
  begins.event.subject = static_cast<std::uint32_t>(begins.text.size());
  run.entries.erase(run.entries.begin(), run.entries.begin() + static_cast<std::ptrdiff_t>(from));
  run.entries.insert(run.entries.begin(), std::move(begins));
  run.segment = 1;
  return run;
}

TEST(DeployedLegality, ASimulatedRunIsJudgedFromTheMarkingThatALimitLeaves) {
  std::mt19937 random(23);
  std::size_t found = 0, mutated = 0;
  for (std::uint32_t seed = 0; seed < share_of(60); ++seed) {
    const Deployed system = each_apart(seed % 2 == 0 ? test::random_model(seed) : small_model(random));
    const Recording whole = timeless_run(system, 300, random);
    if (whole.entries.size() < 100) continue;
    for (std::size_t from : {whole.entries.size() / 3, whole.entries.size() / 2}) {
      const Recording run = left_by_a_limit(system, whole, from);
      const Legality judged = check_legal({&run, 1}, system.net, system.processes);
      EXPECT_EQ(judged.verdict, Verdict::legal) << seed << ": " << judged.why;
      EXPECT_EQ(judged.firings, whole.entries.size() - from) << seed;
      for (const auto& [name, mutate] : mutations) {
        Recording wrong = whole;
        mutate(wrong, from + random() % (wrong.entries.size() - from - 20), random);
        renumber(wrong);
        if (check_legal({&wrong, 1}, system.net, system.processes).verdict == Verdict::legal) continue;
        if (name == "moved") continue;  // perhaps to a place before
        const Recording rest = left_by_a_limit(system, wrong, from);
        found += check_legal({&rest, 1}, system.net, system.processes).verdict == Verdict::illegal ? 1 : 0;
        ++mutated;
      }
    }
  }
  // Only what needs a number, or a token between the processes, from before the marking is missed.
  EXPECT_GT(found, mutated * 9 / 10) << mutated;
}

/// Whatever mutation the whole run allows, the rest of it allows.
TEST(DeployedLegality, WhatIsLegalAsAWholeIsLegalFromEachMarkingOn) {
  std::mt19937 random(29);
  std::size_t legal = 0;
  for (std::uint32_t seed = 0; seed < share_of(100); ++seed) {
    const Deployed system = each_apart(small_model(random));
    const Recording whole = timeless_run(system, 60, random);
    for (std::size_t from = 1; from < whole.entries.size(); from += 3) {
      Recording other = whole;
      mutations.at("exchanged with the next")(other, random() % other.entries.size(), random);
      renumber(other);
      if (check_legal({&other, 1}, system.net, system.processes).verdict != Verdict::legal) continue;
      ++legal;
      const Recording rest = left_by_a_limit(system, other, from);
      const Legality judged = check_legal({&rest, 1}, system.net, system.processes);
      EXPECT_EQ(judged.verdict, Verdict::legal) << seed << ", " << from << ": " << judged.why;
    }
  }
  EXPECT_GT(legal, share_of(100));
}

TEST(DeployedLegality, WithoutAMarkingARunWithoutItsBeginningIsIncomplete) {
  std::mt19937 random(31);
  const Deployed system = each_apart(test::fleet(2));
  Recording run = simulated_run(system, 100, random);
  run.segment = 1;
  const Legality judged = check_legal({&run, 1}, system.net, system.processes);
  EXPECT_EQ(judged.verdict, Verdict::incomplete);
  EXPECT_EQ(judged.why, "its beginning is gone, and the marking after that is not known");
  EXPECT_EQ(judged.firings, 0U);
  std::vector<Recording> processes = deployed_run(system, 100, random);
  processes[1].segment = 1;
  EXPECT_EQ(check_legal(processes, system.net, system.processes).why,
            "p1: its beginning is gone, and the marking after that is not known");
}

TEST(DeployedLegality, AFiringOfAnotherProcessOrSubsystemIsIllegal) {
  std::mt19937 random(13);
  const Deployed system = each_apart(test::fleet(2));
  const std::vector<Recording> run = deployed_run(system, 200, random);
  std::vector<Recording> wrong = run;
  wrong[0].entries.push_back(run[1].entries.front());
  renumber(wrong[0]);
  const Legality other = check_legal(wrong, system.net, system.processes);
  EXPECT_EQ(other.verdict, Verdict::illegal);
  EXPECT_NE(other.why.find("which is no transition of this process"), std::string::npos) << other.why;
  wrong = run;
  Event& event = wrong[0].entries.back().event;
  event.origin = (event.instance() == 0 ? 1U : 0U) << 8 | static_cast<std::uint32_t>(Event::Kind::firing);
  renumber(wrong[0]);
  EXPECT_NE(check_legal(wrong, system.net, system.processes).why.find("no transition of this subsystem"),
            std::string::npos);
}

TEST(DeployedLegality, RecordingsThatDoNotBelongTogetherAreRefused) {
  std::mt19937 random(17);
  const Deployed system = each_apart(test::fleet(2));
  std::vector<Recording> run = deployed_run(system, 50, random);
  const auto refused = [&](const std::vector<Recording>& recordings) {
    return cannot_be_joined(recordings, system.processes).value_or("they can be joined");
  };
  EXPECT_EQ(refused({run[0], run[0]}), "two of them are of 'p0' in the same start (incarnation 1); give one");
  EXPECT_EQ(refused({run[0], simulated_run(system, 50, random)}),
            "one of them is of a whole system, which is judged alone; give recordings of processes only");
  std::vector<Recording> renamed = run;
  renamed[1].process->name = "p7";
  EXPECT_EQ(refused(renamed), "the specification deploys no process 'p7' with number 1");
  EXPECT_EQ(check_legal({run.data(), 1}, system.net, system.processes).why,
            "no recording of p1 is given: what it did is assumed");
  run[1].truncated = true;
  EXPECT_EQ(check_legal(run, system.net, system.processes).why, "the recording of p1 is cut off at its end");
}

}  // namespace
}  // namespace tessera::replay
