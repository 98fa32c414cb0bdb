#include "system/repeated_lines.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace tessera {
namespace {

TEST(RepeatedLines, TheFirstThreeAndThePowersOfTenArePrinted) {
  const auto lines = std::make_unique<RepeatedLines>();
  std::vector<std::uint64_t> printed;
  for (int number = 1; number <= 120; ++number)
    if (const auto turn = lines->next(1, "robot.motor", "limited to " + std::to_string(number) + " m/s");
        turn.printed)
      printed.push_back(turn.count);
  EXPECT_EQ(printed, (std::vector<std::uint64_t>{1, 2, 3, 10, 100}));
  int told = 0;
  lines->tell_left_out([&](std::string_view path, std::string_view text, std::uint64_t left_out) {
    ++told;
    EXPECT_EQ(path, "robot.motor");
    EXPECT_EQ(text, "limited to 1 m/s");
    EXPECT_EQ(left_out, 20);
  });
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(lines->next(1, "robot.motor", "limited to 7 m/s").printed) << "counts begin anew";
}

TEST(RepeatedLines, OtherTextsPathsAndLevelsAreOtherKinds) {
  const auto lines = std::make_unique<RepeatedLines>();
  for (int number = 0; number < 5; ++number)
    static_cast<void>(lines->next(1, "robot[1].motor", "late by 3 ms"));
  EXPECT_FALSE(lines->next(1, "robot[1].motor", "late by 4 ms").printed);
  EXPECT_TRUE(lines->next(1, "robot[2].motor", "late by 3 ms").printed);
  EXPECT_TRUE(lines->next(2, "robot[1].motor", "late by 3 ms").printed);
  EXPECT_TRUE(lines->next(1, "robot[1].motor", "early by 3 ms").printed);
}

TEST(RepeatedLines, TheDigitsOfANameTellItFromOthers) {
  const auto lines = std::make_unique<RepeatedLines>();
  for (int robot = 0; robot < 20; ++robot) {
    const std::string number = std::to_string(robot);
    EXPECT_TRUE(lines->next(1, "tessera", "waits for robot[" + number + "].control (1.0 s)").printed)
        << robot;
    EXPECT_TRUE(lines->next(1, "tessera", "joint_" + number + " does not obey").printed) << robot;
  }
}

TEST(RepeatedLines, MoreKindsThanThereIsRoomForArePrinted) {
  const auto lines = std::make_unique<RepeatedLines>();
  const auto text = [](int kind) { return std::string(static_cast<std::size_t>(kind + 1), 'x'); };
  for (int round = 0; round < 6; ++round)
    for (int kind = 0; kind < 200; ++kind) {
      const bool printed = lines->next(1, "a", text(kind)).printed;
      EXPECT_TRUE(printed || kind < 128) << kind;
    }
}

TEST(RepeatedLines, AreCountedByThreadsTogether) {
  const auto lines = std::make_unique<RepeatedLines>();
  std::atomic<std::uint64_t> printed{0};
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread)
      threads.emplace_back([&] {
        for (int number = 0; number < 250; ++number)
          if (lines->next(1, "a", "b").printed) ++printed;
      });
  }
  EXPECT_EQ(printed, 6) << "1, 2, 3, 10, 100, 1000";
}

}  // namespace
}  // namespace tessera
