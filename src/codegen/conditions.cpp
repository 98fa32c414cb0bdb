#include "codegen/conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "codegen/condition_text.hpp"
#include "codegen/cpp_text.hpp"
#include "codegen/emit.hpp"
#include "codegen/kept_memory.hpp"
#include "spec/model/endings.hpp"

namespace tessera::codegen {
namespace {

bool conditional(const spec::Behaviour& behaviour) {
  const spec::Next& first = behaviour.next.front();
  return behaviour.next.size() > 1 || first.when.kind != spec::When::Kind::always || first.may_be_blocked;
}

bool decided(const spec::Behaviour& behaviour) {
  return behaviour.terminal.kind != spec::Condition::Kind::never ||
         behaviour.error.kind != spec::Condition::Kind::never;
}

std::string goal(const spec::Subsystem& subsystem, const spec::Next& next) {
  if (!next.behaviour.valid()) return "end";
  const spec::Behaviour& to = subsystem.behaviours[next.behaviour];
  return next.member ? to.member->family + "[i]" : to.name;
}

/// "lend[i]", which stands for all members.
std::string subject(const spec::Behaviour& behaviour) {
  return written_name(behaviour) + (behaviour.member ? "[i]" : "");
}

bool names(const spec::Expression& expression, spec::Reference::Kind kind) {
  return std::ranges::any_of(references(expression),
                             [&](const spec::Reference& one) { return one.kind == kind; });
}

}  // namespace

Conditions::Conditions(const Project& project, const Unit& unit)
    : project_(project), unit_(unit), subsystem_(*unit.subsystem) {
  for (const spec::Behaviour& behaviour : subsystem_.behaviours) {
    Asked asked;
    if (!is_first(behaviour)) {  // the functions of the first are those of all
      asked_.push_back(std::move(asked));
      continue;
    }
    if (!behaviour.is_group()) asked.error = add_all(behaviour, behaviour.error, "error");
    if (behaviour.error.kind != spec::Condition::Kind::always)
      asked.terminal = add_all(behaviour, behaviour.terminal, "terminal");
    asked.next.resize(behaviour.next.size());
    const spec::Endings endings(behaviour);
    for (const spec::NextId entry : behaviour.next.ids()) {
      const spec::Next& next = behaviour.next[entry];
      if (!endings.can_be_taken(entry) || !is_first(next)) continue;
      if (next.when.kind == spec::When::Kind::expression)
        asked.next[entry] =
            add(fmt::format("{}_next_{}", function_name(behaviour), entry.value + 1), next.when.text,
                fmt::format("{} -> {}", subject(behaviour), goal(subsystem_, next)));
      if (next.when.kind == spec::When::Kind::terminal)
        functions_[asked.terminal[next.when.expression]].remembered = true;
      if (next.when.kind == spec::When::Kind::named_error)
        functions_[asked.error[next.when.expression]].remembered = true;
    }
    for (const spec::Skippable& output : behaviour.skippable)
      asked.send.push_back(
          add_all(behaviour, output.when, "send_" + written_name(subsystem_.outputs[output.output])));
    asked_.push_back(std::move(asked));
  }
}

Numbered<spec::ExpressionId, std::size_t> Conditions::add_all(const spec::Behaviour& behaviour,
                                                              const spec::Condition& condition,
                                                              std::string_view kind) {
  Numbered<spec::ExpressionId, std::size_t> added;
  if (condition.kind != spec::Condition::Kind::expressions) return added;
  for (const spec::Expression& expression : condition.expressions) {
    if (expression.until_of.valid()) {
      added.push_back(until_of(expression.until_of));
      continue;
    }
    if (behaviour.is_group()) {  // no text: one of its behaviours has led to `end`
      added.push_back(functions_.size());
      continue;
    }
    const std::string suffix = expression.name.empty() ? "" : '_' + expression.name;
    const std::string says =
        fmt::format("{}, {}{}{}", subject(behaviour), kind, suffix.empty() ? "" : " ", expression.name);
    added.push_back(add(fmt::format("{}_{}{}", function_name(behaviour), kind, suffix), expression, says));
  }
  return added;
}

/// One function for all behaviours of the group, which remember whether it held when they ended.
std::size_t Conditions::until_of(spec::BehaviourId group) {
  const auto [known, is_new] = untils_.emplace(group, functions_.size());
  const spec::Behaviour& what = subsystem_.behaviours[group];
  if (is_new) add(what.identifier() + "_until", *what.group->until, what.name + ", until");
  functions_[known->second].remembered = true;
  return known->second;
}

std::size_t Conditions::add(const std::string& name, const spec::Expression& expression, std::string says) {
  std::string unique = "tessera_" + name;
  for (int number = 2; !names_.insert(unique).second; ++number)
    unique = fmt::format("tessera_{}_{}", name, number);
  functions_.push_back({std::move(unique), &expression, std::move(says)});
  return functions_.size() - 1;
}

std::string Conditions::decide() const {
  if (std::ranges::none_of(subsystem_.behaviours, decided))
    return R"(  tessera::Outcome decide(std::uint16_t, bool failed) override {
    return failed ? tessera::Outcome::error : tessera::Outcome::go_on;
  }
)";
  std::string cases;
  for (const spec::BehaviourId behaviour : asked_.ids()) cases += decide_case(behaviour);
  const bool remembers = std::ranges::any_of(functions_, &Function::remembered);
  return fmt::format(R"(  tessera::Outcome decide(std::uint16_t behaviour, bool failed) override {{
{}    if (failed) return tessera::Outcome::error;
    switch ({}) {{
{}      default:
        return tessera::Outcome::go_on;
    }}
  }}
)",
                     remembers ? "    held_ = {};\n" : "", behaviour_text(subsystem_), cases);
}

