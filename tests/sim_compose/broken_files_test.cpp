// Model files that are cut off or changed at random give a message or a world, never a crash. The models have room
// for few contacts: allocating the 13 MB of the default would take most of the time of these tests.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "../environment.hpp"
#include "files.hpp"

namespace tessera::testing {
namespace {

constexpr std::array<const char*, 7> tried{"rover.xml",  "arm.xml",        "masses.xml", "sections.xml",
                                           "states.xml", "composites.xml", "ground.xml"};

/// A problem has a text. Without a problem, the world has everything that the placement asks for.
void try_text(const std::string& name, const std::string& mjcf) {
  const std::string file = file_with("broken/" + name, mjcf);
  const auto composition = sim::compose(model("world.xml"), {placed("a", file), placed("b", file, 1)});
  if (!composition) {
    EXPECT_FALSE(composition.problem().empty());
    return;
  }
  const auto world = sim::load(*composition);
  EXPECT_TRUE(world || world.problem().size() > 10);
}

void copy_parts() {
  for (const char* part : {"parts/defaults.xml", "parts/body.xml"})
    static_cast<void>(file_with(std::string("broken/") + part, text_of(model(part))));
}

class BrokenFiles : public ::testing::TestWithParam<const char*> {};

TEST_P(BrokenFiles, CutOffAnywhere) {
  copy_parts();
  const std::string text = text_of(model(GetParam()));
  std::mt19937_64 random(1);
  const std::uint64_t runs = from_environment("TESSERA_COMPOSE_RUNS", 30);
  for (std::uint64_t i = 0; i < runs; ++i) try_text(GetParam(), text.substr(0, random() % text.size()));
}

/// The values of all attributes: where each begins and ends.
std::vector<std::pair<std::size_t, std::size_t>> values_in(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> values;
  for (std::size_t at = text.find("=\""); at != std::string::npos; at = text.find("=\"", at)) {
    const std::size_t end = text.find('"', at + 2);
    if (end == std::string::npos) break;
    values.emplace_back(at + 2, end);
    at = end;
  }
  return values;
}

TEST_P(BrokenFiles, WithOtherValues) {
  copy_parts();
  static constexpr std::array<std::string_view, 16> others{
      "",      "0",      "-1",   "nan",  "1e308", "1 2 3 4 5 6 7 8 9", "world", "true", "auto", "xyz", "mesh",
      "a b/c", "&lt;\n", "-0.0", "main", "free"};
  const std::string text = text_of(model(GetParam()));
  const auto values = values_in(text);
  ASSERT_GT(values.size(), 5U);
  std::mt19937_64 random(2);
  const std::uint64_t runs = from_environment("TESSERA_COMPOSE_RUNS", 60);
  for (std::uint64_t i = 0; i < runs; ++i) {
    const auto [begin, end] = values[random() % values.size()];
    std::string changed = text;
    if (random() % 3 == 0) {  // the value of another attribute
      const auto [from, to] = values[random() % values.size()];
      changed.replace(begin, end - begin, text.substr(from, to - from));
    } else {
      changed.replace(begin, end - begin, others[random() % others.size()]);
    }
    try_text(GetParam(), changed);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, BrokenFiles, ::testing::ValuesIn(tried), [](const auto& tested) {
  const std::string name = tested.param;
  return name.substr(0, name.find('.'));
});

}  // namespace
}  // namespace tessera::testing
