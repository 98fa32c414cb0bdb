#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "examples.hpp"
#include "language/edits/edit_json.hpp"
#include "language/edits/edits.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

const std::string defaulted = R"(tessera: 1
system: s
agents:
  robot:
    control:
      rate: 10 Hz
      inputs: { i: bool, j: bool }
      outputs: { motion: bool, grip: bool, request: bool }
      on_error: safe
      send: [motion, grip]
      receive: { first: [i] }
      conditions: { paused: in.i }
      behaviours:
        ask: { send: [+request], receive: [+j], terminal: { paused, done: in.j }, next: [{ to: go, when: paused }, go] }
        go: { send: [-grip], terminal: paused, next: ask }
        safe: { send: [request], terminal: true, next: go }
channels:
  - robot.control.motion -> robot.control.i
  - robot.control.grip -> robot.control.j
)";

std::string with_other(std::string in, const std::string& old, const std::string& with) {
  const std::size_t at = in.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? in : in.replace(at, old.size(), with);
}

std::vector<std::string> labels_in(const std::string& with_cursor) {
  const Typed typed(with_cursor);
  const Document document(typed.text, grammar());
  std::vector<std::string> labels;
  for (const Proposal& one : complete(document, typed.cursor)) labels.push_back(one.label);
  return labels;
}

Position position_of(const std::string& in, const std::string& word, std::size_t skip = 0) {
  return Lines(in).position(in.find(word) + skip);
}

std::string after_renaming(const std::string& in, Position at, const std::string& name) {
  const Document document(in, grammar());
  const Renaming done = rename(document, nullptr, at, {}, name);
  return done.problem ? "refused: " + *done.problem : edited(document, done.edits);
}

std::string after_edit(const std::string& in, const std::string& edits) {
  const auto read = edits_of(nlohmann::ordered_json::parse(edits));
  EXPECT_TRUE(read) << edits;
  const Document document(in, grammar());
  const Renaming done = edit(document, *read, {});
  return done.problem ? "refused: " + *done.problem : edited(document, done.edits);
}

std::size_t times(const std::string& in, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = in.find(word); at != std::string::npos; at = in.find(word, at + 1)) ++found;
  return found;
}

bool reads_well(const std::string& in) {
  diagnostics::Diagnostics out("spec.yaml", in);
  (void)spec::parse(out);
  EXPECT_FALSE(out.has_errors()) << render(out) << in;
  return !out.has_errors();
}

TEST(Defaults, AreCompleted) {
  EXPECT_THAT(labels_in(with_other(defaulted, "on_error: safe", "on_error: ‸")),
              ElementsAre("ask", "go", "safe", "stop"));
  EXPECT_THAT(labels_in(with_other(defaulted, "agents:\n", "on_error: ‸\nagents:\n")),
              ElementsAre("ask", "go", "safe", "stop"));
  EXPECT_THAT(labels_in(with_other(defaulted, "    control:\n", "    on_error: s‸\n    control:\n")),
              Contains("safe"));
  EXPECT_THAT(labels_in(with_other(defaulted, "send: [motion, grip]", "send: [‸]")),
              ElementsAre("motion", "grip", "request"));
  EXPECT_THAT(labels_in(with_other(defaulted, "first: [i]", "first: [‸]")), ElementsAre("i", "j"));
  EXPECT_THAT(labels_in(with_other(defaulted, "+request", "+‸")), ElementsAre("request"));
  EXPECT_THAT(labels_in(with_other(defaulted, "+j", "+‸")), ElementsAre("j"));
  EXPECT_THAT(labels_in(with_other(defaulted, "-grip", "-g‸")), UnorderedElementsAre("motion", "grip"));
  EXPECT_THAT(labels_in(with_other(defaulted, "terminal: paused", "terminal: ‸")), Contains("paused"));
  EXPECT_THAT(labels_in(with_other(defaulted, "{ paused, done", "{ p‸, done")), Contains("paused"));
  EXPECT_THAT(labels_in(with_other(defaulted, "when: paused", "when: ‸")), Contains("paused"));
  EXPECT_THAT(labels_in(with_other(defaulted, "paused: in.i", "paused: in.‸")), Contains("i"));
  EXPECT_THAT(labels_in(with_other(defaulted, "      on_error: safe\n", "      ‸\n")), Contains("on_error"));
}

