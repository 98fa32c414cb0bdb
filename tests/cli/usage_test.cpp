#include <unistd.h>

#include "command.hpp"

namespace tessera::cli_test {

using Usage = Command;

TEST_F(Usage, ExitCodesTellMistakesInTheFileFromMistakesInTheCall) {
  write(folder_ / "wrong.yaml", "tessera: 1\nsystem: x\nagents: { a: { kontrol: {} } }\n");
  const project::Exit wrong = tessera("check wrong.yaml");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.text.find("wrong.yaml:3:"), std::string::npos) << wrong.text;
  EXPECT_NE(wrong.text.find("did you mean 'control'?"), std::string::npos) << wrong.text;
  EXPECT_EQ(tessera("check nowhere.yaml").code, 2);
  EXPECT_EQ(tessera("check --no-such-option").code, 2);
  EXPECT_EQ(tessera("").code, 2);
  EXPECT_EQ(tessera("chekc").code, 2);
  EXPECT_EQ(tessera("--help").code, 0);
  EXPECT_EQ(tessera("simulate --help").code, 0);
}

TEST_F(Usage, AFileThatCannotBeReadIsNoViolation) {
  write(folder_ / "text.yaml", "tessera: [1\n");
  write(folder_ / "wrong.yaml", "tessera: 1\nsystem: x\nagents: { a: { kontrol: {} } }\n");
  for (const char* command :
       {"check", "check --json -", "verify", "generate", "show", "export --pnml net.pnml", "simulate"}) {
    SCOPED_TRACE(command);
    EXPECT_EQ(tessera(std::string(command) + " text.yaml").code, 2);
    EXPECT_EQ(tessera(std::string(command) + " nowhere.yaml").code, 2);
    EXPECT_EQ(tessera(std::string(command) + " wrong.yaml").code, 1);
  }
}

TEST_F(Usage, APropertyMayNotHaveTheNameOfADefaultOne) {
  write(folder_ / "named.yaml",
        "tessera: 1\nsystem: x\n"
        "agents: { a: { control: { rate: 1 Hz, behaviours: { b: {} } } } }\n"
        "properties: [ { name: safe, reachable: a.control.b } ]\n");
  for (const char* command : {"check", "check --json -", "verify"}) {
    const project::Exit named = tessera(std::string(command) + " named.yaml");
    EXPECT_EQ(named.code, 1) << named.text;
    EXPECT_NE(named.text.find("the property name 'safe' is taken"), std::string::npos) << named.text;
  }
}

TEST_F(Usage, CheckNamesFilesOfTheSimulationThatAreMissing) {
  const fs::path spec = example("01_line_follower") / "spec.yaml";
  EXPECT_EQ(tessera("check 01_line_follower").code, 0);
  replace(spec, "world: line_world.xml", "world: line_wrold.xml");
  replace(spec, "image: oval.png", "image: ovl.png");
  const project::Exit missing = tessera("check 01_line_follower");
  EXPECT_EQ(missing.code, 1);
  for (const char* text :
       {"error E310: there is no world 'line_wrold.xml' in ", "did you mean 'line_world.xml'?",
        "error E310: there is no picture 'ovl.png' in ", "did you mean 'oval.png'?", "^~~~~~~"})
    EXPECT_NE(missing.text.find(text), std::string::npos) << missing.text;
  EXPECT_EQ(tessera("check 01_line_follower --json found.json").code, 1);
  EXPECT_EQ(nlohmann::json::parse(content_of(folder_ / "found.json")).size(), 2U);
}

TEST_F(Usage, EveryCommandShowsAnExample) {
  for (const char* command : {"new", "check", "show", "verify", "export", "generate", "test", "simulate",
                              "schedules", "rerun", "play", "merge", "run", "completion"}) {
    const project::Exit help = tessera(std::string(command) + " --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.text.find("tessera " + std::string(command)), std::string::npos) << help.text;
  }
}

TEST_F(Usage, CompletionOffersCommandsOptionsAndValuesOfTheProject) {
  const std::string program = TESSERA_BINARY_DIR "/tessera";
  const std::string example = std::string(TESSERA_SOURCE_DIR) + "/examples/05_depot";
  write(folder_ / "complete.sh",
        "eval \"$(" + program +
            " completion bash)\"\n"
            "try() { COMP_WORDS=(" +
            program +
            " \"$@\"); COMP_CWORD=$#; _tessera; (IFS='|'; echo \"${COMPREPLY[*]}\"); }\n"
            "try simu\n"
            "try simulate --se\n"
            "try verify " +
            example +
            " --property 'who is'\n"
            "try show " +
            example +
            " --page = 'carrier[1].control.leave.'\n"
            "try simulate " +
            example +
            " --set 'carrier[1].control.l'\n"
            "try schedules 5 " +
            example +
            " --set 'carrier[1].control.sp'\n"
            "try new x --robot a\n"
            "try check compl\n"
            "try show nowhere --page r\n");
  const project::Exit done = shell("bash complete.sh");
  EXPECT_EQ(
      done.text,
      "simulate\n--set|--seed\nwho is at the dock was lent "
      "it\ncarrier[1].control.leave.snd|carrier[1].control.leave.rcv\n"
      "carrier[1].control.line=|carrier[1].control.lease=\ncarrier[1].control.speed=\narm\ncomplete.sh\n\n");
}

TEST_F(Usage, UnknownCommandsAndOptionsSayWhatIsMeant) {
  const project::Exit command = tessera("ne");
  EXPECT_EQ(command.code, 2);
  EXPECT_NE(command.text.find("there is no command 'ne'; did you mean 'new'?"), std::string::npos)
      << command.text;
  const project::Exit option = tessera("show --pag x");
  EXPECT_EQ(option.code, 2);
  EXPECT_NE(option.text.find("tessera show has no option '--pag'; did you mean '--page'?"), std::string::npos)
      << option.text;
}

TEST_F(Usage, ShowDrawsCountsAndExportsTheExample) {
  const std::string spec = std::string(TESSERA_SOURCE_DIR) + "/examples/01_line_follower/spec.yaml";
  const project::Exit tree = tessera("show " + spec);
  EXPECT_EQ(tree.code, 0) << tree.text;
  EXPECT_NE(tree.text.find("follow"), std::string::npos) << tree.text;
  const project::Exit counts = tessera("show " + spec + " --counts --json -");
  EXPECT_EQ(nlohmann::json::parse(counts.text).at("layers").at("system").at("pages"), 1) << counts.text;
  EXPECT_EQ(tessera("show " + spec + " --page robot.control.follow --svg follow.svg").code, 0);
  EXPECT_NE(content_of(folder_ / "follow.svg").find("<svg"), std::string::npos);
  EXPECT_EQ(tessera("show " + spec + " --svg whole.svg --notation paper").code, 0);
  EXPECT_EQ(tessera("show " + spec + " --dot whole.dot").code, 0);
  EXPECT_EQ(tessera("export " + spec + " --pnml net.pnml").code, 0);
  EXPECT_NE(content_of(folder_ / "net.pnml").find("http://www.pnml.org/version-2009/grammar/ptnet"),
            std::string::npos);
  const project::Exit nowhere = tessera("show " + spec + " --page robot.control.folow --svg x.svg");
  EXPECT_EQ(nowhere.code, 1);
  EXPECT_NE(nowhere.text.find("did you mean 'robot.control.follow'?"), std::string::npos) << nowhere.text;
}

}  // namespace tessera::cli_test
