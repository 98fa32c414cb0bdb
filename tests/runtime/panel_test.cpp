// Panels of operators: refused inputs, the life of an input, and the recording of inputs.
#include "drivers/panel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <limits>
#include <string>

#include "../eventually.hpp"
#include "controlled_run.hpp"
#include "nets.hpp"
#include "rerun/rerun.hpp"
#include "tessera/fields.hpp"
#include "tessera/panel.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

struct PanelArm {
  double lift{};
  bool grip{};
  TESSERA_FIELDS(PanelArm, lift, grip)
};
struct PanelDrive {
  bool horn{};
  BoundedString<8> note;
  std::uint8_t gear{};
  float forward{};
  std::array<double, 2> axes{};
  PanelArm arm;
  TESSERA_FIELDS(PanelDrive, horn, note, gear, forward, axes, arm)
};

constexpr std::int64_t ms = 1'000'000;
std::int64_t panel_now = 0;

/// A panel and its driver on a clock of the test.
class PanelOfTest : public ::testing::Test {
 protected:
  PanelOfTest() {
    panel_now = 1000 * ms;
    const DriverSetup setup("robot.console.drive",
                            {{"controls", "forward -0.5 0.5 m/s; gear 1 5; horn; arm.lift 0 0.2 m; arm.grip"},
                             {"stale", 0.3, "s"}});
    const std::unique_ptr<RealReceptor> made = panel_receptor<PanelDrive>(setup);
    panel_ = dynamic_cast<PanelReceptor&>(*made).panel();
    receptor_.emplace(panel_, value_encoding_of<PanelDrive>(), [] { return panel_now; });
  }
  using Values = std::map<std::string, command::Panel::Value>;
  std::string feed(const Values& values, const std::string& who = "a") {
    return panel_->feed({"robot.console.drive", who, values}, panel_now).value_or(Problem{}).text;
  }
  std::string let_go(const std::string& who = "a") {
    return panel_->feed({"robot.console.drive", who, std::nullopt}, panel_now).value_or(Problem{}).text;
  }
  bool read() { return receptor_->read({reinterpret_cast<std::byte*>(&drive_), sizeof drive_}); }

  std::shared_ptr<Panel> panel_;
  std::optional<PanelReceptor> receptor_;
  PanelDrive drive_;
};

TEST_F(PanelOfTest, HasNoValueBeforeTheFirstInput) {
  drive_.forward = 7;
  EXPECT_FALSE(read());
  EXPECT_EQ(drive_.forward, 7) << "untouched";
}

TEST_F(PanelOfTest, OffersItsControlsWithTheValuesThatCount) {
  const auto shown = [&] {
    const Offered::Panel all = panel_->offered(panel_now);
    std::string text = all.operated ? "operated" : "neutral";
    for (const Offered::Value& one : all.controls) text += "; " + one.path + ' ' + one.value + one.unit;
    return text;
  };
  EXPECT_EQ(shown(), "neutral; forward 0m/s; gear 1; horn false; arm.lift 0m; arm.grip false");
  EXPECT_EQ(feed({{"forward", 0.25}, {"horn", true}, {"gear", 3.0}}), "");
  EXPECT_EQ(shown(), "operated; forward 0.25m/s; gear 3; horn true; arm.lift 0m; arm.grip false");
  const Offered::Panel all = panel_->offered(panel_now);
  EXPECT_EQ(all.controls[0].minimum, -0.5);
  EXPECT_EQ(all.controls[0].maximum, 0.5);
  EXPECT_FALSE(all.controls[2].minimum) << "a bool has no range";
  panel_now += 300 * ms;
  EXPECT_EQ(shown(), "neutral; forward 0m/s; gear 1; horn false; arm.lift 0m; arm.grip false");
}

TEST(ScriptedPanel, GivesItsInputsByTheClockOfTheRunAndTakesNoOthers) {
  const auto made_of = [](const char* script) {
    return panel_receptor<PanelDrive>(DriverSetup(
        "robot.console.drive",
        {{"controls", "forward -0.5 0.5; horn; arm.lift 0 0.2"}, {"stale", 0.3, "s"}, {"script", script}}));
  };
  const std::unique_ptr<RealReceptor> made =
      made_of("500000000 forward 0.25; 2000000000 horn true; 2000000000 forward -0.5; 3000000000 horn false");
  auto& receptor = dynamic_cast<PanelReceptor&>(*made);
  PanelDrive drive;
  const auto read = [&] { return receptor.read({reinterpret_cast<std::byte*>(&drive), sizeof drive}); };
  SimulatedClock clock;
  clock.set(Time(10s));
  EXPECT_FALSE(read()) << "without a clock the script gives nothing";
  clock.set(Time(499ms));
  receptor.follow(clock);
  EXPECT_FALSE(read()) << "no input yet";
  clock.set(Time(500ms));
  EXPECT_TRUE(read());
  EXPECT_EQ(drive.forward, 0.25F);
  clock.set(Time(1999ms));
  EXPECT_TRUE(read()) << "an input counts until the next one, also for longer than `stale`";
  EXPECT_EQ(drive.forward, 0.25F);
  EXPECT_FALSE(drive.horn);
  clock.set(Time(2s));
  EXPECT_TRUE(read());
  EXPECT_TRUE(drive.horn);
  EXPECT_EQ(drive.forward, -0.5F);
  clock.set(Time(9s));
  EXPECT_TRUE(read());
  EXPECT_FALSE(drive.horn);
  EXPECT_EQ(drive.forward, -0.5F);
  EXPECT_EQ(
      receptor.panel()->feed({"robot.console.drive", "a", {{{"forward", 0.1}}}}, 0).value_or(Problem{}).text,
      "the script of the simulation has the panel robot.console.drive");
  EXPECT_THROW(static_cast<void>(made_of("1 forward 7")), DriverError);
  EXPECT_THROW(static_cast<void>(made_of("1 hron true")), DriverError);
  EXPECT_THROW(static_cast<void>(made_of("soon")), DriverError);
}

