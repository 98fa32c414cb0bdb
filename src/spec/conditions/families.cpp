// Buffers of which there is one for each member of a fleet, as conditions name them: "in.request[i].fresh",
// "any(in.request.fresh)".

#include <algorithm>
#include <charconv>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/conditions/names.hpp"
#include "spec/model/member.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

bool is_quantifier(const Token& word) { return word.is_one_of({"any", "all", "count", "which"}); }

}  // namespace

/// Whether what begins at a token stands alone in the brackets of any(...), all(...), count(...) or which(...).
bool ConditionNames::is_quantified(std::size_t at) const {
  return at >= 2 && tokens_[at - 1].is("(") && is_quantifier(tokens_[at - 2]) && !follows_member_mark(at - 2);
}

bool ConditionNames::check_index(std::size_t open, const Member& family, const std::string& path) {
  if (family.fleet.empty() || (scope_.member != nullptr && scope_.member->fleet.empty())) return true;
  const Token& index = tokens_[open + 1];
  if (!tokens_[open + 2].is("]")) return true;  // calculated: the compiler and the run judge it
  const std::string owner = "it is one for each " + family.fleet;
  if (index.is("i") && scope_.member == nullptr) {
    out_.error("E288", span_of(index), "'i' stands for no member here",
               "it does within a behaviour with 'for: each " + family.fleet +
                   "', and in an entry of 'next' that leads to such a behaviour");
    return false;
  }
  if (index.is("i") && scope_.member->fleet != family.fleet) {
    out_.error("E292", span_of(index),
               "'i' counts over fleet " + in_quotes(scope_.member->fleet) + " here, and " + in_quotes(path) +
                   " is one for each " + family.fleet,
               "only what is for each " + scope_.member->fleet + " has the index i here");
    return false;
  }
  std::uint32_t number = 0;
  const char* const end = index.text.data() + index.text.size();
  const auto [stop, error] = std::from_chars(index.text.data(), end, number);
  if (index.kind != Token::Kind::number || stop != end) return true;
  if (error == std::errc() && number < family.count) return true;
  out_.error("E289", span_of(index),
             in_quotes(path) + " has no member " + std::string(index.text) + ": " + owner,
             "the members are numbered 0 to " + std::to_string(family.count - 1));
  return false;
}

ConditionNames::Chain ConditionNames::read_family(std::size_t begin, const Field& first,
                                                  const std::vector<Status>* statuses) {
  const Member& family = *first.member;
  const std::string path = std::string(tokens_[begin].text) + "." + family.family;
  std::size_t at = begin + 3;
  Value unknown;
  unknown.begin = tokens_[begin].position;
  if (is_quantified(begin)) {
    const Chain chain = read_members(begin, at, value_of(first.type), path, statuses);
    if (tokens_[chain.end].is(")")) return chain;
    unknown.end = tokens_[chain.end].position;
    return {unknown, chain.end};
  }
  const bool asks_size = tokens_[at].is(".") && tokens_[at + 1].is_one_of({"size", "begin", "end"});
  if (!tokens_[at].is("[") && !asks_size) {
    const bool has_i = scope_.member != nullptr && scope_.member->fleet == family.fleet;
    const std::size_t end = skip_chain(at);
    std::string rest;
    for (std::size_t token = at; token < end; ++token) rest += tokens_[token].text;
    if (!family.fleet.empty())
      out_.error("E287", span_of(tokens_[begin + 2]),
                 in_quotes(path) + " is one buffer for each " + family.fleet + ": which?",
                 "write " + path + (has_i ? "[i]" : "[0]") + rest + ", or any(" + path + rest + ")");
    unknown.end = tokens_[end].position;
    return {unknown, end};
  }
  if (!asks_size && check_index(at, family, path)) {
    const std::string index = tokens_[at + 2].is("]") ? std::string(tokens_[at + 1].text) : "...";
    at = behind_bracket(at);
    return read_members(begin, at, value_of(first.type), path + "[" + index + "]", statuses);
  }
  at = skip_chain(at);
  unknown.end = tokens_[at].position;
  return {unknown, at};
}

bool ConditionNames::has_families() const {
  const auto is_member = [](const Field& one) { return one.member.has_value(); };
  return std::ranges::any_of(scope_.inputs, is_member) || std::ranges::any_of(scope_.outputs, is_member) ||
         std::ranges::any_of(scope_.memory,
                             [](const Field& one) { return one.few && !one.few->fleet.empty(); });
}

/// The word `i`; false: it means nothing in this subsystem.
bool ConditionNames::read_member_number(std::size_t at) {
  const Token& word = tokens_[at];
  Value value;
  if (scope_.member != nullptr) {
    refer(Reference::Kind::member, "i", std::nullopt, word);
    value.kind = Value::Kind::number;
    value.begin = word.position;
    value.end = word.position + word.text.size();
  } else if (has_families()) {
    out_.error(
        "E288", span_of(word), "'i' stands for no member here",
        "it does within a behaviour with 'for: each ...', and in an entry of 'next' that leads to such a "
        "behaviour");
  } else {
    return false;
  }
  chains_[at] = {value, at + 1};
  return true;
}

/// `in` or `out` at a token, with a name of a family behind it; false: it is none.
bool ConditionNames::read_family_at(std::size_t at, const std::vector<Status>* statuses) {
  const bool in = tokens_[at].is("in");
  const std::vector<Field>& all = in ? scope_.inputs : scope_.outputs;
  const Token& name = tokens_[at + 2];
  const auto first = std::ranges::find_if(
      all, [&](const Field& one) { return one.member && one.member->family == name.text; });
  if (first == all.end()) return false;
  refer(in ? Reference::Kind::input : Reference::Kind::output,
        std::string(tokens_[at].text) + "." + std::string(name.text),
        static_cast<std::uint32_t>(first - all.begin()), name);
  chains_[at] = read_family(at, *first, statuses);
  return true;
}

bool ConditionNames::read_quantifier(std::size_t at) {
  if (!is_quantifier(tokens_[at]) || !tokens_[at + 1].is("(") || !tokens_[at + 3].is(".")) return false;
  if (!tokens_[at + 2].is_one_of({"in", "out"})) return false;
  const std::vector<Field>& buffers = tokens_[at + 2].is("in") ? scope_.inputs : scope_.outputs;
  const bool is_family = std::ranges::any_of(
      buffers, [&](const Field& one) { return one.member && one.member->family == tokens_[at + 4].text; });
  if (!is_family) return false;
  Value value;
  value.kind = tokens_[at].is_one_of({"any", "all"}) ? Value::Kind::boolean : Value::Kind::number;
  value.begin = tokens_[at].position;
  const std::size_t end = behind_bracket(at + 1);
  value.end = tokens_[end - 1].position + 1;
  chains_[at] = {value, end};
  return true;
}

}  // namespace tessera::spec
