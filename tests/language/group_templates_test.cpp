// Templates of groups: in everything that an editor asks.

#include <gmock/gmock.h>

#include "examples.hpp"
#include "language/names/sources.hpp"
#include "spec/parser.hpp"

namespace tessera::language::templates_of_groups {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

const std::string parked = R"(tessera: 1
system: s
templates:
  asking:
    with: [request, grant, lease]
    until: in.pause
    behaviours:
      ask: { send: [request], receive: [grant, pause], terminal: in.grant.fresh, next: wait }
      wait: { terminal: elapsed > lease, next: end }
  docking:
    with: [left]
    on_error: retreat
    behaviours:
      dock: { use: asking, with: { request: ask_dock, grant: left, lease: 2 s }, next: leave }
      leave: { terminal: { gone: memory.steps == 2, stopped }, next: [{ to: end, when: gone }, leave] }
      retreat: { terminal: true, sets: { steps: 0 }, next: dock }
agents:
  robot:
    control:
      rate: 10 Hz
      inputs: { dock_left: bool, dock_right: bool, pause: bool }
      outputs: { ask_dock: bool, ask_desk: bool }
      memory: { steps: { counts: 0..2 } }
      parameters: { patience: 2 s }
      conditions: { stopped: in.pause }
      behaviours:
        first: { use: docking, with: { left: dock_left }, next: second }
        second: { use: docking, with: { left: dock_right }, next: third }
        third: { use: asking, with: { request: ask_desk, grant: dock_right, lease: parameters.patience }, next: first }
  other:
    control:
      rate: 10 Hz
      inputs: { order: bool, pause: bool }
      outputs: { wish: bool }
      behaviours:
        get: { use: asking, with: { request: wish, grant: order, lease: 1 s }, next: get }
  desk:
    control:
      rate: 10 Hz
      outputs: { bay: bool, berth: bool, halt: bool, order: bool }
      behaviours: { run: {} }
channels:
  - desk.control.bay -> robot.control.dock_left
  - desk.control.berth -> robot.control.dock_right
  - desk.control.halt -> robot.control.pause
  - desk.control.halt -> other.control.pause
  - desk.control.order -> other.control.order
properties:
  - { reachable: robot.control.first.dock.ask }
  - { reachable: other.control.get.ask }
)";

const Source parked_code{"src/control.cpp", R"(#include "robot/control.hpp"
namespace s::robot::control {
void first_dock_ask(Context&, const Inputs& in, Memory&, Outputs& out) { out.ask_dock = in.dock_left; }
void second_dock_ask(Context&, const Inputs&, Memory&, Outputs&) {}
void third_wait(Context&, const Inputs&, Memory&, Outputs&) {}
void first_leave(Context&, const Inputs&, Memory&, Outputs&) {}
}  // namespace s::robot::control
namespace s::other::control {
void get_ask(Context&, const Inputs&, Memory&, Outputs&) {}
}
)"};

std::string with(std::string in, const std::string& old, const std::string& now) {
  const std::size_t at = in.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? in : in.replace(at, old.size(), now);
}

Position at(const std::string& text, const std::string& word, std::size_t skip) {
  EXPECT_NE(text.find(word), std::string::npos) << word;
  return Lines(text).position(text.find(word) + skip);
}

struct Renamed {
  std::string specification, code, problem;
};

Renamed renamed(const std::string& text, const std::string& code, const std::string& word, std::size_t skip,
                const std::string& name) {
  const Document document(text, grammar());
  const Source source{"src/control.cpp", code};
  const Renaming done = rename(document, nullptr, at(text, word, skip), std::vector{source}, name);
  return {edited(document, done.edits), edited(source, done.edits), done.problem.value_or("")};
}

