// Behaviours within behaviours, and what there is for each member of a fleet: in everything that an editor asks.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "examples.hpp"
#include "language/edits/edit_json.hpp"
#include "language/edits/edits.hpp"
#include "language/names/sources.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

const std::string grouped = R"(tessera: 1
system: s
types: { Request: { urgent: bool } }
templates:
  carrier:
    control:
      rate: 10 Hz
      inputs: { grant: bool, pause: bool }
      outputs: { request: Request, done: bool }
      on_error: safe
      behaviours:
        work: { terminal: true, next: charge }
        charge:
          until: in.pause
          on_error: retreat
          start: ask
          next:
            - { to: safe, when: error }
            - { to: safe, when: until }
            - work
          behaviours:
            ask: { terminal: { granted: in.grant.fresh }, next: [{ to: dock, when: granted }, ask] }
            dock:
              next: end
              behaviours:
                turn: { terminal: true, next: roll }
                roll: { terminal: true, next: end }
            retreat: { terminal: true, next: ask }
        safe: {}
agents:
  robot: { use: carrier, count: 3 }
  desk:
    control:
      rate: 10 Hz
      inputs: { request: "Request[each robot]", done: "bool[each robot]" }
      outputs: { grant: "bool[each robot]", pause: "bool[each robot]" }
      memory: { lent_to: { values: [nobody, each robot] } }
      on_error: wait
      behaviours:
        wait:
          send: []
          receive: [request]
          terminal: any(in.request.fresh)
          next: [{ to: "lend[i]", when: "in.request[i].fresh" }, wait]
        lend:
          for: each robot
          sets: { lent_to: "robot[i]" }
          send: ["grant[i]"]
          receive: ["done[i]"]
          terminal: "in.done[i].fresh"
          next: [{ to: "lend[i]", when: "memory.lent_to != robot[i]" }, { to: wait, sets: { lent_to: nobody } }]
channels:
  - { from: "robot[i].control.request", to: "desk.control.request[i]" }
  - { from: "robot[i].control.done", to: "desk.control.done[i]", receive: blocking }
  - { from: "desk.control.grant[i]", to: "robot[i].control.grant", receive: blocking, timeout: 1 s }
  - { from: "desk.control.pause[i]", to: "robot[i].control.pause" }
properties:
  - { never: "robot[0].control.charge.dock.turn and robot[1].control.charge.dock" }
  - { never: "desk.control.lend[i] and desk.control.memory.lent_to != robot[i]" }
)";

const Source grouped_code{"src/control.cpp", R"(#include "carrier/control.hpp"
namespace s::carrier::control {
void work(Context&, const Inputs&, Memory&, Outputs&) {}
void charge_ask(Context&, const Inputs& in, Memory&, Outputs& out) { out.request.urgent = in.grant; }
void charge_dock_turn(Context&, const Inputs&, Memory&, Outputs&) {}
}  // namespace s::carrier::control
namespace s::desk::control {
void lend(Context& context, const Inputs& in, Memory&, Outputs& out) { out.grant[context.member] = in.request[0].urgent; }
}
)"};

std::string replaced_in(std::string in, const std::string& old, const std::string& with) {
  const std::size_t at = in.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? in : in.replace(at, old.size(), with);
}

std::vector<Proposal> proposals_at(const std::string& with_cursor) {
  const Typed typed(with_cursor);
  const Document document(typed.text, grammar());
  return complete(document, typed.cursor);
}

std::vector<std::string> labels_at(const std::string& old, const std::string& with) {
  std::vector<std::string> labels;
  for (const Proposal& one : proposals_at(replaced_in(grouped, old, with))) labels.push_back(one.label);
  return labels;
}

Position place_of(const std::string& in, const std::string& word, std::size_t skip = 0) {
  EXPECT_NE(in.find(word), std::string::npos) << word;
  return Lines(in).position(in.find(word) + skip);
}

