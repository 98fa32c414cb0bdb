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

// An agent has the name of a value.
const std::string lending = R"(tessera: 1
system: s
agents:
  dock:
    control:
      rate: 10 Hz
      inputs: { asks: bool }
      outputs: { answer: bool }
      memory: { lent_to: { values: [nobody, a, b] }, mode: { values: [nobody, all] }, served: { counts: 0..4 }, last: int32 }
      behaviours:
        wait:
          terminal: true
          next:
            - { to: lend, when: in.asks && memory.lent_to == nobody && all != memory.mode, sets: { served: +1, lent_to: a } }
            - { to: wait, when: memory.served == 4, sets: { served: 0, lent_to: nobody } }
            - wait
        lend: { sets: { lent_to: b }, terminal: memory.lent_to not_eq a, next: wait }
  a:
    control:
      rate: 10 Hz
      inputs: { nobody: bool }
      outputs: { ask: bool }
      behaviours: { run: {} }
channels:
  - a.control.ask -> dock.control.asks
  - dock.control.answer -> a.control.nobody
properties:
  - { never: dock.control.memory.lent_to == a and a.control.run.in }
  - { reachable: "dock.control.memory.served >= 3 and not dock.control.memory.lent_to != a" }
)";

const std::string function = R"(#include "dock/control.hpp"
namespace s::dock::control {
void wait(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const int a = 1;
  if (memory.lent_to == Memory::LentTo::a) out.answer = a == 1;
  switch (Memory::LentTo(memory.lent_to)) {
    case Memory::LentTo::nobody: break;
    default: break;
  }
  if (memory.mode == Memory::Mode::nobody) out.answer = false;
}
}  // namespace s::dock::control
void other() { using LentTo = s::dock::control::Memory::LentTo; (void)LentTo::a; }
)";

std::string lending_with(const std::string& old, const std::string& with) {
  std::string in = lending;
  const std::size_t at = in.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? in : in.replace(at, old.size(), with);
}

std::vector<std::string> proposals_in(const std::string& with_cursor) {
  const Typed typed(with_cursor);
  const Document document(typed.text, grammar());
  std::vector<std::string> labels;
  for (const Proposal& one : complete(document, typed.cursor)) labels.push_back(one.label);
  return labels;
}

/// The first place of a word.
Position at_word(const std::string& in, const std::string& word, std::size_t skip = 0) {
  return Lines(in).position(in.find(word) + skip);
}

struct Renamed {
  std::string spec, source;
  std::size_t unsure = 0;
};
Renamed renamed_at(const std::string& in, Position at, const std::string& name) {
  const Document document(in, grammar());
  const Source source{"src/dock/control.cpp", function};
  const Renaming done = rename(document, nullptr, at, std::span(&source, 1), name);
  if (done.problem) return {"refused: " + *done.problem, "", 0};
  Renamed result{edited(document, done.edits), edited(source, done.edits), 0};
  for (const TextEdit& edit : done.edits) result.unsure += edit.sure ? 0 : 1;
  return result;
}

std::string problems_of(const std::string& in) {
  diagnostics::Diagnostics out("spec.yaml", in);
  (void)spec::parse(out);
  return out.has_errors() ? render(out) : "";
}

std::string with_edit(const std::string& in, const std::string& edits) {
  const auto read = edits_of(nlohmann::ordered_json::parse(edits));
  EXPECT_TRUE(read) << edits;
  const Document document(in, grammar());
  const Renaming done = edit(document, *read, {});
  return done.problem ? "refused: " + *done.problem : edited(document, done.edits);
}

