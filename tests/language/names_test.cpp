#include <gmock/gmock.h>

#include <set>

#include "../environment.hpp"
#include "examples.hpp"
#include "language/names/sources.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

using ::testing::HasSubstr;

std::string applied(const std::string& text, const std::vector<TextEdit>& edits, const std::string& path) {
  std::vector<TextEdit> own;
  for (const TextEdit& edit : edits)
    if (edit.path == path && edit.sure) own.push_back(edit);
  std::sort(own.begin(), own.end(), [](const TextEdit& a, const TextEdit& b) { return b.range < a.range; });
  std::string result = text;
  for (const TextEdit& edit : own) replace(result, edit.range, edit.text);
  return result;
}

/// Codes and messages, without the names.
std::multiset<std::string> codes(const std::string& text) {
  diagnostics::Diagnostics out("spec.yaml", text);
  (void)spec::parse(out);
  std::multiset<std::string> all;
  for (const auto& one : out.sorted()) all.insert(one.code + " " + std::to_string(one.span.line));
  return all;
}

// The oracle is the parser: a specification in which one name was changed everywhere means the same.
TEST(Rename, NamesOfEveryExampleCanBeChangedAndChangedBack) {
  std::size_t renamed = 0;
  for (const auto& folder : examples()) {
    const std::string text = read_text(folder / "spec.yaml");
    const Document document(text, grammar());
    const auto before = codes(text);
    // One in four: each is parsed four times.
    constexpr std::uint32_t step = sanitized ? 40 : 4;
    for (SymbolId id{static_cast<std::uint32_t>(renamed % step)}; document.index().symbols().has(id);
         id.value += step) {
      const Symbol& symbol = document.index()[id];
      const Position at = document.lines().position(symbol.definition.begin);
      if (!renameable(document, nullptr, at)) continue;
      const Renaming there = rename(document, nullptr, at, {}, "quite_another");
      // A goal needs fields of certain names.
      if (there.problem && there.problem->find("(E363)") != std::string::npos) continue;
      ASSERT_EQ(there.problem, std::nullopt) << folder << " " << symbol.path;
      const std::string changed = applied(text, there.edits, "");
      EXPECT_EQ(codes(changed), before) << folder << " " << symbol.path << "\n" << changed;
      const Document again(changed, grammar());
      ASSERT_EQ(again.index().symbols().size(), document.index().symbols().size());
      const Renaming back =
          rename(again, nullptr, again.lines().position(again.index()[id].definition.begin), {}, symbol.name);
      EXPECT_EQ(back.problem, std::nullopt);
      EXPECT_EQ(applied(changed, back.edits, ""), text) << folder << " " << symbol.path;
      ++renamed;
    }
  }
  EXPECT_GT(renamed, share_of(100));
}

TEST(Rename, ChangesThePathsOfChains) {
  const std::string text = read_text(TESSERA_SOURCE_DIR "/tests/golden/spec/valid/timing.yaml");
  ASSERT_TRUE(codes(text).empty());
  const Document document(text, grammar());
  for (const char* word :
       {"robot:\n", "sensor:\n", "motor:\n", "copy: float64", "tail: float64", "line: float64"}) {
    SCOPED_TRACE(word);
    const Renaming renaming =
        rename(document, nullptr, document.lines().position(text.find(word)), {}, "quite_another");
    ASSERT_EQ(renaming.problem, std::nullopt);
    EXPECT_TRUE(codes(applied(text, renaming.edits, "")).empty());
  }
}

TEST(Rename, ChangesTheCppOfTheProject) {
  const std::string text = read_text(example("01_line_follower") / "spec.yaml");
  const Document document(text, grammar());
  const std::vector<Source> sources = sources_of(example("01_line_follower"));
  const auto changed = [&](const std::string& word, const std::string& name, const std::string& file) {
    const Renaming renaming =
        rename(document, nullptr, document.lines().position(text.find(word)), sources, name);
    EXPECT_EQ(renaming.problem, std::nullopt);
    for (const Source& source : sources)
      if (source.path == file) return applied(source.text, renaming.edits, file);
    return std::string();
  };
  EXPECT_THAT(changed("follow: {}", "drive_on", "src/control.cpp"),
              HasSubstr("void drive_on(Context& context"));
  EXPECT_THAT(changed("follow: {}", "drive_on", "test/control_test.cpp"),
              HasSubstr("drive_on(context, in, memory, out)"));
  EXPECT_THAT(changed("motion: Velocity", "speed", "src/control.cpp"),
              HasSubstr("out.speed = steer(in.line"));
  EXPECT_THAT(
      changed("sensor:", "eyes", "src/sensor.cpp"),
      AllOf(HasSubstr("#include \"robot/eyes.hpp\""), HasSubstr("namespace line_follower::robot::eyes {")));
  EXPECT_THAT(changed("linear: float64", "ahead", "src/motor.cpp"),
              HasSubstr("in.velocity.ahead + in.velocity.angular"));
  EXPECT_THAT(changed("Velocity:", "Twist", "src/control.cpp"),
              HasSubstr("Twist steer(const LineReading& line"));
}

