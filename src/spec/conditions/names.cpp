#include "spec/conditions/names.hpp"

#include <algorithm>
#include <array>

#include "diagnostics/utf8.hpp"
#include "spec/document/cpp_names.hpp"
#include "spec/document/names.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;
using Is = Value::Kind;
using Status = std::pair<std::string_view, Is>;

const std::vector<Status> arrivals{
    {"fresh", Is::boolean},  {"age", Is::duration},      {"stamp", Is::time},          {"valid", Is::boolean},
    {"failed", Is::boolean}, {"timed_out", Is::boolean}, {"disconnected", Is::boolean}};
const std::vector<Status> departures{
    {"stamp", Is::time}, {"timed_out", Is::boolean}, {"disconnected", Is::boolean}};

constexpr std::array roots = std::to_array<std::string_view>({"in", "out", "memory", "parameters"});

bool is_root(std::string_view word) { return std::find(roots.begin(), roots.end(), word) != roots.end(); }

/// "there are: left, middle, right"; at most ten.
std::string existing(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < 10; ++i) text += (i == 0 ? "" : ", ") + names[i];
  return "there " + std::string(names.size() == 1 ? "is: " : "are: ") + text +
         (names.size() > 10 ? " ..." : "");
}

Hint guess_or_existing(std::string_view word, const std::vector<std::string>& names) {
  const Hint guess = did_you_mean(word, names);
  return guess.empty() && !names.empty() ? existing(names) : guess;
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

/// Those of which there is one for each member of a fleet appear once, without index.
std::vector<std::string> names_of(const std::vector<Field>& all) {
  std::vector<std::string> names;
  for (const Field& one : all)
    if (!one.member || one.member->number == 0) names.push_back(one.member ? one.member->family : one.name);
  return names;
}

template <class Named>
std::optional<std::uint32_t> index_of(const std::vector<Named>& all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return found == all.end() ? std::nullopt : std::optional(static_cast<std::uint32_t>(found - all.begin()));
}

/// A name that the compiler may know although the specification does not: a macro, a type, a name of C.
bool may_be_of_cpp(std::string_view word, const Types& types) {
  const bool is_loud = std::ranges::none_of(word, [](char c) { return c >= 'a' && c <= 'z'; });
  return is_loud || word.ends_with("_t") || word.starts_with("_") || is_keyword(word) || is_macro(word) ||
         is_global_name(word) || index_of(types.structures(), word) || word == "std" || word == "tessera" ||
         word.starts_with("tessera_") || word == "override" || word == "final" ||
         std::ranges::any_of(word, [](char c) { return static_cast<unsigned char>(c) > 127; });
}

}  // namespace

/// One of `in`, `out`, `memory` and `parameters`.
struct ConditionNames::Root {
  std::string_view word;
  std::string what;  ///< "input"
  std::vector<std::string> names;
};

ConditionNames::ConditionNames(const std::vector<Token>& tokens, const Positions& positions,
                               const ConditionScope& scope, const std::vector<std::string>& others,
                               Diagnostics& out)
    : tokens_(tokens), positions_(positions), scope_(scope), others_(others), out_(out) {
  for (std::size_t at = 0; at < tokens_.size(); ++at) {
    // "[" that begins an expression begins a lambda.
    const bool is_lambda =
        tokens_[at].is("[") && (at == 0 || (tokens_[at - 1].kind == Token::Kind::mark &&
                                            !tokens_[at - 1].is(")") && !tokens_[at - 1].is("]")));
    declares_names_ = declares_names_ || is_lambda || tokens_[at].is("auto") || tokens_[at].is("requires");
  }
  if (!declares_names_) read();
}

const ConditionNames::Chain* ConditionNames::chain_at(std::size_t token) const {
  const auto found = chains_.find(token);
  return found == chains_.end() ? nullptr : &found->second;
}