struct After {
  std::string specification, code;
};

After after_rename(const std::string& word, std::size_t skip, const std::string& name) {
  const Document document(grouped, grammar());
  const std::vector<Source> sources{grouped_code};
  const Renaming done = rename(document, nullptr, place_of(grouped, word, skip), sources, name);
  if (done.problem) return {"refused: " + *done.problem, {}};
  return {edited(document, done.edits), edited(grouped_code, done.edits)};
}

std::size_t errors_in(const std::string& text) {
  diagnostics::Diagnostics out("spec.yaml", text);
  (void)spec::parse(out);
  EXPECT_FALSE(out.has_errors()) << render(out) << text;
  // `in.done[i]` is received by the behaviour of each member.
  EXPECT_THAT(render(out), Not(HasSubstr("W371")));
  return out.error_count();
}

std::string hover_on(const std::string& word, std::size_t skip = 0) {
  const Document document(grouped, grammar());
  const auto found = explain(document, place_of(grouped, word, skip));
  return found ? found->markdown : "";
}

TEST(Groups, TheTextOfTheseTestsIsRight) { EXPECT_EQ(errors_in(grouped), 0U); }

TEST(Groups, KeysOfAGroupAndOfABehaviourAreTold) {
  EXPECT_THAT(labels_at("          start: ask\n", "          start: ask\n          ‸\n"),
              UnorderedElementsAre("sets"));
  EXPECT_THAT(labels_at("              next: end\n", "              next: end\n              ‸\n"),
              UnorderedElementsAre("on_error", "sets", "start", "until"));
  const auto behaviour = labels_at("retreat: { terminal: true,", "retreat: { terminal: true, ‸");
  EXPECT_THAT(behaviour, IsSupersetOf({"error", "send", "receive", "takes"}));
  EXPECT_THAT(behaviour, Not(Contains("until")));
  EXPECT_THAT(behaviour, Not(Contains("behaviours")));
  EXPECT_THAT(labels_at("safe: {}", "safe: { ‸ }"), IsSupersetOf({"behaviours", "terminal", "for"}));
}

TEST(Groups, NamesThatFitThePlaceAreCompleted) {
  EXPECT_THAT(labels_at("turn: { terminal: true, next: roll", "turn: { terminal: true, next: ‸"),
              ElementsAre("turn", "roll", "end"));
  EXPECT_THAT(labels_at("retreat: { terminal: true, next: ask", "retreat: { terminal: true, next: ‸"),
              ElementsAre("ask", "dock", "retreat", "end"));
  EXPECT_THAT(labels_at("{ terminal: true, next: charge", "{ terminal: true, next: ‸"),
              ElementsAre("work", "charge", "safe", "end"));
  EXPECT_THAT(labels_at("start: ask", "start: ‸"), ElementsAre("ask", "dock", "retreat"));
  EXPECT_THAT(labels_at("on_error: retreat", "on_error: ‸"), ElementsAre("ask", "dock", "retreat"));
  EXPECT_THAT(labels_at("until: in.pause", "until: in.‸"), ElementsAre("grant", "pause"));
  EXPECT_THAT(labels_at("when: until", "when: ‸"), IsSupersetOf({"until", "error", "in"}));
  EXPECT_THAT(labels_at("when: granted", "when: ‸"), AllOf(Contains("granted"), Not(Contains("until"))));
  EXPECT_THAT(labels_at("charge.dock.turn and", "charge.dock.‸ and"), ElementsAre("turn", "roll"));
}

TEST(Groups, AreExplainedWithTheFunctionsInThem) {
  EXPECT_THAT(hover_on("charge:\n"), AllOf(HasSubstr("**carrier.control.charge** — group of behaviours"),
                                           HasSubstr("Begins with `ask`. In it: `ask`, `dock`, `retreat`."),
                                           HasSubstr("`in.pause`"), HasSubstr("leads to `retreat`")));
  EXPECT_THAT(hover_on("turn: {"),
              AllOf(HasSubstr("**carrier.control.charge.dock.turn**"), HasSubstr("`void charge_dock_turn(")));
  EXPECT_THAT(hover_on("charge.dock.turn and", 12), HasSubstr("`void charge_dock_turn("));
}