TEST_F(PanelOfTest, GivesAnInputAndIsNeutralWhenItIsStale) {
  EXPECT_EQ(feed({{"forward", 0.25}, {"horn", true}, {"arm.lift", 0.125}, {"arm.grip", true}, {"gear", 3.0}}),
            "");
  EXPECT_TRUE(read());
  EXPECT_EQ(drive_.forward, 0.25F);
  EXPECT_EQ(drive_.gear, 3);
  EXPECT_TRUE(drive_.horn);
  EXPECT_EQ(drive_.arm.lift, 0.125);
  EXPECT_TRUE(drive_.arm.grip);
  EXPECT_EQ(drive_.note.view(), "");
  panel_now += 299 * ms;
  EXPECT_TRUE(read()) << "it still counts";
  panel_now += 1 * ms;
  EXPECT_TRUE(read()) << "the neutral value is news";
  EXPECT_EQ(drive_.forward, 0);
  EXPECT_EQ(drive_.gear, 1) << "next to zero in its range";
  EXPECT_FALSE(drive_.horn || drive_.arm.grip);
  drive_.forward = 7;
  EXPECT_FALSE(read()) << "once";
  EXPECT_EQ(drive_.forward, 7);
  EXPECT_EQ(feed({{"forward", -0.5}}), "") << "the operator is back";
  EXPECT_TRUE(read());
  EXPECT_EQ(drive_.forward, -0.5F);
}

TEST_F(PanelOfTest, IsNeutralInWhatAnInputDoesNotName) {
  EXPECT_EQ(feed({{"forward", 0.5}}), "");
  EXPECT_EQ(feed({{"horn", true}}), "");
  EXPECT_TRUE(read());
  EXPECT_EQ(drive_.forward, 0);
  EXPECT_TRUE(drive_.horn);
}

TEST_F(PanelOfTest, IsNeutralAtOnceWhenTheOperatorLetsGo) {
  EXPECT_EQ(feed({{"forward", 0.5}}), "");
  EXPECT_TRUE(read());
  EXPECT_EQ(let_go("b"), "") << "this one does not hold it";
  EXPECT_TRUE(read());
  EXPECT_EQ(drive_.forward, 0.5F);
  EXPECT_EQ(let_go(), "");
  EXPECT_TRUE(read());
  EXPECT_EQ(drive_.forward, 0);
  EXPECT_FALSE(read());
}

TEST_F(PanelOfTest, RefusesASecondOperatorWhileTheInputOfTheFirstCounts) {
  EXPECT_EQ(feed({{"forward", 0.5}}), "");
  EXPECT_EQ(feed({{"forward", -0.5}}, "b"), "another operator has the panel robot.console.drive");
  panel_now += 299 * ms;
  EXPECT_NE(feed({{"forward", -0.5}}, "b"), "");
  EXPECT_TRUE(read());
  EXPECT_EQ(drive_.forward, 0.5F);
  panel_now += 1 * ms;
  EXPECT_EQ(feed({{"forward", -0.5}}, "b"), "");
  EXPECT_NE(feed({{"forward", 0.5}}), "") << "now it has the second";
  EXPECT_EQ(let_go("b"), "");
  EXPECT_EQ(feed({{"forward", 0.5}}), "");
}

