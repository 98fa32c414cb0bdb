// The nets of the Model Checking Contest with known answers. They are separate data: the environment
// variable TESSERA_TEST_DATA names the folder that has them in its subfolder "pnml". Without
// it, these tests are skipped.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../environment.hpp"
#include "diagnostics/source.hpp"
#include "explore/explore.hpp"
#include "net/pnml_reader.hpp"

namespace tessera::explore {
namespace {

using Kind = Answer::Kind;

// Without optimisation, the larger ones would take minutes.
#if defined(__OPTIMIZE__)
constexpr std::uint64_t most_markings_counted = sanitized ? 70'000 : 5'000'000;
#else
constexpr std::uint64_t most_markings_counted = 70'000;
#endif

const char* const names[] = {
    "AutoFlight-PT-04a",      "AutonomousCar-PT-02b", "CloudDeployment-PT-3a",  "DES-PT-01a",
    "Kanban-PT-00005",        "Peterson-PT-2",        "Philosophers-PT-000010", "RobotManipulation-PT-00005",
    "SharedMemory-PT-000010", "SimpleLoadBal-PT-05"};

class KnownNets : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("TESSERA_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
    const std::filesystem::path pnml = std::filesystem::path(folder) / "pnml";
    auto source = diagnostics::load(pnml / (std::string(GetParam()) + ".pnml"));
    net_ = net::read_pnml(source);
    ASSERT_TRUE(net_) << render(source);
    std::ifstream answers(pnml / "expected.json");
    ASSERT_TRUE(answers) << "expected.json is missing";
    expected_ = nlohmann::json::parse(answers).at(GetParam());
  }

  std::optional<net::Net> net_;
  nlohmann::json expected_;
};

TEST_P(KnownNets, DeadlockIsAsKnown) {
  // Without a deadlock the search ends only with the reduced graph, which may be all of it.
  if (!expected_.at("deadlock").get<bool>() &&
      expected_.at("states").get<std::uint64_t>() > most_markings_counted)
    GTEST_SKIP() << "too many markings for an unoptimised build";
  const PtNet net(*net_);
  Limits limits;
  limits.time = std::chrono::seconds(300);
  const Answer answer = find_deadlock(net, Formula::never(), limits);
  ASSERT_EQ(answer.kind, expected_.at("deadlock").get<bool>() ? Kind::yes : Kind::no) << answer.why;
  if (answer.kind == Kind::no) return;
  EXPECT_EQ(replay(net, answer.trace.firings), answer.trace.end);
  EXPECT_TRUE(holds(Formula::dead(), net, answer.trace.end));
}

TEST_P(KnownNets, MarkingsEdgesAndSafetyAreAsKnown) {
  const auto markings = expected_.at("states").get<std::uint64_t>();
  if (markings > most_markings_counted) GTEST_SKIP() << markings << " markings are too many for a test";
  const Count counted = count(PtNet(*net_), {});
  ASSERT_TRUE(counted.complete) << counted.why;
  EXPECT_EQ(counted.markings, markings);
  EXPECT_EQ(counted.edges, expected_.at("edges").get<std::uint64_t>());
  EXPECT_EQ(counted.most_tokens <= 1, expected_.at("one_safe").get<bool>());
  if (counted.most_tokens <= 1 && markings > 10'000) {
    EXPECT_LE(counted.effort.bytes, 24 * counted.markings) << "bytes a marking";
  }
}

std::string name_of(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  for (char& letter : name)
    if (letter == '-') letter = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Contest, KnownNets, testing::ValuesIn(names), name_of);

}  // namespace
}  // namespace tessera::explore