TEST(Defaults, OfABehaviourAreExplained) {
  const Document document(defaulted, grammar());
  const auto says = [&](const std::string& word) {
    const auto found = explain(document, position_of(defaulted, word));
    return found ? found->markdown : "";
  };
  EXPECT_THAT(says("go: { send"), HasSubstr("A failure leads to `safe`: `on_error`, line 9."));
  EXPECT_THAT(says("go: { send"),
              HasSubstr("Sends `motion`: `send` of the subsystem, line 10, as changed here."));
  EXPECT_THAT(says("go: { send"), HasSubstr("Receives `i`: `receive` of the subsystem, line 11."));
  EXPECT_THAT(says("safe: { send"), Not(HasSubstr("A failure")));
  EXPECT_THAT(says("safe: { send"), Not(HasSubstr("Sends")));
  EXPECT_THAT(says("paused, done"), HasSubstr("`in.i`"));
  EXPECT_THAT(says("on_error"), HasSubstr("stop (the default)"));
}

TEST(Defaults, ChangeWithTheNamesThatTheyName) {
  const std::string rest = after_renaming(defaulted, position_of(defaulted, "safe: {"), "rest");
  EXPECT_THAT(rest, HasSubstr("on_error: rest"));
  EXPECT_TRUE(reads_well(rest));
  EXPECT_EQ(after_renaming(rest, position_of(rest, "on_error: rest", 11), "safe"), defaulted);

  const std::string asked = after_renaming(defaulted, position_of(defaulted, "+request", 2), "wish");
  EXPECT_THAT(asked, HasSubstr("[+wish]"));
  EXPECT_THAT(asked, HasSubstr("send: [wish]"));
  EXPECT_TRUE(reads_well(asked));
  EXPECT_THAT(after_renaming(defaulted, position_of(defaulted, "grip: bool"), "claw"),
              HasSubstr("send: [-claw]"));
  EXPECT_THAT(after_renaming(defaulted, position_of(defaulted, "j: bool"), "k"), HasSubstr("receive: [+k]"));
  EXPECT_THAT(after_renaming(defaulted, position_of(defaulted, "i: bool"), "k"), HasSubstr("{ first: [k] }"));

  const std::string held = after_renaming(defaulted, position_of(defaulted, "paused: in.i"), "held");
  EXPECT_EQ(times(held, "paused"), 0U);
  EXPECT_EQ(times(held, "held"), 4U);
  EXPECT_TRUE(reads_well(held));
  EXPECT_EQ(after_renaming(held, position_of(held, "when: held", 6), "paused"), defaulted);
  EXPECT_THAT(after_renaming(defaulted, position_of(defaulted, "paused: in.i"), "done"),
              HasSubstr("refused"));
}

TEST(Defaults, OfAnAgentChangeWithTheOnlyBehaviourThatTheyName) {
  const std::string outer = with_other(with_other(defaulted, "      on_error: safe\n", ""),
                                       "    control:", "    on_error: safe\n    control:");
  ASSERT_TRUE(reads_well(outer));
  EXPECT_THAT(after_renaming(outer, position_of(outer, "safe: {"), "rest"), HasSubstr("on_error: rest"));
  const std::string receptor =
      "    receptors:\n      eye: { rate: 10 Hz, behaviours: { look: {}, safe: { terminal: true, next: look "
      "} } }\nchannels:";
  const std::string two = with_other(outer, "channels:", receptor);
  ASSERT_TRUE(reads_well(two));
  EXPECT_THAT(after_renaming(two, position_of(two, "safe: { send"), "rest"), HasSubstr("E271"));
  EXPECT_THAT(after_renaming(two, position_of(two, "safe: { terminal: true, next: look"), "rest"),
              HasSubstr("E271"));
}