TEST_F(PanelOfTest, RefusesWhatDoesNotFitAControl) {
  const std::string of = " of the panel robot.console.drive ";
  EXPECT_EQ(feed({{"forward", 0.6}}),
            "'forward'" + of + "goes from -0.5 to 0.5, and 0.6 is out of this range");
  EXPECT_EQ(feed({{"forward", std::numeric_limits<double>::quiet_NaN()}}),
            "'forward'" + of + "is not finite");
  EXPECT_EQ(feed({{"forward", true}}), "'forward'" + of + "is a number");
  EXPECT_EQ(feed({{"horn", 1.0}}), "'horn'" + of + "is true or false");
  EXPECT_EQ(feed({{"gear", 1.5}}), "'gear'" + of + "is a whole number, not 1.5");
  EXPECT_EQ(feed({{"gear", 300.0}}), "'gear'" + of + "goes from 1 to 5, and 300 is out of this range");
  EXPECT_EQ(feed({{"forwart", 0.1}}),
            "the panel robot.console.drive has no control 'forwart'; it has forward, gear, horn, arm.lift, "
            "arm.grip; did you mean 'forward'?");
  EXPECT_NE(feed({{"axes[0]", 0.1}}), "") << "it has no control";
  EXPECT_NE(feed({{"forward", 0.1}}, std::string(65, 'x')), "");
  EXPECT_FALSE(read()) << "nothing of it counts";
}

TEST(PanelDriver, RefusesControlsOfOtherFields) {
  EXPECT_THROW(static_cast<void>(panel_receptor<double>(
                   DriverSetup("a.b.c", {{"controls", "forward 0 1"}, {"stale", 0.3, "s"}}))),
               DriverError);
}

// ------------------------------------------------------------------------------------------- in a run

/// A robot with a panel behind robot.a.sensed.
class Operated : public Controlled {
 protected:
  Operated() {
    build_ = [this](TestSystem& system) {
      system.panel = {{"controls", "value -1 1"}, {"stale", 0.4, "s"}};
      Script script;
      script.senses = true;
      script.call = [this](ScriptState& state) {
        if (state.sensed.valid) state.out_x = state.sensed;
        valid_ = state.sensed.valid;
        seen_ = state.out_x;
        old_ = state.sensed.valid && state.sensed.age > 100ms;
      };
      const std::uint32_t a =
          system.add("robot.a", nets::async_sender, script, 2ms, Duration{0}, Kind::receptor);
      const std::uint32_t b = system.add("robot.b", nets::async_receiver, {}, 2ms);
      system.connect(a, "x", b, "x", asynchronous);
    };
    options_.duration = 600s;
    options_.values = RunOptions::Values::all;
  }
  std::string feed(double value, const char* who = "page") {
    return command({{"command", "panel"},
                    {"path", "robot.a.sensed"},
                    {"operator", who},
                    {"values", {{"value", value}}}});
  }
  void end() {
    kill(getpid(), SIGTERM);
    running_.join();
  }
  std::atomic<double> seen_{0};
  std::atomic<bool> valid_{false}, old_{false};
};

TEST_F(Operated, ByTheControlSocketItMovesAndStopsAndRunsAgainFromTheRecording) {
  options_.clock = RunOptions::Clock::steady;
  start();
  EXPECT_EQ(feed(2), "'value' of the panel robot.a.sensed goes from -1 to 1, and 2 is out of this range");
  EXPECT_EQ(command({{"command", "panel"}, {"path", "robot.a.sent"}, {"values", {{"value", 1}}}}),
            "there is no panel 'robot.a.sent'; did you mean 'robot.a.sensed'?");
  EXPECT_EQ(command({{"command", "panel"}, {"path", "robot.a.sensed"}, {"values", {{"value", "1"}}}}),
            "this is no command");
  EXPECT_FALSE(valid_) << "nothing is valid before the first input";
  EXPECT_EQ(feed(0.75), "");
  EXPECT_TRUE(eventually([&] { return feed(0.75).empty() && seen_ == 0.75; }));
  EXPECT_EQ(feed(0.5, "another page"), "another operator has the panel robot.a.sensed");
  EXPECT_TRUE(eventually([&] { return seen_ == 0; })) << "stale";
  EXPECT_TRUE(eventually([&] { return old_.load(); })) << "no value comes any more";
  EXPECT_EQ(feed(-0.25, "another page"), "");
  EXPECT_TRUE(eventually([&] { return seen_ == -0.25; }));
  EXPECT_EQ(command({{"command", "panel"}, {"path", "robot.a.sensed"}, {"operator", "another page"}}), "");
  EXPECT_TRUE(eventually([&] { return seen_ == 0; })) << "let go";
  end();

  std::string error;
  const auto again = rerun(system_.system(), RunOptions{}, options_.recording, error);
  ASSERT_TRUE(again) << error;
  EXPECT_FALSE(again->first) << again->first->what << ": " << again->first->recorded << ", "
                             << again->first->computed;
}

TEST_F(Operated, InSimulatedTimeThatIsPacedItMovesAndStops) {
  options_.paused = false;
  options_.speed = 1;
  start();
  // Again and again, since a busy machine may look too late at what lasts for half a second.
  EXPECT_TRUE(eventually([&] { return feed(0.75).empty() && seen_ == 0.75; }));
  EXPECT_TRUE(eventually([&] { return seen_ == 0; }));
  EXPECT_TRUE(valid_);
  end();
}

}  // namespace
}  // namespace tessera::testing