TEST(Groups, LeadToTheirFunctionsAndBack) {
  const Document document(grouped, grammar());
  const std::vector<Source> sources{grouped_code};
  const auto to = definition(document, place_of(grouped, "turn: {"), sources);
  ASSERT_EQ(to.size(), 1U);
  EXPECT_EQ(to[0].path, "src/control.cpp");
  EXPECT_EQ(to[0].range.start, place_of(grouped_code.text, "charge_dock_turn", 12));
  const auto back = definition_from_code(document, grouped_code, place_of(grouped_code.text, "dock_turn", 6));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].range.start, place_of(grouped, "turn: {"));
  // `dock: ` of the next entry, the definition, two properties, the function
  EXPECT_EQ(references(document, nullptr, place_of(grouped, "dock:\n"), sources, true).size(), 5U);
}

TEST(Groups, AreRenamedInTheSpecificationAndInCpp) {
  const After group = after_rename("charge:\n", 0, "fill_up");
  EXPECT_THAT(group.specification,
              AllOf(HasSubstr("next: fill_up }"), HasSubstr("control.fill_up.dock.turn and"),
                    Not(HasSubstr("charge"))));
  EXPECT_THAT(group.code, AllOf(HasSubstr("void fill_up_ask("), HasSubstr("void fill_up_dock_turn(")));
  const After inner = after_rename("ask: {", 0, "beg");
  EXPECT_THAT(inner.specification, AllOf(HasSubstr("start: beg"), HasSubstr("when: granted }, beg]"),
                                         HasSubstr("retreat: { terminal: true, next: beg }")));
  EXPECT_THAT(inner.code, HasSubstr("void charge_beg("));
  for (const After* one : {&group, &inner}) EXPECT_EQ(errors_in(one->specification), 0U);
  EXPECT_THAT(after_rename("ask: {", 0, "dock").specification, HasSubstr("refused: 'dock' is taken"));
  // A name of another group is free.
  EXPECT_THAT(after_rename("turn: {", 0, "ask").specification,
              HasSubstr("ask: { terminal: true, next: roll }"));
}

TEST(Groups, StandNestedInTheOutline) {
  const Document document(grouped, grammar());
  const auto find = [](const std::vector<Heading>& in, const std::string& name) -> const Heading* {
    const auto found =
        std::find_if(in.begin(), in.end(), [&](const Heading& one) { return one.name == name; });
    return found == in.end() ? nullptr : &*found;
  };
  const std::vector<Heading> all = headings(document);
  const Heading* at = nullptr;
  const std::vector<Heading>* in = &all;
  for (const char* name : {"carrier", "control", "charge", "dock", "turn"}) {
    at = find(*in, name);
    ASSERT_NE(at, nullptr) << name;
    in = &at->inside;
  }
  EXPECT_EQ(find(find(all, "carrier")->inside, "control") != nullptr, true);
  EXPECT_EQ(find(find(find(all, "carrier")->inside, "control")->inside, "charge")->detail,
            "group of behaviours");
}

std::string moved_text(const std::string& in, const std::string& at, const std::string& group) {
  const auto read = edits_of(
      nlohmann::ordered_json::parse(R"([{"do":"move","at":)" + at + R"(,"text":")" + group + "\"}]"));
  EXPECT_TRUE(read) << at;
  const Document document(in, grammar());
  const Renaming done = edit(document, *read, {});
  return done.problem ? "refused: " + *done.problem : edited(document, done.edits);
}

const std::string in_control = R"("templates","carrier","control","behaviours")";

