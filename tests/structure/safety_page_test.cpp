#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

/// Each promise of docs/reference/safety.md names a test that exists.
namespace tessera::test {
namespace {

namespace fs = std::filesystem;

std::set<std::string> tests_of_sources() {
  static const std::regex declared(R"(\bTEST(?:_F|_P)?\((\w+), (\w+)\))");
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TESSERA_SOURCE_DIR) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (std::sregex_iterator at(text.begin(), text.end(), declared), end; at != end; ++at)
      names.insert((*at)[1].str() + "." + (*at)[2].str());
  }
  return names;
}

TEST(SafetyPage, EachRowOfWhatIsPromisedNamesATestThatExists) {
  const std::set<std::string> tests = tests_of_sources();
  static const std::regex last_cell(R"(\| (?:`(\w+\.\w+)`|the same) \|$)");
  std::ifstream stream(fs::path(TESSERA_SOURCE_DIR) / "docs/reference/safety.md");
  std::size_t rows = 0;
  bool inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("## ")) inside = line == "## What is promised";
    if (!inside || !line.starts_with("| ") || line.starts_with("| Event |")) continue;
    std::smatch cell;
    ASSERT_TRUE(std::regex_search(line, cell, last_cell)) << line;
    EXPECT_TRUE(!cell[1].matched || tests.contains(cell[1])) << cell[1] << " of the row: " << line;
    EXPECT_TRUE(rows++ > 0 || cell[1].matched) << line;
  }
  EXPECT_GT(rows, 15U);
}

}  // namespace
}  // namespace tessera::test