void ConditionNames::read() {
  for (std::size_t at = 0; at < tokens_.size(); ++at) {
    if (tokens_[at].kind != Token::Kind::name || follows_member_mark(at)) continue;
    if (is_root(tokens_[at].text)) {
      if (member_follows(at + 1)) read_root(at);
    } else {
      read_word(at);
    }
  }
}

bool ConditionNames::follows_member_mark(std::size_t at) const {
  if (at == 0) return false;
  const Token& before = tokens_[at - 1];
  return before.is(".") || before.is("->") || before.is("::") || before.is(".*") || before.is("->*");
}

bool ConditionNames::member_follows(std::size_t at) const {
  return tokens_[at].is(".") && tokens_[at + 1].kind == Token::Kind::name && !tokens_[at + 2].is("::") &&
         !is_keyword(tokens_[at + 1].text);
}

void ConditionNames::read_word(std::size_t at) {
  const Token& word = tokens_[at];
  const Token& next = tokens_[at + 1];
  const bool is_free = !next.is("(") && !next.is("::") && !next.is("{") &&
                       !(next.is("<") && is_template(at + 1)) &&
                       (at == 0 || !(tokens_[at - 1].is("<") && next.is(">")));
  if (word.text == "elapsed" && !next.is("(") && !next.is("::")) {
    refer(Reference::Kind::elapsed, "elapsed", std::nullopt, word);
    Value value;
    value.kind = Is::duration;
    chains_[at] = read_members(at, at + 1, value, "elapsed", nullptr);
  } else if (word.text == "index" && !next.is("(") && !next.is("::")) {
    refer(Reference::Kind::index, "index", std::nullopt, word);
    Value value;
    value.kind = Is::number;
    value.begin = word.position;
    value.end = word.position + word.text.size();
    chains_[at] = {value, at + 1};
  } else if (word.text == "true" || word.text == "false") {
    Value value;
    value.kind = Is::boolean;
    value.begin = word.position;
    value.end = word.position + word.text.size();
    chains_[at] = {value, at + 1};
  } else if ((word.text == "i" && is_free && !is_behind_operand(at) && read_member_number(at)) ||
             read_quantifier(at)) {
    return;
  } else if (is_free && !is_behind_operand(at) && !is_keyword(word.text) && !read_value(at)) {
    const std::string home = other_home(word.text), name = in_quotes(word.text);
    const bool is_of_cpp = may_be_of_cpp(word.text, scope_.types);
    const std::string says = is_of_cpp ? name + " is a name of C++, not " + home : "unknown name " + name;
    if (!is_of_cpp || !home.empty()) out_.error("E101", span_of(word), says, hint_for_word(word.text));
  }
}

/// Then an operator is missing: "in.left is true".
bool ConditionNames::is_behind_operand(std::size_t at) const {
  if (at == 0) return false;
  const Token& before = tokens_[at - 1];
  return before.is("]") || (before.kind != Token::Kind::mark && !is_keyword(before.text));
}

/// Whether "<" may begin arguments of a template: `get<0>(...)`.
bool ConditionNames::is_template(std::size_t at) const {
  for (; tokens_[at].kind != Token::Kind::end; ++at)
    if ((tokens_[at].is(">") || tokens_[at].is(">>")) && tokens_[at + 1].is("(")) return true;
  return false;
}