TEST(Rename, AsksAboutMembersThatOnlyACompilerKnows) {
  const std::string text = read_text(example("01_line_follower") / "spec.yaml");
  const Document document(text, grammar());
  const std::vector<Source> sources = sources_of(example("01_line_follower"));
  const Renaming renaming =
      rename(document, nullptr, document.lines().position(text.find("left: bool")), sources, "port");
  const auto unsure = std::count_if(renaming.edits.begin(), renaming.edits.end(),
                                    [](const TextEdit& one) { return !one.sure; });
  EXPECT_GT(unsure, 0);
}

TEST(Rename, RefusesNamesThatAreTakenOrNotAllowed) {
  const std::string text = read_text(example("01_line_follower") / "spec.yaml");
  const Document document(text, grammar());
  const Position init = document.lines().position(text.find("init:"));
  EXPECT_THAT(rename(document, nullptr, init, {}, "follow").problem.value(),
              HasSubstr("'follow' is taken by the behaviour on line"));
  EXPECT_THAT(rename(document, nullptr, init, {}, "two words").problem.value(), HasSubstr("two words"));
  EXPECT_TRUE(rename(document, nullptr, init, {}, "end").problem);
  EXPECT_TRUE(rename(document, nullptr, init, {}, "while").problem);
  EXPECT_TRUE(rename(document, nullptr, {0, 0}, {}, "x").problem);
  const Position control = document.lines().position(text.find("control:"));
  EXPECT_TRUE(rename(document, nullptr, control, {}, "brain").problem);
}

TEST(Definition, LeadsFromUseToDefinitionAndFromBehaviourToFunctionAndBack) {
  const std::string text = read_text(example("01_line_follower") / "spec.yaml");
  const Document document(text, grammar());
  const std::vector<Source> sources = sources_of(example("01_line_follower"));
  const auto at = [&](const std::string& word, std::size_t behind) {
    return document.lines().position(text.find(word) + behind);
  };
  const auto use = definition(document, at("next: follow", 8), sources);
  ASSERT_EQ(use.size(), 1U);
  EXPECT_EQ(use[0].path, "");
  EXPECT_EQ(use[0].range.start, at("follow: {}", 0));
  const auto function = definition(document, at("follow: {}", 1), sources);
  ASSERT_EQ(function.size(), 1U);
  EXPECT_EQ(function[0].path, "src/control.cpp");
  for (const Source& source : sources) {
    if (source.path != "src/control.cpp") continue;
    const Lines lines(source.text);
    const auto back = definition_from_code(document, source, function[0].range.start);
    ASSERT_EQ(back.size(), 1U);
    EXPECT_EQ(back[0].range.start, at("follow: {}", 0));
    const auto buffer =
        definition_from_code(document, source, lines.position(source.text.find("out.motion") + 5));
    ASSERT_EQ(buffer.size(), 1U);
    EXPECT_EQ(buffer[0].range.start, at("motion: Velocity", 0));
  }
}

TEST(Fixes, FollowHintsAndAddWhatIsMissing) {
  std::string text = read_text(example("01_line_follower") / "spec.yaml");
  const std::size_t next = text.find("next: follow");
  text.replace(next, 12, "next: folow");
  const Document document(text, grammar());
  diagnostics::Diagnostics out("spec.yaml", text);
  (void)spec::parse(out);
  const Position at = document.lines().position(next + 7);
  const std::vector<Fix> offers = fixes(document, {at, at}, out.sorted());
  ASSERT_EQ(offers.size(), 1U);
  EXPECT_EQ(offers[0].edits[0].text, "follow");
  EXPECT_THAT(codes(applied(text, offers[0].edits, "")),
              ::testing::Not(::testing::Contains(HasSubstr("E101"))));
}

