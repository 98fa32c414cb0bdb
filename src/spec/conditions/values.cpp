// The values of memory cells with few values, as conditions name them: "memory.lent_to == nobody".

#include <algorithm>

#include "diagnostics/utf8.hpp"
#include "spec/conditions/names.hpp"
#include "spec/model/member.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {

using diagnostics::in_quotes;

/// The cell that `memory.NAME` names at a token, if it has values; nullptr: no such thing begins there.
const Field* ConditionNames::cell_at(std::size_t at) const {
  if (at + 3 >= tokens_.size() || !tokens_[at].is("memory") || !tokens_[at + 1].is(".")) return nullptr;
  if (follows_member_mark(at)) return nullptr;
  const auto cell = std::ranges::find(scope_.memory, tokens_[at + 2].text, &Field::name);
  return cell != scope_.memory.end() && cell->few && !cell->few->counts ? &*cell : nullptr;
}

/// The cell with which the word at a token is compared.
const Field* ConditionNames::compared_cell(std::size_t at) const {
  const auto compares = [&](std::size_t mark) { return tokens_[mark].is_one_of({"==", "!=", "not_eq"}); };
  if (at >= 4 && compares(at - 1))
    if (const Field* left = cell_at(at - 4)) return left;
  const std::size_t behind = tokens_[at + 1].is("[") ? behind_bracket(at + 1) : at + 1;
  return compares(behind) ? cell_at(behind + 1) : nullptr;
}

const Field* ConditionNames::cell_with_value(std::string_view name) const {
  for (const Field& cell : scope_.memory)
    if (cell.few && !cell.few->counts && (cell.few->find(name) || cell.few->fleet == name)) return &cell;
  return nullptr;
}

bool ConditionNames::read_value(std::size_t at) {
  const Token& word = tokens_[at];
  const Field* const cell = compared_cell(at);
  const Field* const owner = cell_with_value(word.text);
  if (cell == nullptr && (owner == nullptr || !other_home(word.text).empty())) return false;
  Value value;
  value.begin = word.position;
  value.end = word.position + word.text.size();
  if (cell == nullptr) {
    out_.error("E263", span_of(word), in_quotes(word.text) + " is a value of memory." + owner->name,
               "compare it there: memory." + owner->name + " == " + std::string(word.text));
  } else if (!word.text.empty() && cell->few->fleet == word.text) {
    const Member family{cell->few->fleet, cell->few->fleet, 0, cell->few->member_count};
    const bool has_index = tokens_[at + 1].is("[");
    if (!has_index) {
      out_.error("E287", span_of(word), in_quotes(word.text) + " is one value for each member: which?",
                 "write " + first_of(family) +
                     (scope_.member != nullptr ? ", or " + family.fleet + "[i]" : std::string()));
    } else if (check_index(at + 1, family, std::string(word.text))) {
      refer(Reference::Kind::value, "memory." + cell->name + "." + std::string(word.text),
            cell->few->first_member, word);
      value.kind = Value::Kind::choice;
      value.literal = true;
      value.few = cell;
    }
    const std::size_t end = has_index ? behind_bracket(at + 1) : at + 1;
    value.end = tokens_[end - 1].position + tokens_[end - 1].text.size();
    chains_[at] = {value, end};
    return true;
  } else if (const auto found = cell->few->find(word.text)) {
    refer(Reference::Kind::value, "memory." + cell->name + "." + std::string(word.text), found, word);
    value.kind = Value::Kind::choice;
    value.literal = true;
    value.few = cell;
  } else {
    Hint hint = did_you_mean(word.text, cell->few->names);
    if (hint.empty()) hint = "it is " + cell->few->in_words();
    if (owner != nullptr) hint = in_quotes(word.text) + " is a value of memory." + owner->name;
    out_.error("E261", span_of(word), "unknown value " + in_quotes(word.text) + " of memory." + cell->name,
               std::move(hint));
  }
  chains_[at] = {value, at + 1};
  return true;
}

Value ConditionNames::value_of(const Field& data) const {
  if (!data.few) return value_of(data.type);
  Value value;
  value.few = &data;
  value.kind = data.few->counts ? Value::Kind::number : Value::Kind::choice;
  value.declared = data.few->counts;
  value.type.scalar = Scalar::int32;
  return value;
}

}  // namespace tessera::spec
