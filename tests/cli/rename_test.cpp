// A rename on the command line: all files or none.

#include <filesystem>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

using Rename = Command;

TEST_F(Rename, ChangesEveryFileAndLeadsBackToTheSameBytes) {
  const fs::path example = fs::path(TESSERA_SOURCE_DIR) / "examples/01_line_follower";
  fs::copy(example, folder_, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  write(folder_ / "params.yaml", "v: 0.1   # slow\nrobot.sensor.threshold: 0.4\n");
  const auto all = [&] {
    std::string text;
    for (const char* file :
         {"spec.yaml", "params.yaml", "src/control.cpp", "src/sensor.cpp", "test/control_test.cpp"})
      text += content_of(folder_ / file);
    return text;
  };
  const std::string before = all();
  const project::Exit shown = tessera("rename robot.control.follow pursue --dry-run");
  EXPECT_EQ(shown.code, 0) << shown.text;
  EXPECT_EQ(all(), before);
  for (const char* part :
       {"src/control.cpp: line", "test/control_test.cpp: line", "would be pursue in 3 files"})
    EXPECT_NE(shown.text.find(part), std::string::npos) << part << "\n" << shown.text;
  for (const auto& [from, to] : {std::pair{"robot.control.follow", "robot.control.pursue"},
                                 {"v", "speed"},
                                 {"robot.sensor", "robot.eyes"},
                                 {"robot", "rover"}}) {
    const std::string last = std::string(to).substr(std::string(to).rfind('.') + 1);
    const std::string first = std::string(from).substr(std::string(from).rfind('.') + 1);
    EXPECT_EQ(tessera("rename " + std::string(from) + " " + last).code, 0) << from;
    EXPECT_NE(all(), before);
    const project::Exit checked = tessera("check");
    EXPECT_EQ(checked.code, 0) << checked.text;
    EXPECT_EQ(tessera("rename " + std::string(to) + " " + first).code, 0) << to;
    EXPECT_EQ(all(), before) << from;
  }
}

TEST_F(Rename, KeepsTheBoxesThatWereMovedInTheDrawing) {
  const fs::path example = fs::path(TESSERA_SOURCE_DIR) / "examples/01_line_follower";
  fs::copy(example, folder_, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  const fs::path layout = folder_ / ".tessera-layout.json";
  const std::string before =
      "{\n  \"gone\": [4, 4],\n  \"robot\": [1, 2],\n  \"robot.sensor\": [-3, 40]\n}\n";
  write(layout, before);
  const project::Exit shown = tessera("rename robot.sensor eyes --dry-run");
  EXPECT_NE(shown.text.find(".tessera-layout.json: line 4"), std::string::npos) << shown.text;
  EXPECT_EQ(content_of(layout), before);
  EXPECT_EQ(tessera("rename robot.sensor eyes").code, 0);
  EXPECT_EQ(tessera("rename robot rover").code, 0);
  EXPECT_EQ(content_of(layout),
            "{\n  \"gone\": [4, 4],\n  \"rover\": [1, 2],\n  \"rover.eyes\": [-3, 40]\n}\n");
  EXPECT_EQ(tessera("rename rover.control.follow robot").code, 0) << "this names no box";
  EXPECT_EQ(tessera("rename rover robot").code, 0);
  EXPECT_EQ(tessera("rename robot.eyes sensor").code, 0);
  EXPECT_EQ(content_of(layout), before);
}

TEST_F(Rename, OfTwoAtOnceOneWinsWholeAndTheOtherIsRefused) {
  const std::string head = "tessera: 1\nsystem: s\nagents:\n  a: { control: { rate: 1 Hz, behaviours: { ";
  for (int round = 0; round < 12; ++round) {
    const fs::path project = folder_ / std::to_string(round);
    const auto text_with = [&](const std::string& name) {
      std::string all = head + name + ": {} } } }\n";
      for (int file = 0; file < 30; ++file)
        all += "namespace s::a::control {\nvoid " + name + "(Context&);\n}\n";
      return all;
    };
    const auto text = [&] {
      std::string all = content_of(project / "spec.yaml");
      for (int file = 0; file < 30; ++file)
        all += content_of(project / "src" / (std::to_string(file) + ".hpp"));
      return all;
    };
    write(project / "spec.yaml", head + "go: {} } } }\n");
    for (int file = 0; file < 30; ++file)
      write(project / "src" / (std::to_string(file) + ".hpp"),
            "namespace s::a::control {\nvoid go(Context&);\n}\n");
    ASSERT_EQ(text(), text_with("go"));
    // A round has other distances between the two, so that one reads while the other writes.
    const project::Exit both =
        shell("T=" TESSERA_BINARY_DIR "/tessera; cd " + std::to_string(round) +
              "; { $T rename a.control.go left; echo left $?; } & sleep 0.00" + std::to_string(round % 10) +
              "; { $T rename a.control.go right; echo right $?; } & wait");
    const bool left = both.text.find("left 0\n") != std::string::npos;
    const bool right = both.text.find("right 0\n") != std::string::npos;
    EXPECT_NE(left, right) << both.text;
    EXPECT_EQ(text(), text_with(left ? "left" : "right")) << both.text;
  }
}

TEST_F(Rename, ChangesWhatNoIncludedFileNames) {
  const std::string text =
      "tessera: 1\nsystem: s\ninclude: parts/turning.yaml\nagents:\n  a:\n    control:\n      rate: 1 Hz\n"
      "      memory: { steps: { counts: 0..2 }, other: bool }\n"
      "      behaviours: { go: { use: turning, next: rest }, rest: { terminal: true, next: go } }\n";
  const std::string part =
      "templates:\n  turning:\n    # other\n    behaviours: { turn: { terminal: memory.steps == 2, next: end "
      "} }\n";
  write(folder_ / "spec.yaml", text);
  write(folder_ / "parts/turning.yaml", part);
  ASSERT_EQ(tessera("check").code, 0) << tessera("check").text;
  EXPECT_EQ(tessera("rename a.control.other another").code, 0);
  EXPECT_NE(content_of(folder_ / "spec.yaml").find("another: bool"), std::string::npos);
  EXPECT_EQ(tessera("check").code, 0);
  EXPECT_EQ(tessera("rename a.control.another other").code, 0);
  for (const auto& [rename, why] :
       {std::pair{"a.control.steps count_of", "'steps' stands on line 4 of parts/turning.yaml"},
        {"a.control.other turn", "'turn' stands on line 4 of parts/turning.yaml"},
        {"a.control.go drive", "the behaviours of group 'go' stand in parts/turning.yaml"}}) {
    const project::Exit refused = tessera(std::string("rename ") + rename);
    EXPECT_EQ(refused.code, 1) << rename;
    EXPECT_NE(refused.text.find(why), std::string::npos) << refused.text;
  }
  EXPECT_EQ(content_of(folder_ / "spec.yaml"), text);
  EXPECT_EQ(content_of(folder_ / "parts/turning.yaml"), part);
}

TEST_F(Rename, IsRefusedWithAReasonAndThenWritesNothing) {
  const std::string text =
      "tessera: 1\nsystem: s\nagents:\n  a: { control: { rate: 1 Hz, behaviours: { go: {}, halt: {} } } }\n";
  write(folder_ / "spec.yaml", text);
  write(folder_ / "elsewhere.cpp", "namespace s::a::control {\nvoid go(Context&) {}\n}\n");
  fs::create_directories(folder_ / "src");
  for (const auto& [arguments, why] : {std::pair{"a.control.go halt", "is taken"},
                                       {"a.control.go while", "keyword of C++"},
                                       {"a.control.gone x", "no name 'a.control.gone'"}}) {
    const project::Exit refused = tessera(std::string("rename ") + arguments);
    EXPECT_EQ(refused.code, 1) << refused.text;
    EXPECT_NE(refused.text.find(why), std::string::npos) << refused.text;
  }
  EXPECT_EQ(tessera("rename a b nowhere.yaml").code, 2);
  EXPECT_EQ(content_of(folder_ / "spec.yaml"), text);
}

}  // namespace
}  // namespace tessera::cli_test
