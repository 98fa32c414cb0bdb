#include "replay/legality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "layers/models.hpp"
#include "random_run.hpp"

namespace tessera::replay {
namespace {

using net::Arc;
using net::TransitionId;
using Verdict = Legality::Verdict;

Legality check_legal(const Recording& run, const net::Net& net) {
  return replay::check_legal({&run, 1}, net);
}

/// The same run as threads would leave it: each subsystem in its order, in pieces of any size.
Recording as_of_threads(Recording recording, Random& random) {
  std::map<std::uint32_t, std::vector<Recording::Entry>> lanes;
  for (const Recording::Entry& entry : recording.entries) lanes[entry.event.instance()].push_back(entry);
  recording.entries.clear();
  recording.clock = "steady";
  while (!lanes.empty()) {
    const auto lane = std::next(lanes.begin(), static_cast<std::ptrdiff_t>(random() % lanes.size()));
    const std::size_t count = std::min<std::size_t>(lane->second.size(), 1 + random() % 20);
    const auto end = lane->second.begin() + static_cast<std::ptrdiff_t>(count);
    recording.entries.insert(recording.entries.end(), lane->second.begin(), end);
    lane->second.erase(lane->second.begin(), end);
    if (lane->second.empty()) lanes.erase(lane);
  }
  return recording;
}

TEST(Legality, RandomRunsAreLegalInTheirOrderAndAsThreadsWouldLeaveThem) {
  Random random(3);
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const net::Net net = test::build(test::random_model(seed)).net;
    const Recording run = random_run(net, 400, random);
    const Legality as_written = check_legal(run, net);
    EXPECT_EQ(as_written.verdict, Verdict::legal) << seed << ": " << as_written.why;
    EXPECT_EQ(as_written.firings, run.entries.size());
    const Legality merged = check_legal(as_of_threads(run, random), net);
    EXPECT_EQ(merged.verdict, Verdict::legal) << seed << ": " << merged.why;
    EXPECT_EQ(merged.marking, as_written.marking) << seed;
  }
}

/// Leaves one firing out, and numbers the rest as if it had never been.
Recording without(Recording recording, std::size_t left_out) {
  const Event gone = recording.entries[left_out].event;
  recording.entries.erase(recording.entries.begin() + static_cast<std::ptrdiff_t>(left_out));
  for (std::size_t index = left_out; index < recording.entries.size(); ++index)
    if (Event& event = recording.entries[index].event; event.instance() == gone.instance()) --event.sequence;
  return recording;
}

TEST(Legality, ARunWithoutOneOfItsFiringsIsIllegal) {
  Random random(5);
  const net::Net net = test::build(test::line_follower()).net;
  const Recording run = random_run(net, 300, random);
  std::size_t tried = 0;
  for (std::size_t index = 0; index < run.entries.size(); ++index) {
    // No other subsystem depends on the last firing of a subsystem.
    const std::uint32_t instance = run.entries[index].event.instance();
    const bool last =
        std::none_of(run.entries.begin() + static_cast<std::ptrdiff_t>(index) + 1, run.entries.end(),
                     [&](const auto& entry) { return entry.event.instance() == instance; });
    if (last) continue;
    ++tried;
    const Recording shorter = without(run, index);
    EXPECT_EQ(check_legal(shorter, net).verdict, Verdict::illegal) << index;
    EXPECT_EQ(check_legal(as_of_threads(shorter, random), net).verdict, Verdict::illegal) << index;
  }
  EXPECT_GT(tried, 200U);
}

TEST(Legality, AWrongVersionAndAStepBackInTimeAreNamed) {
  Random random(7);
  const net::Net net = test::build(test::line_follower()).net;
  Recording run = random_run(net, 300, random);
  const auto versioned =
      std::ranges::find_if(run.entries, [](const auto& entry) { return entry.event.version == 3; });
  ASSERT_NE(versioned, run.entries.end());
  Recording wrong = run;
  wrong.entries[static_cast<std::size_t>(versioned - run.entries.begin())].event.version = 4;
  EXPECT_NE(check_legal(wrong, net).why.find("it is version 4 of its channel, of which 3 is due"),
            std::string::npos)
      << check_legal(wrong, net).why;
  run.entries.back().event.time_ns = 0;
  EXPECT_NE(check_legal(run, net).why.find("time went back"), std::string::npos);
}

TEST(Legality, MissingEventsLeaveTheRestUndecided) {
  Random random(11);
  const net::Net net = test::build(test::line_follower()).net;
  Recording run = random_run(net, 300, random);
  const auto gone = run.entries.begin() + 150;
  ASSERT_TRUE(std::any_of(gone + 1, run.entries.end(), [&](const auto& entry) {
    return entry.event.instance() == gone->event.instance();
  })) << "nobody could miss it";
  run.entries.erase(gone);
  EXPECT_EQ(check_legal(run, net).verdict, Verdict::incomplete);
  EXPECT_EQ(check_legal(run, net).firings, 150U);
  const Legality merged = check_legal(as_of_threads(run, random), net);
  EXPECT_EQ(merged.verdict, Verdict::incomplete);
  EXPECT_NE(merged.why.find("are missing"), std::string::npos) << merged.why;
}

/// The marking after the first `count` firings, as a segment begins with it.
Recording::Entry marking_after(Recording run, std::size_t count, const net::Net& net) {
  run.entries.resize(count);
  const Legality legality = check_legal(run, net);
  std::string text;
  for (std::size_t place = 0; place < legality.marking.size(); ++place)
    if (legality.marking[place] > 0) text += (text.empty() ? "" : "\n") + net.places()[place].name;
  Event event{.time_ns = run.entries.back().event.time_ns,
              .subject = static_cast<std::uint32_t>(text.size())};
  event.origin = upper_layers << 8 | static_cast<std::uint32_t>(Event::Kind::marking);
  return {event, text};
}

/// The recording of a killed controller: each subsystem's events up to any point.
Recording cut_off(const Recording& run, Random& random) {
  Recording cut = as_of_threads(run, random);
  std::map<std::uint32_t, std::uint32_t> left;
  for (const Recording::Entry& entry : cut.entries) {
    const std::uint32_t instance = entry.event.instance();
    if (!left.contains(instance)) left[instance] = static_cast<std::uint32_t>(random() % 80);
  }
  std::erase_if(cut.entries, [&](const Recording::Entry& entry) {
    std::uint32_t& count = left[entry.event.instance()];
    return count == 0 || count-- == 0;
  });
  cut.truncated = true;
  return cut;
}

TEST(Legality, WhatAKilledControllerLeavesIsNeverIllegal) {
  Random random(19);
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const net::Net net = test::build(test::random_model(seed)).net;
    const Recording run = random_run(net, 400, random);
    for (int cut = 0; cut < 5; ++cut) {
      const Legality legality = check_legal(cut_off(run, random), net);
      EXPECT_EQ(legality.verdict, Verdict::incomplete) << seed << ": " << legality.why;
    }
  }
}

