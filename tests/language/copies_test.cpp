// Copies of elements: their comments, the names in them, the channels of an agent, anchors.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "examples.hpp"
#include "language/edits/edit_json.hpp"
#include "language/edits/edits.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

using nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string carriers = R"(tessera: 1
system: s
agents:
  # Carries boxes.
  robot:
    control:
      rate: &fast 10 Hz
      inputs: { seen: bool }
      outputs: { go: bool }
      behaviours:
        # Looks for a box.
        look: { terminal: in.seen, next: [{ to: carry, when: in.seen }, look] }  # for ever
        carry:
          # until it is there
          terminal: true
          next: look
    receptors:
      eye: { rate: *fast, outputs: { seen: bool }, real: { camera: bool }, behaviours: { read: {} } }
  desk:
    control: { rate: 1 Hz, inputs: { go: bool }, behaviours: { sit: {} } }
channels:
  - robot.eye.seen -> robot.control.seen
  - { from: robot.control.go, to: desk.control.go, receive: blocking, timeout: 1 s }
parameters: { limit: 1.0 }
)";

struct Copied {
  std::string text;
  std::string problem;
};

Copied with_copy(const std::string& before, const ordered_json& edits) {
  const std::optional<std::vector<Edit>> read = edits_of(edits);
  EXPECT_TRUE(read) << edits;
  if (!read) return {};
  const Document document(before, grammar());
  const Renaming done = edit(document, *read, {});
  return {edited(document, done.edits), done.problem.value_or("")};
}

ordered_json copy(const std::vector<std::string>& at, const std::string& name) {
  return {{"do", "copy"}, {"at", at}, {"key", name}};
}

ordered_json paste(const std::vector<std::string>& at, const std::string& name, const std::string& from) {
  return {{"do", "paste"}, {"at", at}, {"key", name}, {"text", from}};
}

std::vector<std::string> mistakes_in(const std::string& specification) {
  diagnostics::Diagnostics out("spec.yaml", specification);
  static_cast<void>(spec::parse(out));
  std::vector<std::string> all;
  for (const diagnostics::Diagnostic& one : out.sorted())
    if (one.severity == diagnostics::Severity::error) all.push_back(one.message);
  return all;
}

