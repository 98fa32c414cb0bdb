#include <gmock/gmock.h>

#include "examples.hpp"
#include "spec/model/former_routes.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// One control subsystem with the behaviours `work`, as given, and `rest`.
std::string with_work(const std::string& work) {
  return "tessera: 1\nsystem: s\nagents:\n  a:\n    control:\n      rate: 1 Hz\n      memory: { n: int32 }\n"
         "      behaviours:\n        work:" +
         work + "\n        rest: { terminal: true, next: end }\n";
}

struct Migrated {
  std::string text;
  std::vector<std::string> by_hand;
};

Migrated migrated(const std::string& text) {
  const Document document(text, grammar());
  const std::optional<Migration> migration = migrate(document);
  if (!migration) return {"it has errors", {}};
  std::vector<TextEdit> edits;
  for (const Migration::Step& step : migration->steps) edits.push_back(step.edit);
  Migrated done{edited(document, edits), {}};
  for (const Migration::ByHand& one : migration->by_hand)
    done.by_hand.push_back(one.behaviour + ": " + one.why);
  return done;
}

struct Style {
  const char* before;
  const char* after;
};

/// Comments, quotes, anchors, order and style stay.
const std::vector<Style> styles{
    {" { terminal: memory.n > 1, next: rest }",
     " { terminal: memory.n > 1, next: [{ to: rest, when: error }, rest] }"},
    {" { terminal: memory.n > 1, next: rest }  # until it is done",
     " { terminal: memory.n > 1, next: [{ to: rest, when: error }, rest] }  # until it is done"},
    {" { terminal: memory.n > 1, next: \"rest\" }",
     " { terminal: memory.n > 1, next: [{ to: rest, when: error }, \"rest\"] }"},
    {" { terminal: memory.n > 1, next: { to: rest } }",
     " { terminal: memory.n > 1, next: [{ to: rest, when: error }, { to: rest }] }"},
    {" { terminal: memory.n > 1, next: &n rest }",
     " { terminal: memory.n > 1, next: [{ to: rest, when: error }, &n rest] }"},
    {" { terminal: memory.n > 1, next: [rest] }",
     " { terminal: memory.n > 1, next: [{ to: rest, when: error }, rest] }"},
    {" { terminal: { many: memory.n > 1, few: memory.n < 0 },\n"
     "          next: [ # ], too\n            { to: end, when: many },  # [1, 2]\n            rest ] }",
     " { terminal: { many: memory.n > 1, few: memory.n < 0 },\n"
     "          next: [ # ], too\n            { to: end, when: many },  # [1, 2]\n"
     "            { to: rest, when: error }, rest ] }"},
    {"\n          terminal: { many: memory.n > 1 }\n          next:  # why\n            - { to: end, when: "
     "many }\n"
     "            # in all other cases\n            - rest  # here",
     "\n          terminal: { many: memory.n > 1 }\n          next:  # why\n            - { to: end, when: "
     "many }\n"
     "            # in all other cases\n            - { to: rest, when: error }\n            - rest  # here"},
    {"\n          terminal: memory.n > 1\n          next:\n          - rest",
     "\n          terminal: memory.n > 1\n          next:\n          - { to: rest, when: error }\n          "
     "- rest"},
    {"\n          terminal: memory.n > 1\n          next: rest",
     "\n          terminal: memory.n > 1\n          next: [{ to: rest, when: error }, rest]"},
    // It never ends as terminal: the entry without `when` was for failures alone.
    {" { next: rest }", " { next: { to: rest, when: error } }"},
    {" { error: { lost: memory.n > 3 }, next: rest }",
     " { error: { lost: memory.n > 3 }, next: { to: rest, when: error } }"},
    // A named error keeps its own way, and what came later stays behind.
    {" { terminal: memory.n > 1, error: { lost: memory.n > 3 }, next: [{ to: rest, when: lost }, work] }",
     " { terminal: memory.n > 1, error: { lost: memory.n > 3 }, next: [{ to: rest, when: lost }, "
     "{ to: work, when: error }, work] }"},
    {" { terminal: memory.n > 1, next: [work, { to: rest, when: error }] }",
     " { terminal: memory.n > 1, next: [{ to: work, when: error }, work, { to: rest, when: error }] }"},
    {" { terminal: memory.n > 1, next: [end, { to: rest, when: error }] }",
     " { terminal: memory.n > 1, next: [{ to: end, when: error }, end, { to: rest, when: error }] }"},
    // Both conditions lead to the same behaviour.
    {" { terminal: memory.n > 1, next: [{ to: rest, when: memory.n > 5 }, rest] }",
     " { terminal: memory.n > 1, next: [{ to: rest, when: error }, { to: rest, when: memory.n > 5 }, rest] "
     "}"},
};

