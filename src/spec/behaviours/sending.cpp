#include "spec/behaviours/sending.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "diagnostics/utf8.hpp"
#include "spec/behaviours/conditions.hpp"
#include "spec/document/section.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

void read_condition_of(const Entry& when, Skippable& made, const std::string& name,
                       const ConditionScope& scope, SharedConditions& shared, Diagnostics& out) {
  made.when = read_condition(&when, scope, shared, out);
  if (made.when.kind == Condition::Kind::never)
    out.error("E326", made.when.span, "output " + in_quotes(name) + " would never be sent",
              "leave it out of this 'send'");
  if (made.when.kind == Condition::Kind::always)
    out.warning("W385", made.when.span, "'when: true' says nothing: every iteration sends " + in_quotes(name),
                "write " + name + " alone, without a map");
}

void read_skip(const Entry& skip, Diagnostics& out) {
  const Node* text = text_of(*skip.value, skip.span, "skip", out, "write skip: allowed");
  if (text != nullptr && text->text != "allowed")
    out.error("E327", text->span, "skip must be allowed, not " + in_quotes(text->text),
              "write skip: allowed, and out.NAME.skip() in the transition function");
}

std::optional<Skippable> read_one(const Entry& option, BufferId output, const ConditionScope& scope,
                                  SharedConditions& shared, Diagnostics& out) {
  if (option.value->is_null()) return std::nullopt;
  const std::string name = option.key.substr(option.key.starts_with('+') ? 1 : 0);
  const std::string hint =
      "write " + name + ": { when: CONDITION }, " + name + ": { skip: allowed }, or " + name + " alone";
  if (!option.value->is_map() || option.value->entries.empty()) {
    out.error("E324", option.value->is_map() ? option.span : option.value->span,
              in_quotes(name) + " needs a map that says when it is sent", hint);
    return std::nullopt;
  }
  const Section section(*option.value, option.span, "an output of 'send'", {"when", "skip"}, out);
  const Entry* when = section.find("when");
  const Entry* skip = section.find("skip");
  if (when != nullptr && skip != nullptr) {
    out.error("E325", skip->span, in_quotes(name) + " has both 'when' and 'skip'",
              "either the condition or the transition function decides: remove one of them");
    return std::nullopt;
  }
  if (when == nullptr && skip == nullptr) {
    if (!section.has_unknown_keys())
      out.error("E324", option.span, in_quotes(name) + " does not say when it is sent", hint);
    return std::nullopt;
  }
  Skippable made{.output = output, .by_function = skip != nullptr, .span = option.span};
  if (when != nullptr)
    read_condition_of(*when, made, name, scope, shared, out);
  else
    read_skip(*skip, out);
  return made.when.kind == Condition::Kind::always ? std::nullopt : std::optional(made);
}

/// A structure with a field `skip` hides the function of that name.
void check_members(const Field& output, Span at, const Types& types, Diagnostics& out) {
  const Type& type = output.type;
  if (type.kind != Type::Kind::structure || type.extent > 0 || Types::is_unknown(type)) return;
  const std::vector<Field>& fields = types.fields_of(type);
  if (std::ranges::find(fields, "skip", &Field::name) != fields.end())
    out.error("E330", at,
              "the type of " + in_quotes(output.name) + " has a field 'skip', which hides out." +
                  output.name + ".skip()",
              "rename the field, or write when: CONDITION in place of skip: allowed");
}

}  // namespace

std::vector<Skippable> read_skippable(const std::vector<ListedOption>& options, const ConditionScope& scope,
                                      SharedConditions& shared, Diagnostics& out) {
  std::vector<Skippable> all;
  for (const ListedOption& option : options) {
    if (option.buffers.empty()) continue;  // which is reported
    std::optional<Skippable> one = read_one(*option.entry, option.buffers.front(), scope, shared, out);
    if (!one) continue;
    if (one->by_function)
      check_members(scope.outputs[option.buffers.front().value], option.entry->span, scope.types, out);
    for (const BufferId output : option.buffers) {
      one->output = output;
      all.push_back(*one);
    }
  }
  return all;
}

}  // namespace tessera::spec