TEST(Legality, ARunOfThreadsThatHasLostEventsIsNeverIllegal) {
  Random random(23);
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const net::Net net = test::build(test::random_model(seed)).net;
    Recording run = as_of_threads(random_run(net, 400, random), random);
    for (std::uint32_t lost = 0; lost < 1 + seed % 20 && !run.entries.empty(); ++lost) {
      run.entries.erase(run.entries.begin() + static_cast<std::ptrdiff_t>(random() % run.entries.size()));
      ++run.lost;
    }
    const Legality legality = check_legal(run, net);
    EXPECT_EQ(legality.verdict, Verdict::incomplete) << seed << ": " << legality.why;
  }
}

/// Each makes something of the event with that number that no run can have left.
const std::map<std::string, std::function<void(Recording&, std::size_t)>> mutations = {
    {"twice",
     [](Recording& run, std::size_t at) {
       run.entries.insert(run.entries.begin() + static_cast<std::ptrdiff_t>(at), run.entries[at]);
     }},
    {"left out", [](Recording& run, std::size_t at) { run = without(run, at); }},
    {"another transition",
     [](Recording& run, std::size_t at) {
       Event& event = run.entries[at].event;
       const std::uint32_t other = (event.subject + 1) % static_cast<std::uint32_t>(run.transitions.size());
       event.subject = other;
     }},
    {"exchanged with the next", [](Recording& run, std::size_t at) {
       const auto same = [&](const Recording::Entry& entry) {
         return entry.event.instance() == run.entries[at].event.instance();
       };
       const auto next =
           std::find_if(run.entries.begin() + static_cast<std::ptrdiff_t>(at) + 1, run.entries.end(), same);
       if (next != run.entries.end()) std::swap(run.entries[at].event.sequence, next->event.sequence);
     }}};

/// Missing its end, its middle or nothing, a run that no net allows is found where what shows it is there.
TEST(Legality, IllegalRunsAreFoundInRecordingsOfThreadsThatAreCutOff) {
  Random random(29);
  const net::Net net = test::build(test::line_follower()).net;
  const Recording run = random_run(net, 400, random);
  for (const auto& [name, mutate] : mutations)
    for (const bool cut : {false, true}) {
      std::size_t tried = 0, found = 0;
      for (std::size_t at = 20; at < 200; ++at) {
        Recording wrong = run;
        mutate(wrong, at);
        wrong.truncated = cut;
        Recording in_order = wrong;
        in_order.truncated = false;
        if (check_legal(in_order, net).verdict == Verdict::legal) continue;  // by chance it is a run
        ++tried;
        found += check_legal(as_of_threads(wrong, random), net).verdict == Verdict::illegal ? 1 : 0;
      }
      EXPECT_GT(tried, 170U) << name;
      // The missing part may be the part that was cut off.
      EXPECT_GE(found, cut ? tried * 3 / 4 : tried) << name << (cut ? ", cut off" : "");
    }
}