TEST(Migration, KeepsCommentsOrderAndStyle) {
  for (const Style& style : styles) {
    SCOPED_TRACE(style.before);
    const Migrated once = migrated(with_work(style.before));
    EXPECT_EQ(once.text, with_work(style.after));
    EXPECT_THAT(once.by_hand, IsEmpty());
    EXPECT_EQ(migrated(once.text).text, once.text) << "a second time nothing is left to do";
  }
}

TEST(Migration, KeepsTheLineEndsOfWindows) {
  std::string text = with_work("\n          terminal: memory.n > 1\n          next:\n            - rest");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  const std::string after = migrated(text).text;
  EXPECT_THAT(after, HasSubstr("\r\n            - { to: rest, when: error }\r\n            - rest\r\n"));
}

TEST(Migration, ChangesNothingThatMeansTheSame) {
  for (const char* work : {" {}", " { terminal: memory.n > 1 }", " { terminal: memory.n > 1, next: end }",
                           " { terminal: memory.n > 1, next: [{ to: rest, when: error }, rest] }",
                           " { next: { to: rest, when: error } }",
                           " { terminal: { many: memory.n > 1 }, next: [{ to: rest, when: many }, end] }"}) {
    SCOPED_TRACE(work);
    EXPECT_EQ(migrated(with_work(work)).text, with_work(work));
    EXPECT_THAT(migrated(with_work(work)).by_hand, IsEmpty());
  }
}

TEST(Migration, LeavesToTheAuthorWhatAConditionDecided) {
  const std::string text =
      with_work(" { terminal: memory.n > 1, next: [{ to: rest, when: memory.n > 5 }, work] }");
  EXPECT_EQ(migrated(text).text, text);
  EXPECT_THAT(migrated(text).by_hand,
              ElementsAre("a.control.work: a condition of 'next' decided where a failure led"));
}

TEST(Migration, LeavesToTheAuthorTextsThatBelongToOthers) {
  const std::string shared =
      "tessera: 1\nsystem: s\nagents:\n  a:\n    control:\n      rate: 1 Hz\n      memory: { n: int32 }\n"
      "      behaviours:\n        one: { terminal: memory.n > 1, next: &list [two] }\n"
      "        two: { terminal: memory.n > 2, next: *list }\n";
  const Migrated done = migrated(shared);
  EXPECT_THAT(done.text, HasSubstr("next: &list [{ to: two, when: error }, two] }"));
  EXPECT_THAT(done.text, HasSubstr("next: *list }"));
  EXPECT_EQ(migrated(done.text).text, done.text);
  const std::string word =
      "tessera: 1\nsystem: s\nagents:\n  a:\n    control:\n      rate: 1 Hz\n      memory: { n: int32 }\n"
      "      behaviours:\n        one: { terminal: memory.n > 1, next: &to two }\n"
      "        two: { terminal: memory.n > 2, next: *to }\n";
  EXPECT_THAT(migrated(word).text, HasSubstr("next: [{ to: two, when: error }, &to two] }"));
  EXPECT_THAT(migrated(word).text, HasSubstr("next: [{ to: two, when: error }, *to] }"));
}

TEST(Migration, OfSubsystemsOfOneTextWritesItOnce) {
  const std::string text =
      "tessera: 1\nsystem: s\nagents:\n  a:\n    control: &c\n      rate: 1 Hz\n      memory: { n: int32 }\n"
      "      behaviours:\n        one: { terminal: memory.n > 1, next: two }\n        two: {}\n"
      "  b: { control: *c }\n";
  const std::string after = migrated(text).text;
  EXPECT_THAT(after, HasSubstr("one: { terminal: memory.n > 1, next: [{ to: two, when: error }, two] }"));
  EXPECT_EQ(after.size(), text.size() + std::string("[{ to: two, when: error }, ]").size());
}

TEST(Migration, RefusesATextWithErrors) {
  EXPECT_EQ(migrated(with_work(" { terminal: memory.m, next: rest }")).text, "it has errors");
  EXPECT_EQ(migrated("").text, "it has errors");
  EXPECT_EQ(migrated("tessera: 1\n").text, "it has errors");
}

/// The notes about a text.
std::vector<diagnostics::Diagnostic> notes_of(const std::string& text) {
  diagnostics::Diagnostics out("spec.yaml", text);
  const std::optional<spec::Model> model = spec::parse(out);
  EXPECT_TRUE(model && !out.has_errors()) << render(out);
  diagnostics::Diagnostics notes("spec.yaml", text);
  if (model) note_former_routes(*model, notes);
  return notes.sorted();
}

