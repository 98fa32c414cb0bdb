#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

/// The examples from which `tessera new` makes projects: a function that hangs, or values that stop coming, leave no
/// device moving for long.
namespace tessera::test {
namespace {

using namespace std::chrono_literals;

TEST(NewProjects, BeginWithAWatchdogAndWithEffectorsThatDoNotTrustOldValues) {
  static const std::regex stale(R"(\bstale:\s*(\d+) (m?)s\b)");
  for (const char* example : {"01_line_follower", "05_depot", "08_rover", "09_arm"}) {
    SCOPED_TRACE(example);
    std::ifstream stream(std::filesystem::path(TESSERA_SOURCE_DIR) / "examples" / example / "spec.yaml");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_NE(text.find("watchdog:"), std::string::npos);
    std::smatch found;
    ASSERT_TRUE(std::regex_search(text, found, stale));
    EXPECT_LE(std::stoi(found[1]) * (found[2].length() > 0 ? 1ms : 1s), 3s);
  }
}

}  // namespace
}  // namespace tessera::test