TEST(Fixes, StaleIsWrittenWhereTheWarningIs) {
  std::string text = read_text(example("01_line_follower") / "spec.yaml");
  const std::size_t stale = text.find("        stale:");
  text.erase(stale, text.find('\n', stale) + 1 - stale);
  diagnostics::Diagnostics out("spec.yaml", text);
  (void)spec::parse(out);
  const Document document(text, grammar());
  const auto all = out.sorted();
  const auto warning =
      std::find_if(all.begin(), all.end(), [](const auto& one) { return one.code == "W324"; });
  ASSERT_NE(warning, all.end());
  const Range range = range_of(document, warning->span);
  const std::vector<Fix> offers = fixes(document, range, all);
  ASSERT_GE(offers.size(), 2U);
  for (std::size_t one : {0U, 1U})
    EXPECT_EQ(codes(applied(text, offers[one].edits, "")).size(), codes(text).size() - 1)
        << applied(text, offers[one].edits, "");
}

/// A control subsystem with one behaviour, and the text after the offered correction of `code`.
std::string corrected(const std::string& behaviour, const std::string& code,
                      const std::string& channels = "") {
  const std::string text =
      "tessera: 1\nsystem: s\nagents:\n  a:\n    control:\n      rate: 1 Hz\n      memory: { n: int32 }\n"
      "      behaviours:\n        work:" +
      behaviour + "\n" + channels;
  diagnostics::Diagnostics out("spec.yaml", text);
  (void)spec::parse(out);
  const Document document(text, grammar());
  const Range all{{0, 0}, {1000, 0}};
  for (const Fix& offer : fixes(document, all, out.sorted()))
    if (offer.code == code) return applied(text, offer.edits, "");
  return render(out);
}

TEST(Fixes, RouteErrorsAndEndListsInEveryStyle) {
  for (const char* behaviour :
       {" { error: memory.n > 3, terminal: memory.n > 1, next: work }",
        " { error: memory.n > 3, terminal: memory.n > 1, next: [work] }",
        " { error: memory.n > 3, terminal: memory.n > 1 }",
        "\n          error: memory.n > 3\n          terminal: memory.n > 1\n          next:\n            - "
        "work",
        "\n          error: memory.n > 3\n          terminal: memory.n > 1\n          next: work"}) {
    const std::string better = corrected(behaviour, "W313");
    EXPECT_THAT(better, HasSubstr("{ to: work, when: error }"));
    for (const std::string& code : codes(better))
      EXPECT_FALSE(code.starts_with("E") || code.starts_with("W313")) << code << better;
  }
  for (const char* behaviour : {" { terminal: memory.n > 1, next: [{ to: work, when: memory.n > 2 }] }",
                                "\n          terminal: memory.n > 1\n          next:\n            - { to: "
                                "work, when: memory.n > 2 }"}) {
    const std::string better = corrected(behaviour, "W312");
    for (const std::string& code : codes(better))
      EXPECT_FALSE(code.starts_with("E") || code.starts_with("W312")) << code << better;
  }
}

TEST(Fixes, LimitWaitingAndWriteTheSafeCommand) {
  const Typed channel(
      "tessera: 1\nsystem: s\nchannels:\n  - { from: a.b.c, to: d.e.f, rec‸eive: blocking }\n");
  const Document one(channel.text, grammar());
  const auto wait = fixes(one, {channel.cursor, channel.cursor}, {});
  ASSERT_EQ(wait.size(), 1U);
  EXPECT_THAT(applied(channel.text, wait[0].edits, ""), HasSubstr("receive: blocking, timeout: 200 ms }"));
  const Typed effector(
      "agents:\n  a:\n    effectors:\n      mo‸tor:\n        rate: 1 Hz\n        real: { left: float64, on: "
      "bool }\n");
  const Document two(effector.text, grammar());
  const auto safe = fixes(two, {effector.cursor, effector.cursor}, {});
  ASSERT_EQ(safe.size(), 1U);
  EXPECT_THAT(applied(effector.text, safe[0].edits, ""),
              HasSubstr("        safe: { left: 0, on: false }\n        rate: 1 Hz"));
}

}  // namespace
}  // namespace tessera::language
