#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <regex>
#include <string>
#include <vector>

/// Two types of the same name and namespace share their constructors when the program is linked, whatever their
/// members are. No compiler or linker says so.
namespace tessera::test {
namespace {

namespace fs = std::filesystem;

/// The names of the types that a header defines in its namespaces, with these.
std::vector<std::string> types_of(const std::string& text) {
  static const std::regex part(
      R"re(//.*|"(?:\\.|[^"\\])*"|\bnamespace\s+([\w:]+)\s*\{|\b(?:struct|class|enum class|enum|union)\s+(\w+)(?:\s+final)?(?:\s*:[^:;{()][^;{()]*)?\s*\{|[{}])re");
  std::vector<std::string> types, open;  // an open brace of no namespace is ""
  for (std::sregex_iterator at(text.begin(), text.end(), part), end; at != end; ++at) {
    const std::smatch& found = *at;
    const std::string all = found.str();
    if (all.starts_with('/') || all.starts_with('"')) continue;
    if (found[2].matched && std::find(open.begin(), open.end(), "") == open.end())
      types.push_back(
          std::accumulate(open.begin(), open.end(), std::string(),
                          [](std::string name, const std::string& space) { return name + space + "::"; }) +
          found[2].str());
    if (all.ends_with('{')) open.push_back(found[1].str());
    if (all == "}" && !open.empty()) open.pop_back();
  }
  return types;
}

TEST(OneDefinition, TheReaderOfHeadersFindsTypes) {
  EXPECT_EQ(types_of("namespace a::b {\n// struct No {\nstruct X;\nstruct Y : Z {\n struct Inner {};\n};\n"
                     "struct Y::Part {};\nenum class E : int { one };\nstd::string s{\"struct Q {\"};\n}\n"
                     "namespace c {\nclass W final {};\n}\n"),
            (std::vector<std::string>{"a::b::Y", "a::b::E", "c::W"}));
}

TEST(OneDefinition, NoTwoHeadersDefineATypeOfTheSameName) {
  std::map<std::string, fs::path> defined;
  for (const char* module : {"cli", "executor", "network", "recording", "ros2", "runtime", "sim", "src",
                             "studio/server", "vocabulary"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TESSERA_SOURCE_DIR) / module)) {
      if (entry.path().extension() != ".hpp") continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      for (const std::string& type : types_of({std::istreambuf_iterator<char>(stream), {}})) {
        const auto [first, is_new] = defined.emplace(type, entry.path());
        EXPECT_TRUE(is_new || first->second == entry.path())
            << type << " is defined in " << first->second << " and in " << entry.path();
      }
    }
  EXPECT_GT(defined.size(), 500U);
}

}  // namespace
}  // namespace tessera::test