Hint ConditionNames::hint_for_word(std::string_view word) const {
  if (std::ranges::find(others_, word) != others_.end())
    return "a named condition stands alone; inside of an expression, repeat what it says";
  if (word == "context" || word == "now" || word == "iteration")
    return "a condition has in, out, memory, parameters, elapsed and index; a transition function can write "
           "what it knows to its memory";
  std::vector<std::string> candidates{"elapsed", "index"};
  for (const std::string_view root : roots) candidates.emplace_back(root);
  const auto add = [&](std::string_view prefix, const auto& all) {
    for (const auto& one : all) {
      if (one.name == word) candidates.insert(candidates.begin(), std::string(prefix) + one.name);
      candidates.push_back(one.name);
    }
  };
  const bool reads_real = scope_.kind == SubsystemKind::receptor;
  add("in.", scope_.inputs);
  add("out.", scope_.outputs);
  add(reads_real ? "in." : "out.", scope_.real);
  add("memory.", scope_.memory);
  add("parameters.", scope_.parameters);
  add("parameters.", scope_.system_parameters);
  if (candidates.front() != "elapsed") return "write " + candidates.front();
  const std::string near = nearest(word, candidates);
  if (near.empty()) return "a condition has in, out, memory, parameters, elapsed and index";
  const std::string home = other_home(near);
  return proposing(home.empty() ? near : home);
}

/// "memory.count" for "count"; "" if nothing has that name.
std::string ConditionNames::other_home(std::string_view name) const {
  const auto is_in = [&](const auto& all) { return index_of(all, name).has_value(); };
  const std::string own(name);
  const bool reads_real = scope_.kind == SubsystemKind::receptor;
  if (is_in(scope_.inputs)) return "in." + own;
  if (is_in(scope_.outputs)) return "out." + own;
  if (is_in(scope_.real)) return (reads_real ? "in." : "out.") + own;
  if (is_in(scope_.memory)) return "memory." + own;
  if (is_in(scope_.parameters) || is_in(scope_.system_parameters)) return "parameters." + own;
  return "";
}

bool ConditionNames::holds_real(bool in) const {
  return scope_.kind == (in ? SubsystemKind::receptor : SubsystemKind::effector);
}

void ConditionNames::read_root(std::size_t at) {
  const Token& name = tokens_[at + 2];
  const std::string path = std::string(tokens_[at].text) + "." + std::string(name.text);
  std::vector<std::string> known;
  const auto try_all = [&](const auto& all, Reference::Kind kind, const std::vector<Status>* statuses) {
    const auto found = index_of(all, name.text);
    if (!found) {
      for (std::string one : names_of(all)) known.push_back(std::move(one));
      return false;
    }
    refer(kind, path, found, name);
    chains_[at] = read_members(at, at + 3, value_of(all[*found]), path, statuses);
    return true;
  };
  std::string what;
  if (tokens_[at].is("in") || tokens_[at].is("out")) {
    const bool in = tokens_[at].is("in");
    const std::vector<Status>* statuses = in ? &arrivals : &departures;
    what = in ? "input" : "output";
    if (try_all(in ? scope_.inputs : scope_.outputs, in ? Reference::Kind::input : Reference::Kind::output,
                statuses))
      return;
    if (read_family_at(at, statuses)) return;
    if (holds_real(in) && try_all(scope_.real, Reference::Kind::real, statuses)) return;
  } else if (tokens_[at].is("memory")) {
    what = "memory";
    if (try_all(scope_.memory, Reference::Kind::memory, nullptr)) return;
  } else {
    what = "parameter";
    if (try_all(scope_.parameters, Reference::Kind::own_parameter, nullptr) ||
        try_all(scope_.system_parameters, Reference::Kind::system_parameter, nullptr))
      return;
  }
  unknown_name(name, {tokens_[at].text, what, known});
  Value value;
  value.begin = tokens_[at].position;
  const std::size_t end = skip_chain(at + 3);
  value.end = tokens_[end].position;
  chains_[at] = {value, end};
}

void ConditionNames::unknown_name(const Token& name, const Root& root) {
  Hint hint = guess_or_existing(name.text, root.names);
  const std::string home = other_home(name.text);
  if (!home.empty()) hint = "write " + home;
  if (hint.empty()) hint = "this subsystem has no " + root.what + (root.what == "memory" ? "" : "s");
  out_.error("E101", span_of(name), "unknown " + root.what + " " + in_quotes(name.text), std::move(hint));
}