std::string Conditions::decide_case(spec::BehaviourId behaviour) const {
  const spec::Behaviour& what = subsystem_.behaviours[behaviour];
  if (!decided(what) || !is_first(what) || what.is_group()) return {};
  std::string out = fmt::format("      case Behaviour::{}:\n", function_name(what));
  if (what.error.kind == spec::Condition::Kind::always)
    return out + "        return tessera::Outcome::error;\n";
  out += ask(asked_[behaviour].error, "error");
  if (what.terminal.kind == spec::Condition::Kind::always)
    return out + "        return tessera::Outcome::terminal;\n";
  out += ask(asked_[behaviour].terminal, "terminal");
  return out += "        return tessera::Outcome::go_on;\n";
}

/// Those asked for by name are evaluated first: several may hold.
std::string Conditions::ask(const std::vector<std::size_t>& functions, std::string_view outcome) const {
  std::string out;
  for (const std::size_t function : functions)
    if (const std::string& name = functions_[function].name; functions_[function].remembered)
      out += fmt::format("        held_.{0} = conditions_.{0}();\n", name);
  for (const std::size_t function : functions)
    out += fmt::format("        if ({}) return tessera::Outcome::{};\n",
                       functions_[function].remembered ? "held_." + functions_[function].name
                                                       : "conditions_." + functions_[function].name + "()",
                       outcome);
  return out;
}

std::string Conditions::route() const {
  if (std::ranges::none_of(subsystem_.behaviours, conditional))
    return "  int route(std::uint16_t, bool) override { return 0; }\n";
  std::string cases;
  for (const spec::BehaviourId behaviour : asked_.ids()) cases += route_case(behaviour);
  return fmt::format(R"(  int route(std::uint16_t behaviour, [[maybe_unused]] bool failed) override {{
    switch ({}) {{
{}      default:
        return 0;
    }}
  }}
)",
                     behaviour_text(subsystem_), cases);
}

/// The entries that an error or a failure can take come first. The others are then only asked after a terminal
/// ending.
std::string Conditions::route_case(spec::BehaviourId behaviour) const {
  const spec::Behaviour& what = subsystem_.behaviours[behaviour];
  if (!conditional(what) || !is_first(what)) return {};
  const spec::Endings endings(what);
  const auto taken = [&](spec::NextId entry, spec::Ending ending) {
    return endings.taken(entry, ending) != spec::Truth::never;
  };
  std::vector<Route> routes;
  std::optional<spec::NextId> last;  // of an error that no entry before it has taken
  for (const spec::NextId entry : what.next.ids()) {
    if (!taken(entry, spec::Ending::error) && !taken(entry, spec::Ending::failure)) continue;
    if (what.next[entry].when.kind == spec::When::Kind::named_error)
      routes.push_back({when_text(behaviour, entry), entry});
    else if (const std::string allowed = allowed_text(subsystem_, what.next[entry]); !allowed.empty())
      routes.push_back({fmt::format("if (failed && {}) ", allowed), entry});
    else if (!last)
      last = entry;
  }
  if (last) routes.push_back({"if (failed) ", *last});
  for (const spec::NextId entry : what.next.ids()) {
    if (!taken(entry, spec::Ending::terminal) || !is_first(what.next[entry])) continue;
    routes.push_back({when_text(behaviour, entry), entry});
    if (routes.back().when.empty()) break;
  }
  if (last && !endings.possible(spec::Ending::terminal)) routes.back().when.clear();
  return route_text(behaviour, std::move(routes));
}