TEST(Legality, AfterWhatIsMissingTheNextSegmentIsCheckedFromItsMarking) {
  Random random(31);
  const net::Net net = test::build(test::line_follower()).net;
  const Recording run = random_run(net, 300, random);
  Recording segments = run;
  segments.clock = "steady";
  segments.segment = 0;
  segments.entries.insert(segments.entries.begin() + 150, marking_after(run, 150, net));
  segments.entries.erase(segments.entries.begin() + 70);
  segments.lost = 1;
  EXPECT_EQ(check_legal(segments, net).verdict, Verdict::incomplete) << check_legal(segments, net).why;
  segments.entries[200].event.subject = segments.entries[201].event.subject;
  EXPECT_EQ(check_legal(segments, net).verdict, Verdict::illegal);
}

TEST(Legality, ASegmentIsCheckedFromTheMarkingThatItBeginsWith) {
  Random random(17);
  const net::Net net = test::build(test::line_follower()).net;
  const Recording run = random_run(net, 300, random);
  const Recording::Entry marking = marking_after(run, 150, net), other = marking_after(run, 151, net);
  for (const bool whole : {true, false}) {
    Recording segments = run;
    segments.clock = "steady";
    segments.segment = whole ? 0 : 3;
    segments.entries.insert(segments.entries.begin() + 150, marking);
    if (!whole) segments.entries.erase(segments.entries.begin(), segments.entries.begin() + 150);
    const Legality legal = check_legal(segments, net);
    EXPECT_EQ(legal.verdict, Verdict::legal) << legal.why;
    EXPECT_EQ(legal.firings, whole ? 300U : 150U);
    EXPECT_EQ(legal.marking, check_legal(run, net).marking);
    segments.entries[whole ? 150 : 0] = other;
    const Legality illegal = check_legal(segments, net);
    EXPECT_EQ(illegal.verdict, Verdict::illegal);
    if (whole) {
      EXPECT_NE(illegal.why.find("a segment begins with another marking"), std::string::npos) << illegal.why;
    }
    segments.entries.erase(segments.entries.begin() + (whole ? 150 : 0));
    EXPECT_EQ(check_legal(segments, net).verdict, whole ? Verdict::legal : Verdict::incomplete);
  }
}

TEST(Legality, ARunOfAnotherNetIsIllegal) {
  Random random(13);
  const Recording run = random_run(test::build(test::fleet(2)).net, 100, random);
  const Legality other = check_legal(run, test::build(test::line_follower()).net);
  EXPECT_EQ(other.verdict, Verdict::illegal);
  EXPECT_NE(other.why.find("the net has no subsystem"), std::string::npos) << other.why;
}

TEST(Legality, AHeaderWithNamesThatTheNetHasNotIsIllegal) {
  using Change = std::function<void(Recording&)>;
  Random random(17);
  const test::Built built = test::build(test::line_follower());
  Recording run = random_run(built.net, 100, random);
  run.channels = built.net.parts().channels;
  for (const net::Parts::Subsystem& subsystem : built.net.parts().subsystems)
    run.behaviours.push_back(subsystem.behaviours);
  run.buffers.push_back({run.instances[0] + ".line", 0, Recording::Direction::input, "b"});
  run.scene = Recording::Scene{"", {{"chassis", "robot"}}, {}};
  ASSERT_EQ(check_legal(run, built.net).verdict, Verdict::legal) << check_legal(run, built.net).why;
  const std::string control = run.instances[0];
  const std::vector<std::pair<Change, std::string>> changes{
      {[](Recording& r) { r.instances[0] = "lobot.control"; }, "the net has no subsystem 'lobot.control'"},
      {[](Recording& r) { std::swap(r.instances[0], r.instances[1]); }, ""},
      {[](Recording& r) { r.instances[1] = r.instances[0]; }, "names the subsystem '" + control + "' twice"},
      {[](Recording& r) { r.behaviours[0][0] = "hollow"; }, "no behaviour '" + control + ".hollow'"},
      {[](Recording& r) { r.channels[0] = "a.b.c->d.e.f"; }, "no channel 'a.b.c->d.e.f'"},
      {[](Recording& r) { r.networked = {"x->y"}; }, "no channel 'x->y'"},
      {[](Recording& r) { r.transitions[1] = r.transitions[0]; }, "twice"},
      {[](Recording& r) { r.transitions[0].name = "x"; }, "no transition 'x'"},
      {[](Recording& r) { r.buffers[0].path = "lobot.control.line"; }, "the buffer 'lobot.control.line'"},
      {[](Recording& r) { r.scene->bodies[0].agent = "lobot"; }, "no agent 'lobot'"},
      {[](Recording& r) {
         for (Recording::Transition& one : r.transitions)
           if (one.instance == 0) one.instance = 1;
       },
       "gives the transition"}};
  for (const auto& [change, why] : changes)
    for (const char* const clock : {"simulated", "steady"}) {
      Recording forged = run;
      forged.clock = clock;
      change(forged);
      const Legality judged = check_legal(forged, built.net);
      EXPECT_EQ(judged.verdict, Verdict::illegal) << why;
      EXPECT_NE(judged.why.find(why), std::string::npos) << judged.why;
    }
  Recording stranger = run;
  for (Recording::Entry& entry : stranger.entries)
    if (entry.event.instance() == 0) entry.event.origin += 1U << 8U;
  EXPECT_NE(check_legal(stranger, built.net).why.find("which is no transition of this subsystem"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::replay