/// Renames to `name`, and back.
Renamed there(const std::string& word, std::size_t skip, const std::string& old, const std::string& name) {
  Renamed result = renamed(parked, parked_code.text, word, skip, name);
  EXPECT_EQ(result.problem, "") << old;
  diagnostics::Diagnostics out("spec.yaml", result.specification);
  (void)spec::parse(out);
  EXPECT_FALSE(out.has_errors()) << render(out) << result.specification;
  std::string moved = word;
  moved.replace(skip, old.size(), name);
  const Renamed back = renamed(result.specification, result.code, moved, skip, old);
  EXPECT_EQ(back.problem, "") << old;
  EXPECT_EQ(back.specification, parked) << old;
  EXPECT_EQ(back.code, parked_code.text) << old;
  return result;
}

std::vector<std::string> labels(const std::string& old, const std::string& now) {
  const Typed typed(with(parked, old, now));
  const Document document(typed.text, grammar());
  std::vector<std::string> all;
  for (const Proposal& one : complete(document, typed.cursor)) all.push_back(one.label);
  return all;
}

std::string hover(const std::string& word, std::size_t skip = 0) {
  const Document document(parked, grammar());
  const auto found = explain(document, at(parked, word, skip));
  return found ? found->markdown : "";
}

TEST(TemplatesOfGroups, TheTextOfTheseTestsIsRight) {
  diagnostics::Diagnostics out("spec.yaml", parked);
  (void)spec::parse(out);
  EXPECT_FALSE(out.has_errors()) << render(out);
}

TEST(TemplatesOfGroups, ABehaviourInThemIsRenamedInEachUse) {
  const Renamed ask = there("ask: { send", 0, "ask", "beg");
  EXPECT_THAT(ask.specification, AllOf(HasSubstr("beg: { send: [request]"), HasSubstr("first.dock.beg }"),
                                       HasSubstr("get.beg }"), HasSubstr("request: ask_dock")));
  EXPECT_THAT(ask.code, AllOf(HasSubstr("first_dock_beg("), HasSubstr("second_dock_beg("),
                              HasSubstr("get_beg("), HasSubstr("out.ask_dock")));
  EXPECT_THAT(there("dock: { use", 0, "dock", "berth").code, HasSubstr("second_berth_ask("));
  EXPECT_THAT(there("retreat\n", 0, "retreat", "back").specification,
              AllOf(HasSubstr("on_error: back"), HasSubstr("back: { terminal: true")));
  EXPECT_THAT(there("gone: memory", 0, "gone", "left_it").specification, HasSubstr("when: left_it"));
}

TEST(TemplatesOfGroups, TheirOwnNamesAreRenamed) {
  EXPECT_THAT(there("asking:\n", 0, "asking", "begging").specification,
              AllOf(HasSubstr("dock: { use: begging"), HasSubstr("third: { use: begging"),
                    HasSubstr("get: { use: begging")));
  const std::string grant = there("grant, lease]", 0, "grant", "leave_given").specification;
  EXPECT_THAT(grant,
              AllOf(HasSubstr("[request, leave_given, lease]"), HasSubstr("receive: [leave_given, pause]"),
                    HasSubstr("in.leave_given.fresh"), HasSubstr("leave_given: left"),
                    HasSubstr("leave_given: order"), Not(HasSubstr("grant"))));
  EXPECT_THAT(there("left]", 0, "left", "side").specification,
              AllOf(HasSubstr("grant: side"), HasSubstr("{ side: dock_left }")));
}

TEST(TemplatesOfGroups, WhatAWithGivesIsRenamed) {
  EXPECT_THAT(there("dock_left: bool", 0, "dock_left", "near_bay").specification,
              HasSubstr("{ left: near_bay }"));
  EXPECT_THAT(there("patience: 2 s", 0, "patience", "most").specification,
              HasSubstr("lease: parameters.most"));
  // It is named in a template that only this subsystem uses.
  EXPECT_THAT(there("ask_dock: bool", 0, "ask_dock", "call").specification, HasSubstr("request: call"));
  EXPECT_THAT(there("steps: {", 0, "steps", "count_of").specification,
              AllOf(HasSubstr("memory.count_of == 2"), HasSubstr("sets: { count_of: 0 }")));
  EXPECT_THAT(there("stopped: in", 0, "stopped", "halted").specification, HasSubstr("== 2, halted }"));
}