TEST(Defaults, GoWithWhatIsRemoved) {
  const std::string gone =
      after_edit(defaulted, R"([{"do":"remove","at":["agents","robot","control","behaviours","safe"]}])");
  EXPECT_THAT(gone, Not(HasSubstr("on_error")));
  EXPECT_TRUE(reads_well(gone));

  const std::string without =
      after_edit(defaulted, R"([{"do":"remove","at":["agents","robot","control","outputs","request"]}])");
  EXPECT_THAT(without, HasSubstr("ask: { receive: [+j]")) << "it had only changed the list";
  EXPECT_THAT(without, HasSubstr("safe: { send: []")) << "it goes on to send nothing";
  EXPECT_TRUE(reads_well(without));

  const std::string grip =
      after_edit(defaulted, R"([{"do":"remove","at":["agents","robot","control","outputs","grip"]}])");
  EXPECT_THAT(grip, HasSubstr("send: [motion]\n"));
  EXPECT_THAT(grip, HasSubstr("go: { terminal: paused"));

  const std::string input =
      after_edit(defaulted, R"([{"do":"remove","at":["agents","robot","control","inputs","i"]}])");
  EXPECT_THAT(input, HasSubstr("receive: { first: [] }"));
}

TEST(Defaults, InLinesGoLikeThoseInBrackets) {
  const std::string block =
      with_other(defaulted, "        safe: { send: [request], terminal: true, next: go }\n",
                 "        safe:\n          send:\n            - request\n          terminal: true\n"
                 "          next: go\n");
  ASSERT_TRUE(reads_well(block));
  const std::string without =
      after_edit(block, R"([{"do":"remove","at":["agents","robot","control","outputs","request"]}])");
  EXPECT_TRUE(reads_well(without));
  EXPECT_EQ(times(without, "request"), 0U);
  const Document document(without, grammar());
  EXPECT_THAT(without, HasSubstr("send:\n            []")) << "not all outputs";
}

TEST(Defaults, KeepTheBehaviourThatAnAgentOrTheSystemNames) {
  const std::string own = with_other(defaulted, "      on_error: safe\n", "");
  const std::string edit = R"([{"do":"remove","at":["agents","robot","control","behaviours","safe"]}])";
  EXPECT_THAT(after_edit(with_other(own, "    control:", "    on_error: safe\n    control:"), edit),
              HasSubstr("refused: 'on_error' on line 5 leads failures to 'safe'"));
  EXPECT_THAT(after_edit(with_other(own, "agents:", "on_error: safe\nagents:"), edit),
              HasSubstr("refused: 'on_error' on line 3"));
  EXPECT_TRUE(reads_well(after_edit(own, edit)));
}

TEST(Defaults, HoldForABehaviourThatIsAdded) {
  const std::string more = after_edit(
      defaulted,
      R"([{"do":"insert","at":["agents","robot","control","behaviours"],"key":"wait","value":"{}"}])");
  ASSERT_TRUE(reads_well(more));
  diagnostics::Diagnostics out("spec.yaml", more);
  const auto model = spec::parse(out);
  const spec::Behaviour& wait = model->definitions.front().subsystems.front().behaviours.back();
  EXPECT_EQ(wait.name, "wait");
  EXPECT_EQ(wait.send->size(), 2U);
  EXPECT_TRUE(wait.next.front().inherited);
}

TEST(Defaults, MoveToATemplateWithTheirAgent) {
  const std::string outer = with_other(with_other(defaulted, "      on_error: safe\n", ""),
                                       "    control:", "    on_error: safe\n    control:");
  const std::string made = after_edit(outer, R"([{"do":"make_template","at":["agents","robot"]}])");
  EXPECT_TRUE(reads_well(made));
  EXPECT_GT(made.find("on_error: safe"), made.find("templates:"));
  EXPECT_THAT(made, HasSubstr("use: robot"));
}

}  // namespace
}  // namespace tessera::language