TEST(Migration, IsNotedOncePerSubsystemUntilAFailureIsRouted) {
  const std::string text = with_work(" { terminal: memory.n > 1, next: rest }");
  const std::vector<diagnostics::Diagnostic> notes = notes_of(text);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].severity, diagnostics::Severity::note);
  EXPECT_EQ(notes[0].code, "N330");
  EXPECT_EQ(notes[0].message,
            "after a failure 'work' does not go on to 'rest': the subsystem ends, and the run fails");
  EXPECT_THAT(notes[0].hint, HasSubstr("add { to: rest, when: error } to its 'next'"));
  EXPECT_THAT(notes_of(migrated(text).text), IsEmpty());
  EXPECT_THAT(notes_of(with_work(" { terminal: memory.n > 1, next: [{ to: end, when: error }, rest] }")),
              IsEmpty());
  EXPECT_THAT(notes_of(with_work(" { terminal: true, next: rest }")), IsEmpty());
  EXPECT_THAT(notes_of(with_work(" { next: rest }")), IsEmpty()) << "W315 is about it";
}

/// There was nothing for each member of a fleet when errors took other entries.
TEST(Migration, SaysNothingAboutBehavioursForEachMember) {
  const std::string text = R"(tessera: 1
system: s
templates: { cart: { control: { rate: 1 Hz, outputs: { ask: bool }, behaviours: { go: {} } } } }
agents:
  cart: { use: cart, count: 2 }
  dock:
    control:
      rate: 1 Hz
      inputs: { ask: "bool[each cart]" }
      behaviours:
        wait: { terminal: any(in.ask.fresh), next: [{ to: "lend[i]", when: "in.ask[i].fresh" }, wait] }
        lend: { for: each cart, terminal: elapsed > 1 s, next: ["lend[i+1]", wait] }
channels: ["cart[i].control.ask -> dock.control.ask[i]"]
)";
  EXPECT_THAT(notes_of(text), IsEmpty());
  EXPECT_EQ(migrated(text).text, text);
}

TEST(Migration, IsNotedWhereAConditionTookErrorsBeforeTheirOwnEntry) {
  const std::vector<diagnostics::Diagnostic> notes =
      notes_of(with_work(" { terminal: memory.n > 1, next: [{ to: end, when: memory.n > 5 }, { to: work, "
                         "when: error }, rest] }"));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].code, "N332");
  EXPECT_THAT(notes[0].message, HasSubstr("'work'"));
}

TEST(Migration, IsOfferedWithTheNote) {
  const std::string text = with_work(" { terminal: memory.n > 1, next: rest }");
  const Document document(text, grammar());
  const std::vector<Fix> offers = fixes(document, {{0, 0}, {1000, 0}}, notes_of(text));
  ASSERT_EQ(offers.size(), 1U);
  EXPECT_EQ(offers[0].code, "N330");
  EXPECT_EQ(edited(document, offers[0].edits), migrated(text).text);
}

std::string with_repeated_lists() {
  return R"(tessera: 1
system: s
agents:
  robot:
    control:
      rate: 10 Hz
      inputs: { stop: bool }
      outputs: { motion: bool }
      behaviours:
        work: { send: [motion], receive: [stop], terminal: in.stop, next: [{ to: safe, when: error }, charge] }
        charge:
          next: [{ to: safe, when: error }, work]
          behaviours:
            ask:  { send: [motion], receive: [stop], terminal: in.stop, next: [{ to: back, when: error }, dock] }
            dock: { send: [motion], receive: [stop], terminal: in.stop, next: [{ to: back, when: error }, end] }   # slowly
            back: { send: [], receive: [], terminal: true, next: ask }
        safe: { send: [motion], receive: [stop], terminal: in.stop, next: [{ to: safe, when: error }, work] }
channels:
  - robot.control.motion -> robot.control.stop
)";
}

TEST(Shorter, GroupsHaveDefaultsOfTheirOwn) {
  const std::string spec = with_repeated_lists();
  const auto done = shortened(spec);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->text, R"(tessera: 1
system: s
agents:
  robot:
    control:
      rate: 10 Hz
      inputs: { stop: bool }
      outputs: { motion: bool }
      send: [motion]
      receive: [stop]
      on_error: safe
      behaviours:
        work: { terminal: in.stop, next: charge }
        charge:
          next: work
          on_error: back
          behaviours:
            ask:  { terminal: in.stop, next: dock }
            dock: { terminal: in.stop, next: end }   # slowly
            back: { send: [], receive: [], terminal: true, next: ask }
        safe: { terminal: in.stop, next: [{ to: safe, when: error }, work] }
channels:
  - robot.control.motion -> robot.control.stop
)");
}

}  // namespace
}  // namespace tessera::language
