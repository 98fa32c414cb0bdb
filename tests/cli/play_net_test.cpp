#include <set>

#include "command.hpp"

namespace tessera::cli_test {

using PlayNet = Command;

// A ring that may leave for `end` at every turn: p0 -> back or out.
constexpr const char* net = R"(<?xml version="1.0"?>
<pnml xmlns="http://www.pnml.org/version-2009/grammar/pnml"><net id="n" type="http://www.pnml.org/version-2009/grammar/ptnet">
<page id="g">
<place id="here"><initialMarking><text>1</text></initialMarking></place><place id="there"/><place id="end"/>
<transition id="go"/><transition id="back"/>%s
<arc id="a1" source="here" target="go"/><arc id="a2" source="go" target="there"/>
<arc id="a3" source="there" target="back"/><arc id="a4" source="back" target="here"/>
</page></net></pnml>
)";

[[nodiscard]] std::string net_with(const std::string& more) {
  std::string text = net;
  return text.replace(text.find("%s"), 2, more);
}

TEST_F(PlayNet, FiresAsOftenAsAskedAndCountsEachTransition) {
  write(folder_ / "ring.pnml", net_with(""));
  const nlohmann::json played = json("play ring.pnml 1001");
  EXPECT_EQ(played.at("firings"), 1001);
  EXPECT_EQ(played.at("ended"), "steps");
  EXPECT_EQ(played.at("fired"), nlohmann::json({{"go", 501}, {"back", 500}}));
  EXPECT_EQ(played.at("marking"), nlohmann::json({{"there", 1}}));
}

TEST_F(PlayNet, EndsWhereTheNetIsDeadAndRepeatsFromTheSeed) {
  write(folder_ / "net.pnml", net_with("<transition id='out'/><arc id='a5' source='here' target='out'/>"
                                       "<arc id='a6' source='out' target='end'/>"));
  std::set<std::string> runs;
  for (const char* seed : {"1", "2", "3", "4", "5", "6", "7", "8"}) {
    const std::string command = std::string("play net.pnml --seed ") + seed;
    nlohmann::json first = json(command), second = json(command);
    EXPECT_EQ(first.at("ended"), "dead");
    EXPECT_EQ(first.at("marking"), nlohmann::json({{"end", 1}}));
    EXPECT_EQ(first.at("fired"), second.at("fired"));
    runs.insert(first.at("fired").dump());
  }
  EXPECT_GT(runs.size(), 1U) << "the lots differ";
}

TEST_F(PlayNet, SaysWhatFiredAndRefusesWhatIsNoNet) {
  write(folder_ / "ring.pnml",
        net_with("<transition id='never'/><arc id='a5' source='end' target='never'/>"));
  const project::Exit played = tessera("play ring.pnml 10");
  EXPECT_EQ(played.code, 0);
  EXPECT_NE(played.text.find("10 firings in "), std::string::npos) << played.text;
  EXPECT_NE(played.text.find("5 go\n"), std::string::npos) << played.text;
  EXPECT_NE(played.text.find("1 of 3 transitions never fired\n"), std::string::npos) << played.text;
  write(folder_ / "wrong.pnml", "<pnml");
  EXPECT_EQ(tessera("play wrong.pnml").code, 2);
  EXPECT_EQ(tessera("play nowhere.pnml").code, 2);
}

}  // namespace tessera::cli_test