Value ConditionNames::value_of(const Type& type) const {
  Value value;
  if (Types::is_unknown(type)) return value;
  value.declared = true;
  value.type = type;
  if (type.extent > 0)
    value.kind = Is::array;
  else if (type.kind == Type::Kind::structure)
    value.kind = Is::structure;
  else if (type.kind == Type::Kind::string)
    value.kind = Is::text;
  else
    value.kind = type.scalar == Scalar::boolean ? Is::boolean : Is::number;
  if (value.kind == Is::number && is_duration_unit(type.unit)) value.time_unit = type.unit;
  return value;
}

ConditionNames::Chain ConditionNames::read_members(std::size_t begin, std::size_t at, Value value,
                                                   std::string path, const std::vector<Status>* statuses) {
  for (bool known = true; known;) {
    if (tokens_[at].is("[") && value.kind != Is::unknown) {
      known = read_subscript(at, value, path);
      statuses = nullptr;
    } else if (member_follows(at)) {
      // Functions of arrays, strings, durations and buffers are left to the compiler.
      known =
          !tokens_[at + 2].is("(") && value.kind != Is::unknown && read_member(at + 1, value, path, statuses);
      if (known) at += 2;
    } else {
      break;
    }
    if (!known) {
      at = skip_chain(at);
      value = Value{};
    }
  }
  if (tokens_[at].is("(") || tokens_[at].is("[") || tokens_[at].is("->") || tokens_[at].is(".")) {
    at = skip_chain(at);
    value = Value{};
  }
  value.begin = tokens_[begin].position;
  value.end = tokens_[at - 1].position + tokens_[at - 1].text.size();
  return {value, at};
}

/// false: it is no member, which has been reported.
bool ConditionNames::read_member(std::size_t at, Value& value, std::string& path,
                                 const std::vector<Status>*& statuses) {
  const Token& member = tokens_[at];
  if (value.kind == Is::structure) {
    const StructureId structure = value.type.structure;
    const std::vector<Field>& fields = scope_.types.fields_of(value.type);
    if (const auto field = index_of(fields, member.text)) {
      path += "." + std::string(member.text);
      refer(Reference::Kind::field, path, field, member, structure);
      value = value_of(fields[*field].type);
      statuses = nullptr;
      return true;
    }
  }
  if (statuses != nullptr) {
    const auto status = std::find_if(statuses->begin(), statuses->end(),
                                     [&](const Status& one) { return one.first == member.text; });
    if (status != statuses->end()) {
      path += "." + std::string(member.text);
      refer(Reference::Kind::status, path, std::nullopt, member);
      value = Value{};
      value.kind = status->second;
      statuses = nullptr;
      return true;
    }
  }
  unknown_member(member, value, path, statuses);
  return false;
}

void ConditionNames::unknown_member(const Token& member, const Value& value, const std::string& path,
                                    const std::vector<Status>* statuses) {
  std::vector<std::string> names;
  if (value.kind == Is::structure) names = names_of(scope_.types.fields_of(value.type));
  if (statuses != nullptr)
    for (const Status& one : *statuses) names.emplace_back(one.first);
  Hint hint = guess_or_existing(member.text, names);
  if (value.kind == Is::duration) hint = "compare it with a duration such as 500 ms";
  if ((value.kind == Is::array || value.kind == Is::text) &&
      (member.text == "size" || member.text == "empty"))
    hint = "write " + path + "." + std::string(member.text) + "()";
  else if (value.kind == Is::array && value.type.kind == Type::Kind::structure)
    hint = "choose an element: " + path + "[0]." + std::string(member.text);
  out_.error("E101", span_of(member),
             path + " has no field " + in_quotes(member.text) + ": it is " + in_words(value, scope_.types),
             std::move(hint));
}

void ConditionNames::refer(Reference::Kind kind, std::string path, std::optional<std::uint32_t> target,
                           const Token& at, StructureId structure) {
  references_.push_back({kind, std::move(path), target, structure, span_of(at)});
}

}  // namespace tessera::spec