TEST(KeptMemory, IsCompleted) {
  EXPECT_EQ(problems_of(lending), "");
  EXPECT_THAT(proposals_in(lending_with("{ lent_to: b }", "{ ‸ }")),
              ElementsAre("lent_to", "mode", "served"));
  EXPECT_THAT(proposals_in(lending_with("{ lent_to: b }", "{ lent_to: ‸ }")),
              ElementsAre("nobody", "a", "b"));
  EXPECT_THAT(proposals_in(lending_with("{ lent_to: b }", "{ served: ‸ }")),
              ElementsAre("+1", "-1", "0", "1", "2", "3", "4"));
  EXPECT_THAT(proposals_in(lending_with("{ lent_to: b }", "{ served: +‸ }")), ElementsAre("1"));
  EXPECT_THAT(proposals_in(lending_with("lent_to: nobody }", "lent_to: n‸ }")),
              ElementsAre("nobody", "a", "b"));
  EXPECT_THAT(proposals_in(lending_with("memory.lent_to not_eq a", "memory.lent_to == ‸")),
              ElementsAre("nobody", "a", "b"));
  EXPECT_THAT(proposals_in(lending_with("memory.lent_to not_eq a", "memory.lent_to not_eq ‸")),
              ElementsAre("nobody", "a", "b"));
  EXPECT_THAT(proposals_in(lending_with("memory.served == 4", "in.asks || memory.served >= ‸")),
              ElementsAre("0", "1", "2", "3", "4"));
  EXPECT_THAT(proposals_in(lending_with("memory.served == 4", "memory.mode != ‸")),
              ElementsAre("nobody", "all"));
  EXPECT_THAT(proposals_in(lending_with("memory.served == 4", "in.asks == ‸")), Contains("memory"));
  EXPECT_THAT(proposals_in(lending_with("lent_to == a and", "lent_to == ‸ and")),
              ElementsAre("nobody", "a", "b"));
  EXPECT_THAT(proposals_in(lending_with("memory.lent_to == a and", "‸ == a and")), Contains("memory"));
  EXPECT_THAT(proposals_in(lending_with("lent_to == a and", "‸ and")),
              ElementsAre("lent_to", "mode", "served"));
  EXPECT_THAT(proposals_in(lending_with("last: int32", "last: { ‸ }")), Contains("values"));
  EXPECT_THAT(proposals_in(lending_with("{ lent_to: b }, terminal", "{ lent_to: b }, ‸ }, next: {terminal")),
              Contains("terminal"));
}

TEST(KeptMemory, IsExplained) {
  const Document document(lending, grammar());
  const auto says = [&](const std::string& word, std::size_t skip = 0) {
    const auto found = explain(document, at_word(lending, word, skip));
    return found ? found->markdown : "";
  };
  EXPECT_THAT(says("lent_to: { values"), HasSubstr("**dock.control.lent_to** — memory cell"));
  EXPECT_THAT(says("lent_to: { values"), HasSubstr("`{ values: [nobody, a, b] }`"));
  EXPECT_THAT(says("lent_to: { values"), HasSubstr("In C++: `Memory::LentTo`"));
  EXPECT_THAT(says("lent_to: { values"), HasSubstr("Changed on lines 14, 15, 17."));
  EXPECT_THAT(says("b] }"), HasSubstr("`Memory::LentTo::b`\n\nSet on line 17."));
  EXPECT_THAT(says("served: { counts"), HasSubstr("`{ counts: 0..4 }`\n\nIn C++: `int`"));
  EXPECT_THAT(says("mode: { values"), HasSubstr("Nothing changes it."));
  EXPECT_THAT(says("last: int32"), Not(HasSubstr("hanges")));
  EXPECT_THAT(says("lent_to == a and", 11), HasSubstr("dock.control.lent_to.a"));
}

TEST(KeptMemory, IsRenamedWithItsEnumeration) {
  const Renamed done = renamed_at(lending, at_word(lending, "lent_to"), "holder");
  EXPECT_EQ(done.spec.find("lent_to"), std::string::npos) << done.spec;
  EXPECT_EQ(problems_of(done.spec), "");
  EXPECT_THAT(done.source, HasSubstr("if (memory.holder == Memory::Holder::a)"));
  EXPECT_THAT(done.source, HasSubstr("case Memory::Holder::nobody"));
  EXPECT_THAT(done.source, HasSubstr("using LentTo = s::dock::control::Memory::Holder;"));
  const Document document(done.spec, grammar());
  EXPECT_EQ(
      edited(document, rename(document, nullptr, at_word(done.spec, "holder == a and"), {}, "lent_to").edits),
      lending);
  // The name of an enumeration changes too if it is taken now.
  EXPECT_THAT(renamed_at(lending, at_word(lending, "last: int32"), "LentTo").source,
              HasSubstr("Memory::LentToValue::a"));
}

