#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

/// docs/reference/diagnostics.md explains every code that the sources give, and no other.
namespace tessera::test {
namespace {

namespace fs = std::filesystem;
using Codes = std::set<std::string>;

const fs::path root = TESSERA_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Codes codes_of_sources() {
  static const std::regex quoted_code(R"re("([EW]\d{3})")re");
  Codes codes;
  for (const char* module : {"src", "cli", "studio/server"})
    for (const auto& entry : fs::recursive_directory_iterator(root / module)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      const std::string text = text_of(entry.path());
      for (std::sregex_iterator at(text.begin(), text.end(), quoted_code), end; at != end; ++at)
        codes.insert((*at)[1]);
    }
  return codes;
}

/// "| E101 |", "| E410, E411 |", "| E420-E427 |"
Codes codes_of_catalogue() {
  static const std::regex code(R"(([EW])(\d{3})(?:-[EW](\d{3}))?)");
  Codes codes;
  std::ifstream stream(root / "docs/reference/diagnostics.md");
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("| E") && !line.starts_with("| W")) continue;
    const std::string cell = line.substr(2, line.find('|', 2) - 2);
    for (std::sregex_iterator at(cell.begin(), cell.end(), code), end; at != end; ++at) {
      const int first = std::stoi((*at)[2]);
      const int last = (*at)[3].matched ? std::stoi((*at)[3]) : first;
      for (int number = first; number <= last; ++number)
        codes.insert((*at)[1].str() + (number < 100 ? number < 10 ? "00" : "0" : "") +
                     std::to_string(number));
    }
  }
  return codes;
}

TEST(Diagnostics, TheCatalogueHasEveryCodeOfTheSourcesAndNoOther) {
  const Codes given = codes_of_sources(), explained = codes_of_catalogue();
  EXPECT_GT(given.size(), 50U);
  for (const std::string& code : given) EXPECT_TRUE(explained.contains(code)) << code << " is not explained";
  for (const std::string& code : explained) EXPECT_TRUE(given.contains(code)) << code << " is never given";
}

}  // namespace
}  // namespace tessera::test