std::string Conditions::return_text(const Route& route, const spec::Next& entry) {
  if (!entry.member) return fmt::format("{}return {};", route.when, route.entry.value);
  return fmt::format(
      "for (context_.member = 0; context_.member < {}; ++context_.member)\n          {}return {}{};",
      entry.member->count, route.when, route.entry.value == 0 ? "" : fmt::format("{} + ", route.entry.value),
      "static_cast<int>(context_.member)");
}

std::string_view Conditions::behaviour_text(const spec::Subsystem& subsystem) {
  const bool has_families =
      std::ranges::any_of(subsystem.behaviours, [](const auto& one) { return one.member.has_value(); });
  return has_families ? "behaviour_of(behaviour)" : "static_cast<Behaviour>(behaviour)";
}

std::string Conditions::route_text(spec::BehaviourId behaviour, std::vector<Route> routes) const {
  const spec::Behaviour& what = subsystem_.behaviours[behaviour];
  const bool ends = !routes.empty() && routes.back().when.empty();  // by an entry without condition
  while (ends && routes.size() > 1 && routes[routes.size() - 2].entry == routes.back().entry)
    routes.erase(routes.end() - 2);
  std::vector<Declaration> lines;
  for (const Route& route : routes)
    lines.push_back({return_text(route, what.next[route.entry]), goal(subsystem_, what.next[route.entry])});
  if (!ends) lines.push_back({"return -1;", ""});
  return fmt::format("      case Behaviour::{}:\n{}", function_name(what), declarations(lines, 8));
}

/// "if (held_.tessera_work_error_lost) ", or nothing if the entry has no condition.
std::string Conditions::when_text(spec::BehaviourId behaviour, spec::NextId entry) const {
  std::string asked = question(behaviour, entry);
  const std::string allowed = allowed_text(subsystem_, subsystem_.behaviours[behaviour].next[entry]);
  if (!allowed.empty()) asked = asked.empty() ? allowed : fmt::format("{} && {}", allowed, asked);
  return asked.empty() ? asked : fmt::format("if ({}) ", asked);
}

/// The question that the entry asks.
std::string Conditions::question(spec::BehaviourId behaviour, spec::NextId entry) const {
  const spec::When& when = subsystem_.behaviours[behaviour].next[entry].when;
  const Asked& asked = asked_[behaviour];
  switch (when.kind) {
    case spec::When::Kind::always:
    case spec::When::Kind::never:  // not asked
    case spec::When::Kind::error:  // asked by route_case
      return {};
    case spec::When::Kind::terminal:
      return fmt::format("held_.{}", functions_[asked.terminal[when.expression]].name);
    case spec::When::Kind::named_error:
      return fmt::format("held_.{}", functions_[asked.error[when.expression]].name);
    case spec::When::Kind::expression:
      return fmt::format("conditions_.{}()", functions_[asked.next[entry]].name);
  }
  return {};
}

bool Conditions::names_member() const {
  return std::ranges::any_of(
      functions_, [](const Function& function) { return function.expression->member.has_value(); });
}

bool Conditions::name(spec::Reference::Kind kind) const {
  return std::ranges::any_of(functions_,
                             [&](const Function& function) { return names(*function.expression, kind); });
}

std::string Conditions::members() const {
  if (functions_.empty()) return {};
  std::string held;
  for (const Function& function : functions_)
    if (function.remembered) held += fmt::format("    bool {} = false;\n", function.name);
  const std::string conditions =
      fmt::format("  yours::tessera_Conditions conditions_{{in, out, memory, parameters{}{}{}}};\n",
                  name(spec::Reference::Kind::elapsed) ? ", context_.in_behaviour" : "",
                  name(spec::Reference::Kind::index) ? ", context_.index" : "",
                  names_member() ? ", context_.member" : "");
  if (held.empty()) return conditions;
  return fmt::format(R"({}
  /// The named conditions that held when the iteration was decided; `route` asks for them.
  struct Held {{
{}  }} held_;
)",
                     conditions, held);
}

std::string Conditions::header_name() const {
  return unit_.definition->name + '/' + unit_.subsystem->name + ".conditions.hpp";
}