TEST(Copies, OfABehaviourStandBehindItWithItsCommentsAndLeadToThemselves) {
  const std::vector<std::string> behaviours{"agents", "robot", "control", "behaviours"};
  std::vector<std::string> look = behaviours;
  look.emplace_back("look");
  const Copied done = with_copy(carriers, copy(look, "look_2"));
  EXPECT_EQ(done.problem, "");
  EXPECT_THAT(done.text, HasSubstr(R"( # for ever
        # Looks for a box.
        look_2: { terminal: in.seen, next: [{ to: carry, when: in.seen }, look_2] }  # for ever
        carry:
)"));
  EXPECT_THAT(mistakes_in(done.text), testing::IsEmpty());
}

TEST(Copies, OfAnAgentHaveTheChannelsWithinItAndNoOther) {
  const Copied done = with_copy(carriers, copy({"agents", "robot"}, "robot_2"));
  EXPECT_EQ(done.problem, "");
  EXPECT_THAT(done.text,
              HasSubstr("  # Carries boxes.\n  robot_2:\n    control:\n      rate: &fast_2 10 Hz\n"));
  EXPECT_THAT(done.text, HasSubstr("eye: { rate: *fast_2, "));
  EXPECT_THAT(done.text, HasSubstr("  - robot_2.eye.seen -> robot_2.control.seen\nparameters"));
  EXPECT_THAT(done.text, Not(HasSubstr("robot_2.control.go")));
  // Its output leads nowhere, which is no error.
  EXPECT_THAT(mistakes_in(done.text), testing::IsEmpty());
}

TEST(Copies, OfWhatStandsInOneLineStandThere) {
  const Copied done =
      with_copy(carriers, copy({"agents", "robot", "receptors", "eye", "behaviours", "read"}, "read_2"));
  EXPECT_EQ(done.problem, "");
  EXPECT_THAT(done.text, HasSubstr("behaviours: { read: {}, read_2: {} }"));
}

TEST(Copies, NeedANameThatIsFreeAndAnElementThatIsThere) {
  EXPECT_THAT(with_copy(carriers, copy({"agents", "robot"}, "desk")).problem,
              HasSubstr("'desk' is there already"));
  EXPECT_THAT(with_copy(carriers, copy({"agents", "robot"}, "a: b")).problem,
              HasSubstr("a name has letters"));
  EXPECT_THAT(with_copy(carriers, copy({"agents", "nobody"}, "somebody")).problem, HasSubstr("has changed"));
  EXPECT_EQ(with_copy(carriers, copy({"agents", "nobody"}, "somebody")).text, carriers);
}

TEST(Copies, ArePastedWithTheirCommentsInTheColumnOfTheOthers) {
  const std::string from = "# Waits.\nwait:\n  # long\n  terminal: elapsed > 5 s\n";
  const Copied done =
      with_copy(carriers, paste({"agents", "robot", "control", "behaviours"}, "wait_2", from));
  EXPECT_EQ(done.problem, "");
  EXPECT_THAT(done.text, HasSubstr(R"(          next: look
        # Waits.
        wait_2:
          # long
          terminal: elapsed > 5 s
    receptors:)"));
  const Copied line =
      with_copy(carriers, paste({"agents", "desk", "control", "behaviours"}, "stand", "sit: { }\n"));
  EXPECT_THAT(line.text, HasSubstr("behaviours: { sit: {}, stand: { } }"));
}

TEST(Copies, ArePastedIntoAMapThatIsNotThereYet) {
  const Copied done = with_copy(
      carriers, paste({"agents", "desk", "control", "memory"}, "count", "# Boxes so far.\nn: int32\n"));
  EXPECT_THAT(done.problem, HasSubstr("one line"));  // desk.control is a flow, and has no room for a comment
  const Copied block = with_copy(carriers, paste({"agents", "robot", "effectors"}, "arm",
                                                 "arm:\n  rate: 5 Hz\n  behaviours: { move: {} }\n"));
  EXPECT_EQ(block.problem, "");
  EXPECT_THAT(
      block.text,
      HasSubstr("    effectors:\n      arm:\n        rate: 5 Hz\n        behaviours: { move: {} }\n"));
  EXPECT_THAT(mistakes_in(block.text), testing::IsEmpty());
}

TEST(Copies, ArePastedOnlyIfTheyAreOneElementThatMeansTheSameHere) {
  const std::vector<std::string> at{"agents", "robot", "control", "behaviours"};
  for (const char* wrong : {"", "hello", "a: 1\nb: 2\n", "- a\n", "[", "{", "a"})
    EXPECT_THAT(with_copy(carriers, paste(at, "x", wrong)).problem, HasSubstr("no element")) << wrong;
  EXPECT_THAT(with_copy(carriers, paste(at, "x", "a: { terminal: *done }\n")).problem, HasSubstr("*done"));
  const Copied anchored = with_copy(carriers, paste(at, "x", "a: { terminal: &fast true, error: *fast }\n"));
  EXPECT_THAT(anchored.text, HasSubstr("x: { terminal: &fast_2 true, error: *fast_2 }"));
}

TEST(Copies, OfEveryElementOfTheExamplesCanBeReadAgain) {
  for (const auto& folder : examples()) {
    const std::string example = read_text(folder / "spec.yaml");
    const Document document(example, grammar());
    const TextEditor editor(example);
    for (const std::string& agent : editor.keys({"agents"})) {
      const Copied done = with_copy(example, copy({"agents", agent}, agent + "_9"));
      EXPECT_TRUE(done.problem.empty() || done.text == example) << agent << ": " << done.problem;
      const TextEditor now(done.text);
      if (done.problem.empty()) EXPECT_NE(now.entry({"agents", agent + "_9"}), nullptr) << agent;
      const Path behaviours{"agents", agent, "control", "behaviours"};
      for (const std::string& one : editor.keys(behaviours)) {
        const Copied copied =
            with_copy(example, copy({"agents", agent, "control", "behaviours", one}, one + "_9"));
        EXPECT_EQ(copied.problem, "") << agent << "." << one;
        EXPECT_NE(TextEditor(copied.text).entry(behaviours / (one + "_9")), nullptr) << one;
      }
    }
  }
}

}  // namespace
}  // namespace tessera::language