TEST(KeptMemory, ValuesAreRenamedWhereverTheyStand) {
  const std::string expected = [] {
    std::string text = lending;
    for (const auto& [old, with] :
         {std::pair<std::string, std::string>{"[nobody, a, b]", "[nobody, first, b]"},
          {"served: +1, lent_to: a", "served: +1, lent_to: first"},
          {"not_eq a", "not_eq first"},
          {"lent_to == a and", "lent_to == first and"},
          {"lent_to != a\"", "lent_to != first\""}})
      text.replace(text.find(old), old.size(), with);
    return text;
  }();
  for (const auto& [word, skip] : {std::pair<const char*, std::size_t>{"a, b]", 0},
                                   {"lent_to: a }", 9},
                                   {"not_eq a", 7},
                                   {"lent_to == a and", 11}}) {
    const Renamed done = renamed_at(lending, at_word(lending, word, skip), "first");
    EXPECT_EQ(done.spec, expected) << word;
    EXPECT_THAT(done.source, HasSubstr("Memory::LentTo::first) out.answer = a == 1"));
    EXPECT_EQ(done.unsure, 1U) << "LentTo::a behind an alias";
  }
  const Renamed nobody = renamed_at(lending, at_word(lending, "nobody"), "none");
  EXPECT_THAT(nobody.spec, HasSubstr("mode: { values: [nobody, all] }"));
  EXPECT_THAT(nobody.spec, HasSubstr("memory.lent_to == none && all != memory.mode"));
  EXPECT_THAT(nobody.spec, HasSubstr("inputs: { nobody: bool }"));
  EXPECT_THAT(nobody.source, HasSubstr("Memory::Mode::nobody"));
  EXPECT_THAT(renamed_at(lending, at_word(lending, "all]"), "every").spec, HasSubstr("every != memory.mode"));
  EXPECT_THAT(renamed_at(lending, at_word(lending, "a, b]"), "b").spec,
              HasSubstr("refused: 'b' is taken by the value"));
  EXPECT_THAT(renamed_at(lending, at_word(lending, "a, b]"), "in").spec, HasSubstr("refused"));
  // An agent of that name is another thing.
  const Renamed agent = renamed_at(lending, at_word(lending, "  a:\n", 2), "carrier");
  EXPECT_THAT(agent.spec, HasSubstr("lent_to == a and carrier.control.run.in"));
  EXPECT_EQ(problems_of(agent.spec), "");
}

TEST(KeptMemory, ChangesStayWhileAnEntryIsEdited) {
  const std::string at = R"("at":["agents","dock","control","behaviours","wait"])";
  const auto after = [&](const std::string& key, const std::string& fields) {
    return with_edit(lending, R"([{"do":"next",)" + at + (key.empty() ? "" : R"(,"key":")" + key + '"') +
                                  R"(,"fields":)" + fields + "}]");
  };
  EXPECT_THAT(after("1", R"({"when":""})"),
              HasSubstr("- { to: wait, sets: { served: 0, lent_to: nobody } }"));
  EXPECT_THAT(after("1", R"({"sets":""})"), HasSubstr("- { to: wait, when: memory.served == 4 }"));
  EXPECT_THAT(after("2", R"({"sets":"{ served: -1 }"})"), HasSubstr("- { to: wait, sets: { served: -1 } }"));
  EXPECT_THAT(after("1", R"({"sets":"{ served: 1 }"})"),
              HasSubstr("- { to: wait, when: memory.served == 4, sets: { served: 1 } }"));
  EXPECT_THAT(after("", R"({"to":"lend","when":"","sets":"{ served: +1 }"})"),
              HasSubstr("- { to: lend, sets: { served: +1 } }"));
  const std::string single = with_edit(
      lending,
      R"([{"do":"next","at":["agents","dock","control","behaviours","lend"],"key":"0","fields":{"sets":"{ mode: all }"}}])");
  EXPECT_THAT(single, HasSubstr("next: [{ to: wait, sets: { mode: all } }] }"));
  for (const std::string& text :
       {after("1", R"({"when":""})"), after("2", R"({"sets":"{ served: -1 }"})"), single})
    EXPECT_EQ(problems_of(text), "");
}

TEST(KeptMemory, GoesWithItsChanges) {
  const std::string served =
      with_edit(lending, R"([{"do":"remove","at":["agents","dock","control","memory","served"]}])");
  EXPECT_THAT(served, HasSubstr("sets: { lent_to: a } }"));
  EXPECT_THAT(served, HasSubstr("sets: { lent_to: nobody } }"));
  const std::string lent =
      with_edit(lending, R"([{"do":"remove","at":["agents","dock","control","memory","lent_to"]}])");
  EXPECT_THAT(lent, HasSubstr("lend: { terminal:"));
  EXPECT_THAT(lent, HasSubstr("sets: { served: +1 } }"));
}

TEST(KeptMemory, IsFoundFromCode) {
  const Document document(lending, grammar());
  const Source source{"src/dock/control.cpp", function};
  const auto defined = [&](const std::string& word, std::size_t skip) {
    const auto found =
        definition_from_code(document, source, Lines(function).position(function.find(word) + skip));
    return found.empty() ? std::string()
                         : lending.substr(document.lines().offset(found.front().range.start), 8);
  };
  EXPECT_EQ(defined("Memory::LentTo::a", 16), "a, b] },");
  EXPECT_EQ(defined("Memory::LentTo::a", 10), "lent_to:");
  EXPECT_EQ(defined("memory.lent_to", 8), "lent_to:");
  EXPECT_EQ(defined("a == 1", 0), "");
  const Position enumeration = Lines(function).position(function.find("LentTo"));
  EXPECT_FALSE(renameable(document, &source, enumeration));
  EXPECT_THAT(*rename(document, &source, enumeration, {}, "Holder").problem, HasSubstr("'lent_to'"));
}

}  // namespace
}  // namespace tessera::language