TEST(Groups, BehavioursAreMovedWithTheirComments) {
  const std::string commented =
      replaced_in(grouped, "            retreat: {", "            # back off\n            retreat: {");
  const std::string retreat = "[" + in_control + R"(,"charge","behaviours","retreat"])";
  const std::string out = moved_text(commented, retreat, "");
  EXPECT_THAT(
      out,
      HasSubstr(
          "        safe: {}\n        # back off\n        retreat: { terminal: true, next: ask }\nagents:"));
  EXPECT_EQ(moved_text(out, "[" + in_control + R"(,"retreat"])", "charge"), commented);
  EXPECT_THAT(moved_text(commented, retreat, "charge.dock"),
              HasSubstr("                roll: { terminal: true, next: end }\n                # back off\n   "
                        "             retreat: {"));
  const std::string group = moved_text(grouped, "[" + in_control + R"(,"charge","behaviours","dock"])", "");
  EXPECT_THAT(group, HasSubstr("        safe: {}\n        dock:\n          next: end\n          "
                               "behaviours:\n            turn: {"));
}

TEST(Groups, AMoveThatWouldLoseSomethingIsRefused) {
  const std::string charge = "[" + in_control + R"(,"charge"])";
  EXPECT_THAT(moved_text(grouped, charge, "charge.dock"),
              HasSubstr("refused: a group cannot stand in itself"));
  EXPECT_THAT(moved_text(grouped, "[" + in_control + R"(,"work"])", "nowhere"),
              HasSubstr("refused: the text has changed"));
  const std::string twice = replaced_in(grouped, "turn: {", "work: {");
  EXPECT_THAT(moved_text(twice, "[" + in_control + R"(,"work"])", "charge.dock"),
              HasSubstr("refused: 'work' is taken there"));
  const std::string alone = replaced_in(grouped, "                roll: { terminal: true, next: end }\n", "");
  EXPECT_THAT(
      moved_text(alone, "[" + in_control + R"(,"charge","behaviours","dock","behaviours","turn"])", ""),
      HasSubstr("is all that the group has"));
}

TEST(Groups, ARemovedBehaviourTakesTheEntriesOfItsGroupThatNameIt) {
  const auto read = edits_of(nlohmann::ordered_json::parse(R"([{"do":"remove","at":[)" + in_control +
                                                           R"(,"charge","behaviours","ask"]}])"));
  const Document document(grouped, grammar());
  const Renaming done = edit(document, *read, {});
  EXPECT_EQ(done.problem, std::nullopt);
  EXPECT_THAT(edited(document, done.edits),
              AllOf(Not(HasSubstr("start: ask")), Not(HasSubstr("next: ask")),
                    HasSubstr("retreat: { terminal: true }"), HasSubstr("dock:\n")));
  const auto each = edits_of(nlohmann::ordered_json::parse(
      R"([{"do":"remove","at":["agents","desk","control","behaviours","lend"]}])"));
  const Renaming gone = edit(document, *each, {});
  EXPECT_THAT(edited(document, gone.edits), HasSubstr("next: [wait]"));
}

