// The life of a goal in the net: a patrol of stations, with recovery, a low battery and a pause.

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>

#include "proved.hpp"

namespace tessera::verify {
namespace {

std::string patrol() {
  std::ifstream file(TESSERA_SOURCE_DIR "/tests/golden/spec/valid/goals.yaml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string with_change(const std::string& from, const std::string& to) {
  std::string text = patrol();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(LifeOfAGoal, ProvesThePatrol) {
  const Proved proof = proved(patrol());
  for (const PropertyResult& one : proof.report.properties)
    EXPECT_EQ(one.verdict, one.name == "a server may vanish" ? Verdict::violated : Verdict::holds)
        << one.name;
}

TEST(LifeOfAGoal, FindsTheStationThatIsTakenForReached) {
  const Proved proof =
      proved(with_change("there: memory.going == succeeded", "there: memory.going != aborted"),
             std::chrono::seconds(20), {"the next station after an arrival alone"});
  EXPECT_EQ(proof["the next station after an arrival alone"].verdict, Verdict::violated);
}

TEST(LifeOfAGoal, FindsTheEndThatNobodyHears) {
  const Proved proof = proved(with_change("dock:\n",
                                          "dock:\n          receive: [battery]\n          next: dock\n"
                                          "        old_dock:\n"),
                              std::chrono::seconds(20), {"an accepted goal ends"});
  EXPECT_EQ(proof["an accepted goal ends"].verdict, Verdict::violated);
}

}  // namespace
}  // namespace tessera::verify
