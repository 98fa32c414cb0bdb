#include "language/edits/edits.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "examples.hpp"
#include "language/edits/edit_json.hpp"

namespace tessera::language {
namespace {

using nlohmann::ordered_json;
using ::testing::HasSubstr;

struct Outcome {
  std::string text;
  std::optional<std::string> problem;
};

Outcome after(const std::string& text, const std::string& edits) {
  const std::optional<std::vector<Edit>> read = edits_of(ordered_json::parse(edits));
  EXPECT_TRUE(read) << edits;
  if (!read) return {};
  const Document document(text, grammar());
  const Renaming done = edit(document, *read, {});
  EXPECT_TRUE(!done.problem || done.edits.empty());
  return {edited(document, done.edits), done.problem};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines{""};
  for (const char c : text)
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  return lines;
}

TEST(Edits, OfASpecificationThatIncludesFilesChangeItsOwnTextAlone) {
  const std::string text = R"(tessera: 1
system: demo
include: [parts/types.yaml, parts/robot.yaml]
types: { Pose: { x: float64 } }
agents: { robot: { use: robot } }
)";
  const Outcome renamed = after(text, R"({"do": "rename", "at": ["types", "Pose"], "text": "Place"})");
  EXPECT_NE(renamed.problem.value_or("").find("includes parts/types.yaml and parts/robot.yaml"),
            std::string::npos)
      << renamed.problem.value_or("no problem");
  const Outcome elsewhere =
      after(text, R"({"do": "set", "at": ["templates", "robot", "control"], "key": "rate", "text": "5 Hz"})");
  EXPECT_NE(elsewhere.problem.value_or("").find("parts/types.yaml and parts/robot.yaml"), std::string::npos)
      << elsewhere.problem.value_or("no problem");
}

/// The texts that the page of the studio made when it edited texts itself.
TEST(Edits, OfTheFormsGiveTheTextsThatTheyAlwaysGave) {
  const ordered_json fixture =
      ordered_json::parse(read_text(TESSERA_SOURCE_DIR "/tests/golden/language/edits.json"));
  ASSERT_GT(fixture.at("edits").size(), 150U);
  for (const ordered_json& one : fixture.at("edits")) {
    const std::string text = fixture.at("texts").at(one.at("on").get<std::size_t>());
    SCOPED_TRACE(one.at("edit").dump() + " of\n" + text);
    const Outcome now = after(text, one.at("edit").dump());
    if (one.contains("refused")) {
      EXPECT_TRUE(now.problem);
      continue;
    }
    std::vector<std::string> lines = lines_of(text);
    const auto from = lines.begin() + one.at("line").get<std::ptrdiff_t>();
    const auto at = lines.erase(from, from + one.at("gone").get<std::ptrdiff_t>());
    const auto fresh = one.at("lines").get<std::vector<std::string>>();
    lines.insert(at, fresh.begin(), fresh.end());
    std::string expected;
    for (const std::string& line : lines) expected += (&line == &lines.front() ? "" : "\n") + line;
    EXPECT_EQ(now.text, expected) << now.problem.value_or("");
  }
}

TEST(Edits, QuoteATextOnlyWhereYamlNeedsIt) {
  const ordered_json fixture =
      ordered_json::parse(read_text(TESSERA_SOURCE_DIR "/tests/golden/language/edits.json"));
  for (const ordered_json& one : fixture.at("scalars"))
    EXPECT_EQ(scalar_text(one.at(0).get<std::string>()), one.at(1));
}

TEST(Edits, OfTheFormsInOtherStyles) {
  const std::string text =
      "simulation: # the world\n  world: a.xml\n  checks:\n    - name: one   # first\n      never: "
      "contact(a)\n"
      "    - { always: \"x\" }\n  measures: {}\nmodels:\n  m: { send: { places: { in, first: { write: 1 }, "
      "out } } }\n";
  const auto has = [&](const char* edit, const char* expected) {
    const Outcome now = after(text, edit);
    EXPECT_THAT(now.text, HasSubstr(expected)) << now.problem.value_or("");
  };
  has(R"({"do": "append", "at": ["simulation", "checks"], "value": {"never": "y"}})",
      "\n    - { never: y }\n");
  has(R"({"do": "remove", "at": ["simulation", "checks", 0, "name"]})", "\n    - never: contact(a)\n");
  has(R"({"do": "set", "at": ["simulation", "checks", 0], "key": "within", "text": "1 s"})",
      "\n      within: 1 s\n");
  has(R"({"do": "append", "at": ["a", "b"], "value": "1"})", "a:\n  b:\n    - 1\n");
  has(R"({"do": "insert", "at": ["models", "m", "send", "places"], "key": "more", "value": {}})",
      "out, more: {} } } }");
  has(R"({"do": "set", "at": ["models", "m", "send", "places", "in"], "key": "write", "text": "1"})",
      "{ in: { write: 1 }, first:");
  has(R"({"do": "remove", "at": ["models", "m", "send", "places", "out"]})",
      "{ in, first: { write: 1 } } } }");
  has(R"x({"do": "insert", "at": ["simulation", "measures"], "key": "robot[0] far", "value": "any(f(a[*]))"})x",
      "  measures:\n    \"robot[0] far\": \"any(f(a[*]))\"\n");
  const char* insert =
      R"({"do": "insert", "at": ["agents"], "key": "b", "value": {"control": {"rate": "1 Hz"}}})";
  EXPECT_EQ(after("agents:\r\n  a: {}\r\n", insert).text,
            "agents:\r\n  a: {}\r\n  b:\r\n    control:\r\n      rate: 1 Hz\r\n");
}

TEST(Edits, OfAliasesChangeWhatTheyStandForOrAreRefused) {
  const std::string text =
      "agents:\n  a:\n    control:\n      behaviours: &b\n        go: { next: go }  # on\n"
      "  b:\n    control: { behaviours: *b }\nproperties:\n  - { reachable: a.control.go and b.control.go "
      "}\n";
  const Outcome renamed =
      after(text, R"({"do": "rename", "at": ["agents", "a", "control", "behaviours", "go"], "text": "run"})");
  std::string expected = text;
  for (std::size_t at = 0; (at = expected.find("go", at)) != std::string::npos;)
    expected.replace(at, 2, "run");
  EXPECT_EQ(renamed.text, expected) << renamed.problem.value_or("");
  const auto refused = [&](const char* edit, const char* why) {
    EXPECT_THAT(after(text, edit).problem.value_or("it was done"), HasSubstr(why)) << edit;
  };
  refused(R"({"do": "insert", "at": ["agents", "b", "control", "behaviours"], "key": "rest", "value": {}})",
          "*b stands here");
  refused(R"({"do": "remove", "at": ["agents", "a"]})", "*b stands for it in other places");
  refused(R"({"do": "insert", "at": ["agents"], "key": "a", "value": {}})", "'a' is there already");
  refused(R"({"do": "set", "at": ["agents", "b"], "key": "count", "text": "[1", "as": "as_is"})",
          "could not be read");
  refused(R"({"do": "make_template", "at": ["agents", "a"]})", "move it in the text");
  refused(R"({"do": "rename", "at": ["agents", "c"], "text": "d"})", "the text has changed");
}

TEST(Edits, TheChainsOfASubsystemGoWithIt) {
  const std::string text =
      "agents:\n  a: { control: {}, receptors: { s: { outputs: { x: bool } }, t: {} }, effectors: { m: {} } "
      "}\n"
      "timing:\n  chains:\n    - { name: one, path: [a.s, a.control, a.m] }\n"
      "    - { name: two, path: [a.t, a.control, a.m] }\n    - { name: three, path: [a.s.x, a.control, a.m] "
      "}\n";
  const auto rest = [&](const char* way) {
    const Outcome now = after(text, way);
    EXPECT_EQ(now.problem, std::nullopt);
    return now.text.substr(now.text.find("timing:"));
  };
  EXPECT_EQ(rest(R"({"do": "remove", "at": ["agents", "a", "receptors", "s"]})"),
            "timing:\n  chains:\n    - { name: two, path: [a.t, a.control, a.m] }\n");
  EXPECT_EQ(rest(R"({"do": "remove", "at": ["agents", "a", "receptors", "s", "outputs", "x"]})"),
            "timing:\n  chains:\n    - { name: one, path: [a.s, a.control, a.m] }\n"
            "    - { name: two, path: [a.t, a.control, a.m] }\n");
}

TEST(Edits, FindANameByItsPathAndItsKind) {
  const Document document(
      "agents:\n  a: { control: { inputs: { x: bool }, behaviours: { x: {}, y: {} } } }\n", grammar());
  EXPECT_TRUE(find_name(document, "a.control.y").position);
  EXPECT_TRUE(find_name(document, "input:a.control.x").position);
  EXPECT_THAT(find_name(document, "a.control.x").problem,
              HasSubstr("input:a.control.x (an input buffer, line 2)"));
  EXPECT_THAT(find_name(document, "a.control.z").problem, HasSubstr("no name 'a.control.z'"));
}

}  // namespace
}  // namespace tessera::language
