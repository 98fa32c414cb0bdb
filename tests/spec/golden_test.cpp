#include <cstdlib>
#include <filesystem>
#include <set>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const std::string& folder) {
  return fs::path(TESSERA_SOURCE_DIR) / "tests/golden/spec" / folder;
}

std::vector<std::string> specifications(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_of(folder))) {
    if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
  }
  return {names.begin(), names.end()};
}

std::string name_of(const testing::TestParamInfo<std::string>& info) { return info.param; }

class WrongSpecification : public testing::TestWithParam<std::string> {};

/// TESSERA_UPDATE_GOLDEN=1 writes the present messages; read the difference before you keep it.
TEST_P(WrongSpecification, GetsItsDiagnostics) {
  const std::string name = GetParam() + ".yaml";
  diagnostics::Diagnostics out(name, golden("wrong/" + name), folder_of("wrong"));
  EXPECT_FALSE(parse(out).has_value());
  EXPECT_TRUE(out.has_errors());
  const std::string report = render(out);
  if (std::getenv("TESSERA_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(std::string(TESSERA_SOURCE_DIR) + "/tests/golden/spec/wrong/" + GetParam() + ".expected")
        << report;
  }
  EXPECT_EQ(report, golden("wrong/" + GetParam() + ".expected"));
}

INSTANTIATE_TEST_SUITE_P(Golden, WrongSpecification, testing::ValuesIn(specifications("wrong")), name_of);

TEST(Catalogue, ListsEveryCodeThatASpecificationCanGet) {
  const std::string catalogue =
      text_of_file(std::string(TESSERA_SOURCE_DIR) + "/docs/reference/diagnostics.md");
  for (const std::string& name : specifications("wrong")) {
    diagnostics::Diagnostics out(name, golden("wrong/" + name + ".yaml"), folder_of("wrong"));
    EXPECT_FALSE(parse(out).has_value());
    for (const auto& one : out.sorted()) {
      EXPECT_NE(catalogue.find("| " + one.code + " |"), std::string::npos) << one.code << " in " << name;
    }
  }
}

class ValidSpecification : public testing::TestWithParam<std::string> {};

TEST_P(ValidSpecification, HasNoDiagnostics) {
  const Reading reading(golden("valid/" + GetParam() + ".yaml"));
  EXPECT_TRUE(reading.model.has_value());
  EXPECT_EQ(reading.report(), "");
}

TEST_P(ValidSpecification, MeansTheSameWithDosLineEnds) {
  std::string text;
  for (const char c : golden("valid/" + GetParam() + ".yaml"))
    text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const Reading reading(text);
  ASSERT_TRUE(reading.model.has_value()) << reading.report();
  EXPECT_EQ(reading.report(), "");
}

INSTANTIATE_TEST_SUITE_P(Golden, ValidSpecification, testing::ValuesIn(specifications("valid")), name_of);

}  // namespace
}  // namespace tessera::spec
