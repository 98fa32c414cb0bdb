#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "generated.hpp"

namespace tessera::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Agents in a row; an output feeds several channels, input and output share a name.
std::string fleet(int count, bool ring) {
  return "tessera: 1\nsystem: fleet\ntemplates:\n  walker:\n    control:\n      rate: 10 Hz\n"
         "      inputs: { token: bool, order: bool }\n      outputs: { token: bool }\n      behaviours: { "
         "walk: {} }\n"
         "agents:\n  robot: { use: walker, count: " +
         std::to_string(count) + ", ring: " + (ring ? "true" : "false") +
         " }\n"
         "  base: { control: { rate: 10 Hz, outputs: { order: bool }, behaviours: { send: {} } } }\n"
         "channels:\n  - robot[i].control.token -> robot[i+1].control.token\n"
         "  - \"base.control.order -> robot[*].control.order\"\n";
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(LocalNet, AgentsOfARingShareOneNet) {
  const Generated generated = generate(fleet(7, true));
  EXPECT_EQ(count(generated["walker.control.cpp"], "tessera::SubsystemNet net"), 1U);
  EXPECT_EQ(count(generated["system.cpp"], "&units::walker::control::net, "), 7U);
}

TEST(LocalNet, TheEndsOfARowDiffer) {
  const Generated generated = generate(fleet(7, false));
  const std::string& source = generated["walker.control.cpp"];
  EXPECT_EQ(count(source, "tessera::SubsystemNet net"), 3U);
  EXPECT_THAT(source, HasSubstr("// The net of robot[0].control.\n"));
  EXPECT_THAT(source, HasSubstr("// The net of robot[1].control and 4 more.\n"));
  EXPECT_THAT(source, HasSubstr("// The net of robot[6].control.\n"));
  EXPECT_EQ(count(generated["system.cpp"], "&units::walker::control::net_2, "), 5U);
}

/// The net calls behaviours by their number, so the table keeps their order, however wide it is.
TEST(LocalNet, BehavioursThatTakeTimeKeepTheirNumbers) {
  const std::vector<std::string> names{"at_the_beginning", "a_while",           "in_between",
                                       "another_while",    "nearly_at_the_end", "at_the_end"};
  std::string behaviours;
  for (std::size_t at = 0; at < names.size(); ++at)
    behaviours += "        " + names[at] + ": { " + (names[at].ends_with("while") ? "takes: 10 ms, " : "") +
                  "terminal: true, next: " + names[(at + 1) % names.size()] + " }\n";
  const Generated generated = generate(
      "tessera: 1\nsystem: table\nagents:\n  robot:\n    control:\n      rate: 10 Hz\n"
      "      behaviours:\n" +
      behaviours);
  const std::string& source = generated["robot.control.cpp"];
  std::size_t at = source.find("tessera::Behaviour behaviours[]");
  const std::size_t end = source.find("};", source.find('\n', at));
  ASSERT_NE(at, std::string::npos);
  for (const std::string& name : names) {
    at = source.find("{\"" + name + '"', at);
    EXPECT_LT(at, end) << name << " in\n" << source.substr(source.find("behaviours[]"), 400);
  }
}

TEST(LocalNet, AnInputAndAnOutputOfOneNameAreDifferentPorts) {
  const Generated generated = generate(fleet(3, true));
  EXPECT_THAT(generated["walker.control.cpp"],
              HasSubstr("{\"snd.token\", tessera::Side::send,    \"token\"},\n"));
  EXPECT_THAT(generated["walker.control.cpp"],
              HasSubstr("{\"rcv.token\", tessera::Side::receive, \"token\"},\n"));
  EXPECT_THAT(generated["system.cpp"], HasSubstr("{0, 0}, {1, 1}, memory_channel},\n"));
}

TEST(LocalNet, OfASubsystemThatReceivesFirstBeginsWithItsReceive) {
  std::string text = fleet(3, true);
  text.replace(text.find("      rate: 10 Hz\n"), 18, "      rate: 10 Hz\n      receive: first\n");
  const Generated generated = generate(text);
  std::string table = generated["walker.control.cpp"];
  for (std::size_t at = table.find("  "); at != std::string::npos; at = table.find("  ")) table.erase(at, 1);
  for (const char* row : {R"({"walk.in", tessera::begins(0)})", R"({"walk.2", tessera::calls(0)})",
                          R"({"walk.snd.out", tessera::decides(0)})",
                          R"({tessera::Step::begin_receiving, 0}}, // walk.in -> walk.rcv.in)",
                          R"({tessera::Step::end_receiving, 0}}, // walk.rcv.out -> walk.2)",
                          R"({tessera::Step::begin_sending, 0}}, // walk.2 -> walk.snd.in)",
                          R"(tessera::if_go_on, {tessera::Step::go_on, 0}}, // walk.snd.out -> walk.in)",
                          R"({tessera::Step::terminal, 0}}, // walk.snd.out -> walk.out)",
                          R"({tessera::Step::error, 0}}, // walk.snd.out -> walk.out)"})
    EXPECT_THAT(table, HasSubstr(row));
  EXPECT_THAT(table, Not(HasSubstr("counts()")));
}

TEST(LocalNet, EachChannelOfAnOutputHasItsPort) {
  const Generated generated = generate(fleet(3, true));
  EXPECT_THAT(generated["base.control.cpp"], HasSubstr("{\"order#3\", tessera::Side::send, \"order\"},\n"));
  EXPECT_THAT(generated["system.cpp"], HasSubstr("{3, 2}, {2, 2}, memory_channel},\n"));
}

TEST(LocalNet, AChannelThatNobodyUsesHasNoRow) {
  const std::string text = fleet(3, true);
  const std::string unused =
      std::string(text).replace(text.find("walk: {}"), 8, "walk: { send: [], receive: [token] }");
  const Generated generated = generate(unused);
  EXPECT_THAT(generated["system.cpp"],
              HasSubstr("\"robot[0].control.token->robot[1].control.token\", {0}, {1, "));
  const std::string nothing =
      std::string(text).replace(text.find("walk: {}"), 8, "walk: { send: [], receive: [] }");
  EXPECT_THAT(generate(nothing)["system.cpp"], Not(HasSubstr("robot[0].control.token->")));
}

/// The numbers of a row of the transitions mean the places of which its comment speaks.
TEST(LocalNet, RowsNameTheirPlacesByNumber) {
  const Generated generated = generate_file(line_follower_spec);
  const std::string& source = generated["robot.control.cpp"];
  std::vector<std::string> places;
  static const std::regex place(R"re(\{"([\w.]+)"(?:, +tessera::\w+\([^)]*\))?\},)re");
  const std::size_t first = source.find("tessera::Place places"), end = source.find("};", first);
  const std::string table = source.substr(first, end - first);
  for (std::sregex_iterator at(table.begin(), table.end(), place), none; at != none; ++at)
    places.push_back((*at)[1]);
  ASSERT_EQ(places.size(), 20U);
  static const std::regex row(
      R"re(\{"[\w.]+", +\{(\d+)[^}]*\}, +\{(\d+)[^}]*\}, .*// ([\w.]+)[^>]*-> ([\w.]+))re");
  std::size_t rows = 0;
  for (std::sregex_iterator at(source.begin(), source.end(), row), none; at != none; ++at, ++rows) {
    EXPECT_EQ(places.at(std::stoul((*at)[1])), (*at)[3]) << (*at)[0];
    EXPECT_EQ(places.at(std::stoul((*at)[2])), (*at)[4]) << (*at)[0];
  }
  EXPECT_EQ(rows, 26U);
}

TEST(LocalNet, EveryPlaceAndTransitionOfASubsystemIsInItsTables) {
  for (const auto& spec : {line_follower_spec, gap_spec}) {
    const Generated generated = generate_file(spec);
    std::string tables;
    for (const codegen::File& file : generated.files)
      if (file.path.ends_with(".cpp")) tables += file.text;
    for (const net::Place& place : generated.net.places()) {
      if (!place.subsystem.valid()) continue;
      const std::string local = place.name.substr(generated.model.instance_path(place.subsystem).size() + 1);
      EXPECT_THAT(tables, HasSubstr("{\"" + local + "\"")) << place.name;
    }
    for (const net::Transition& transition : generated.net.transitions()) {
      if (!transition.subsystem.valid()) continue;
      const std::string local =
          transition.name.substr(generated.model.instance_path(transition.subsystem).size() + 1);
      EXPECT_THAT(tables, HasSubstr("{\"" + local + "\",")) << transition.name;
    }
  }
}

}  // namespace
}  // namespace tessera::test
