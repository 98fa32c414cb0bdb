#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

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

TEST(LocalNet, AnInputAndAnOutputOfOneNameAreDifferentPorts) {
  const Generated generated = generate(fleet(3, true));
  EXPECT_THAT(generated["walker.control.cpp"],
              HasSubstr("{\"snd.token\", tessera::Side::send,    \"token\"},\n"));
  EXPECT_THAT(generated["walker.control.cpp"],
              HasSubstr("{\"rcv.token\", tessera::Side::receive, \"token\"},\n"));
  EXPECT_THAT(generated["system.cpp"],
              HasSubstr("{0, \"snd.token\"}, {1, \"rcv.token\"}, tessera::asynchronous},\n"));
}

TEST(LocalNet, OfASubsystemThatReceivesFirstBeginsWithItsReceive) {
  std::string text = fleet(3, true);
  text.replace(text.find("      rate: 10 Hz\n"), 18, "      rate: 10 Hz\n      receive: first\n");
  const Generated generated = generate(text);
  std::string table = generated["walker.control.cpp"];
  for (std::size_t at = table.find("  "); at != std::string::npos; at = table.find("  ")) table.erase(at, 1);
  for (const char* row :
       {R"({"walk.in", tessera::begins("walk")})", R"({"walk.2", tessera::calls("walk")})",
        R"({"walk.snd.out", tessera::decides("walk")})",
        R"({"walk.t1", {"walk.in"}, {"walk.rcv.in"}, {}, {tessera::Step::begin_receiving, "walk"}})",
        R"({"walk.t2", {"walk.rcv.out"}, {"walk.2"}, {}, {tessera::Step::end_receiving, "walk"}})",
        R"({"walk.t3", {"walk.2"}, {"walk.snd.in"}, {}, {tessera::Step::begin_sending, "walk"}})",
        R"({"walk.t4", {"walk.snd.out"}, {"walk.in"}, tessera::if_go_on, {tessera::Step::go_on, "walk"}})",
        R"({"walk.t5", {"walk.snd.out"}, {"walk.out"}, tessera::if_terminal, )",
        R"({"walk.t6", {"walk.snd.out"}, {"walk.out"}, tessera::if_error, )"})
    EXPECT_THAT(table, HasSubstr(row));
  EXPECT_THAT(table, Not(HasSubstr("counts()")));
}

TEST(LocalNet, EachChannelOfAnOutputHasItsPort) {
  const Generated generated = generate(fleet(3, true));
  EXPECT_THAT(generated["base.control.cpp"], HasSubstr("{\"order#3\", tessera::Side::send, \"order\"},\n"));
  EXPECT_THAT(generated["system.cpp"],
              HasSubstr("{3, \"order#3\"}, {2, \"order\"}, tessera::asynchronous},\n"));
}

TEST(LocalNet, AChannelThatNobodyUsesHasNoRow) {
  const std::string text = fleet(3, true);
  const std::string unused =
      std::string(text).replace(text.find("walk: {}"), 8, "walk: { send: [], receive: [token] }");
  const Generated generated = generate(unused);
  EXPECT_THAT(generated["system.cpp"],
              HasSubstr("\"robot[0].control.token->robot[1].control.token\", {0, \"\"}, {1, "));
  const std::string nothing =
      std::string(text).replace(text.find("walk: {}"), 8, "walk: { send: [], receive: [] }");
  EXPECT_THAT(generate(nothing)["system.cpp"], Not(HasSubstr("robot[0].control.token->")));
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