TEST(TemplatesOfGroups, RenamesThatWouldChangeAMeaningAreRefused) {
  const auto problem = [](const std::string& word, const std::string& name) {
    return renamed(parked, parked_code.text, word, 0, name).problem;
  };
  // `pause` in the template is that of both agents.
  EXPECT_THAT(problem("pause: bool }\n      outputs: { ask_dock", "halt"), Not(""));
  // A name of the template would hide what `in.pause` means.
  EXPECT_THAT(problem("grant, lease]", "pause"), Not(""));
  // A buffer would be taken for the name of the template.
  EXPECT_THAT(problem("steps: {", "left"), Not(""));
}

TEST(TemplatesOfGroups, DefinitionsAreFound) {
  const Document document(parked, grammar());
  const auto line_of = [&](const std::string& word, std::size_t skip) {
    const std::vector<Location> found = definition(document, at(parked, word, skip), {});
    return found.empty() ? 0U : found.front().range.start.line + 1;
  };
  EXPECT_EQ(line_of("use: asking, with: { request: wish", 5), 4U);
  EXPECT_EQ(line_of("receive: [grant", 10), 5U);
  EXPECT_EQ(line_of("grant: order", 0), 5U);
  EXPECT_EQ(line_of("grant: order", 7), 33U);
  EXPECT_EQ(line_of("control.get.ask", 12), 8U);
  EXPECT_EQ(line_of("next: wait", 6), 9U);
}

TEST(TemplatesOfGroups, WhatFitsIsProposed) {
  EXPECT_THAT(labels("use: docking, with: { left: dock_left }", "use: ‸"),
              UnorderedElementsAre("asking", "docking"));
  EXPECT_THAT(labels("{ left: dock_left }", "{ ‸ }"), UnorderedElementsAre("left"));
  EXPECT_THAT(labels("{ left: dock_left }", "{ left: ‸ }"),
              IsSupersetOf({"dock_left", "ask_dock", "parameters"}));
  EXPECT_THAT(labels("lease: parameters.patience", "lease: parameters.‸"), UnorderedElementsAre("patience"));
  EXPECT_THAT(labels("with: { left: dock_left }, next: second", "‸"),
              UnorderedElementsAre("with", "next", "start", "until", "on_error", "sets"));
  EXPECT_THAT(labels("next: leave }", "next: ‸ }"), UnorderedElementsAre("dock", "leave", "retreat", "end"));
  EXPECT_THAT(labels("on_error: retreat", "on_error: ‸"), UnorderedElementsAre("dock", "leave", "retreat"));
  EXPECT_THAT(labels("receive: [grant, pause]", "receive: [‸]"),
              AllOf(IsSupersetOf({"grant", "pause"}), Not(Contains("dock_left"))));
  EXPECT_THAT(labels("in.grant.fresh", "in.‸"), IsSupersetOf({"grant", "pause"}));
  EXPECT_THAT(labels("    until: in.pause\n", "    until: in.‸\n"), IsSupersetOf({"grant", "pause"}));
  EXPECT_THAT(labels("    on_error: retreat\n", "    ‸\n"),
              UnorderedElementsAre("start", "until", "on_error", "sets"));
  EXPECT_THAT(labels("robot.control.first.dock.ask", "‸"), Contains("robot.control.second.dock.wait"));
}

TEST(TemplatesOfGroups, HoverSaysWhatTheyAre) {
  EXPECT_THAT(hover("asking:\n"),
              AllOf(HasSubstr("template of a group"), HasSubstr("`grant`"), HasSubstr("Used on lines")));
  EXPECT_THAT(hover("grant, lease]"), AllOf(HasSubstr("name that a template takes"), HasSubstr("`order`")));
  EXPECT_THAT(hover("ask: { send"), AllOf(HasSubstr("first_dock_ask"), HasSubstr("get_ask")));
  EXPECT_THAT(hover("first: {"), AllOf(HasSubstr("group of behaviours"), HasSubstr("`dock`")));
}

}  // namespace
}  // namespace tessera::language::templates_of_groups