File Conditions::header() const {
  std::string functions;
  for (const Function& function : functions_)
    functions += fmt::format("  [[nodiscard]] bool {}() const;\n", function.name);
  const bool times = name(spec::Reference::Kind::elapsed), index = name(spec::Reference::Kind::index);
  const bool member = names_member();
  std::set<std::string> headers;
  if (index || member) headers.insert("<cstdint>");
  if (times) headers.insert("<tessera/time.hpp>");
  return {header_name(), fmt::format(R"({}#pragma once

{}#include "{}.data.hpp"

namespace {} {{

/// The conditions of the specification, with what they may name.
struct tessera_Conditions {{
  const Inputs& in;
  const Outputs& out;
  const Memory& memory;
  const Parameters& parameters;
{}{}{}{}
{}}};

}}  // namespace {}
)",
                                     project_.banner(), include_block(headers), subsystem_.name,
                                     unit_namespace(project_.model, unit_),
                                     times ? "  const tessera::Duration& elapsed;\n" : "",
                                     index ? "  const std::uint32_t& index;\n" : "",
                                     member ? "  const std::uint32_t& i;  // the member of the fleet\n" : "",
                                     values(), functions, unit_namespace(project_.model, unit_))};
}

std::string Conditions::values() const {
  std::set<std::string> named;
  for (const Function& function : functions_)
    for (const spec::Reference& one : references(*function.expression))
      if (one.kind == spec::Reference::Kind::value) named.insert(one.path.substr(one.path.rfind('.') + 1));
  std::string out;
  for (const std::string& value : named)
    out += "  static constexpr " + value_constant(project_.model, subsystem_, value) + "\n";
  return out.empty() ? out : "\n" + out;
}

void Conditions::add_marked(const Function& function, std::string& out) const {
  const std::string head =
      fmt::format("bool tessera_Conditions::{}() const {{ return static_cast<bool>(  // {}\n", function.name,
                  comment_text(function.says));
  const std::uint32_t line = std::max(function.expression->span.line, 1U);
  const diagnostics::SourceLine place = project_.model.sources.at(line);
  const std::string file = (std::filesystem::path(project_.spec_path).parent_path() / place.file).string();
  const auto marker = [&](std::uint32_t number) {
    return fmt::format("#line {} {}\n", number,
                       string_literal(place.file.empty() ? project_.spec_path : file));
  };
  // There is no line 0 for the head of an expression on line 1.
  out += place.line > 1 ? marker(place.line - 1) + head : head + marker(place.line);
  out += at_column(*function.expression, std::max(function.expression->span.column, 1U),
                   buffer_families(subsystem_)) +
         "); }\n";
}

/// Each line of the expression is a line of the file, and begins in column 1.
void Conditions::add_listed(const Function& function, File& file) const {
  const spec::Span& span = function.expression->span;
  const std::string text = at_column(*function.expression, 1, buffer_families(subsystem_));
  file.text +=
      fmt::format("// {}\nbool tessera_Conditions::{}() const {{ return static_cast<bool>(\n{}); }}\n",
                  comment_text(function.says), function.name, text);
  const auto lines = static_cast<std::uint32_t>(std::ranges::count(text, '\n')) + 1;
  const auto end = static_cast<std::uint32_t>(std::ranges::count(file.text, '\n'));
  for (std::uint32_t at = 0; at < lines; ++at)
    file.lines.push_back({end - lines + 1 + at, span.line + at, std::max(span.column, 1U)});
}

File Conditions::source() const {
  const std::string space = unit_namespace(project_.model, unit_);
  std::set<std::string> headers{"<cstdint>"};
  if (std::ranges::any_of(functions_, [](const Function& one) { return calls_library(*one.expression); }))
    headers.insert({"<algorithm>", "<array>", "<cmath>", "<cstdlib>", "<limits>", "<string>", "<string_view>",
                    "<tuple>", "<utility>"});
  File file{unit_path(unit_) + ".conditions.cpp",
            fmt::format(R"({}{}{}#include "{}"

// The conditions, as the specification states them.
namespace {} {{

using namespace std::chrono_literals;

// clang-format off
)",
                        project_.banner(), only_durations, include_block(headers), header_name(), space)};
  for (const Function& function : functions_)
    if (project_.lines == Lines::listed)
      add_listed(function, file);
    else
      add_marked(function, file.text);
  file.text += "// clang-format on\n\n}  // namespace " + space + "\n";
  return file;
}

}  // namespace tessera::codegen
