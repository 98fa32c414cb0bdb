// Recordings of versions that wrote no roles are read by the names of those versions.
#include <gtest/gtest.h>

#include "replay/statistics.hpp"
#include "replay/timeline.hpp"
#include "tessera/old_names.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {
namespace {

/// A run of 3 s of the controller of tests/words/spec.yaml.
Recording old_recording() {
  std::string error;
  auto read = read_recording(TESSERA_SOURCE_DIR "/tests/golden/recordings/without_roles.tsr", error);
  EXPECT_TRUE(read) << error;
  return read ? std::move(*read) : Recording{};
}

TEST(OldRecording, HasTheStatisticsThatItsVersionTold) {
  const std::vector<SubsystemStatistics> all = statistics_of(old_recording());
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].path, "robot.control");
  EXPECT_EQ(all[0].iterations, 60U);
  EXPECT_EQ(all[0].firings, 770U);
  EXPECT_EQ(all[0].errors, 4U);
  EXPECT_EQ(all[0].skips, 30U);
  EXPECT_EQ(all[1].iterations, 30U);
  EXPECT_EQ(all[2].iterations, 61U);
  EXPECT_EQ(all[3].iterations, 7U);
  EXPECT_EQ(all[3].timeouts, 1U);
  ASSERT_FALSE(all[3].waits.empty());
  EXPECT_EQ(all[3].waits.front().channel, "listen.rcv.note.timeout");
}

TEST(OldRecording, HasATimeline) {
  const Timeline timeline = timeline_of(old_recording());
  ASSERT_EQ(timeline.lanes.size(), 4U);
  const Lane& control = timeline.lanes[0];
  EXPECT_EQ(control.behaviours, (std::vector<std::string>{"init", "follow", "rest"}));
  EXPECT_EQ(control.iterations, 60U);
  EXPECT_EQ(control.errors_s.size(), 4U);
}

struct Named {
  const char* name;
  const char* subsystem;
  Step step;
  const char* behaviour;
};

TEST(OldRecording, NamesTellRoles) {
  const Named names[] = {{"t_in", "", Step::start_system, ""},
                         {"robot[1].t_out", "", Step::end_agent, ""},
                         {"a.b.c->d.e.f.deliver", "", Step::deliver, ""},
                         {"a.b.c->d.e.f.lost", "", Step::lose_older, ""},
                         {"a.b.t_in", "a.b", Step::start, ""},
                         {"a.b.t_go_home_12", "a.b", Step::leave, "go_home"},
                         {"a.b.t_go_home", "a.b", Step::other, ""},
                         {"a.b.run.t1", "a.b", Step::begin_sending, "run"},
                         {"a.b.run.t6", "a.b", Step::error, "run"},
                         {"a.b.run.t9", "a.b", Step::other, "run"},
                         {"a.b.run.snd.t1", "a.b", Step::page, "run"},
                         {"a.b.run.rcv.fork", "a.b", Step::page, "run"},
                         {"a.b.run.snd.x#2.t1o", "a.b", Step::overwrite, "run"},
                         {"a.b.run.rcv.x.skip", "a.b", Step::skip, "run"},
                         {"a.b.run.snd.x.withdraw_m", "a.b", Step::timeout, "run"},
                         {"a.b.run.snd.x.t2", "a.b", Step::transfer, "run"}};
  for (const Named& one : names) {
    const TransitionRole role = role_of_old_name(one.name, one.subsystem);
    EXPECT_EQ(name_of(role.step), name_of(one.step)) << one.name;
    EXPECT_EQ(role.behaviour, one.behaviour) << one.name;
  }
}

}  // namespace
}  // namespace tessera::replay