TEST(Members, HaveAnIndexInProposals) {
  EXPECT_THAT(labels_at("{ to: \"lend[i]\", when: \"in.req", "{ to: \"‸\", when: \"in.req"),
              ElementsAre("wait", "lend[i]", "end"));
  const auto unquoted =
      proposals_at(replaced_in(grouped, "{ to: \"lend[i]\", when: \"in.req", "{ to: ‸, when: \"in.req"));
  ASSERT_EQ(unquoted.size(), 3U);
  EXPECT_EQ(unquoted[1].insert, "\"lend[i]\"");
  EXPECT_THAT(labels_at("send: [\"grant[i]\"]", "send: [\"‸\"]"),
              ElementsAre("grant[i]", "grant", "pause[i]", "pause"));
  EXPECT_THAT(labels_at("receive: [request]", "receive: [‸]"), ElementsAre("request", "done"));
  EXPECT_THAT(labels_at("in.done[i].fresh", "in.‸"), IsSupersetOf({"done[i]", "request[i]", "request"}));
  EXPECT_THAT(labels_at("in.done[i].fresh", "in.request[i].‸"), IsSupersetOf({"urgent", "fresh"}));
  EXPECT_THAT(labels_at("lent_to: \"robot[i]\"", "lent_to: \"‸\""),
              UnorderedElementsAre("robot[i]", "nobody"));
  EXPECT_THAT(labels_at("lent_to != robot[i]\" }, {", "lent_to != ‸\" }, {"),
              UnorderedElementsAre("robot[i]", "nobody"));
  EXPECT_THAT(labels_at("to: \"desk.control.request[i]\"", "to: \"desk.control.‸\""),
              ElementsAre("done[i]", "request[i]"));
  EXPECT_THAT(labels_at("for: each robot", "for: ‸"), ElementsAre("each robot"));
  EXPECT_THAT(labels_at("values: [nobody, each robot]", "values: [nobody, ‸]"), ElementsAre("each robot"));
  EXPECT_THAT(labels_at("\"Request[each robot]\"", "\"Request[‸]\""), ElementsAre("each robot"));
}

TEST(Members, FunctionsOfConditionsAreCompleted) {
  EXPECT_THAT(labels_at("any(in.request.fresh)", "‸"), IsSupersetOf({"any", "all", "count", "which", "in"}));
  EXPECT_THAT(labels_at("any(in.request.fresh)", "any(in.‸)"), IsSupersetOf({"request"}));
  EXPECT_THAT(labels_at("terminal: { granted: in.grant", "terminal: { granted: ‸"), Not(Contains("any")));
}

TEST(Members, NamesAndFleetsAreRenamedEverywhere) {
  const After fleet = after_rename("robot: {", 0, "cart");
  EXPECT_THAT(fleet.specification, Not(HasSubstr("robot")));
  const After behaviour = after_rename("lend:\n", 0, "give");
  EXPECT_THAT(behaviour.specification,
              AllOf(HasSubstr("to: \"give[i]\", when: \"in.req"), HasSubstr("to: \"give[i]\", when: \"mem"),
                    HasSubstr("control.give[i] and")));
  EXPECT_THAT(behaviour.code, HasSubstr("void give(Context&"));
  const After input = after_rename("inputs: { request: \"Re", 10, "wish");
  EXPECT_THAT(input.specification, AllOf(HasSubstr("desk.control.wish[i]"), HasSubstr("any(in.wish.fresh)"),
                                         HasSubstr("in.wish[i].fresh"), HasSubstr("receive: [wish]")));
  EXPECT_THAT(input.code, HasSubstr("in.wish[0].urgent"));
  for (const After* one : {&fleet, &behaviour, &input}) EXPECT_EQ(errors_in(one->specification), 0U);
}

TEST(Members, OutcomesAreCompletedInProperties) {
  EXPECT_THAT(labels_at("desk.control.lend[i] and", "desk.control.request[0].‸ and"), ElementsAre("fresh"));
  EXPECT_THAT(labels_at("desk.control.lend[i] and", "desk.control.grant[0].‸ and"), Contains("timed_out"));
  EXPECT_THAT(labels_at("desk.control.lend[i] and", "desk.control.‸ and"),
              IsSupersetOf({"lend[*]", "memory", "request[*]", "grant[*]"}));
}

TEST(Members, AreExplained) {
  EXPECT_THAT(hover_on("lend:\n"),
              AllOf(HasSubstr("one for each member of `robot`"), HasSubstr("`context.member`")));
  EXPECT_THAT(hover_on("done: \"bool[each"), HasSubstr("input buffer, one for each member of `robot`"));
}

}  // namespace
}  // namespace tessera::language
