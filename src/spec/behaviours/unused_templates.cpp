#include "spec/behaviours/unused_templates.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/behaviours/behaviours.hpp"
#include "spec/behaviours/groups.hpp"

namespace tessera::spec {
namespace {

/// Errors that a subsystem around the template cannot mend.
constexpr auto certain =
    std::to_array<std::string_view>({"E102", "E103", "E104", "E105", "E106", "E110", "E205", "E341", "E342",
                                     "E343", "E344", "E345", "E346", "E349"});

bool is_certain(const diagnostics::Diagnostic& one) {
  if (one.severity != diagnostics::Severity::error) return false;
  // `next`, `start` and `on_error` name what is in the group itself.
  if (one.code == "E101") return one.message.starts_with("unknown behaviour");
  return std::ranges::find(certain, one.code) != certain.end();
}

}  // namespace

void check_unused(GroupTemplates& templates, const Types& types, Diagnostics& out) {
  std::vector<Entry> groups = templates.unused(out);
  if (groups.empty()) return;
  Node map;
  map.kind = Node::Kind::map;
  map.entries = std::move(groups);
  const Entry behaviours{"behaviours", map.entries.front().span, &map};
  Subsystem none;
  const std::vector<Parameter> no_parameters;
  const ConditionScope scope{SubsystemKind::control, none.inputs,   none.outputs, none.real, none.memory,
                             none.parameters,        no_parameters, types};
  SubsystemDefaults defaults;
  Diagnostics found = out.of_same_source();
  ReadBehaviours read = read_behaviours(behaviours, scope, defaults, nullptr, nullptr, found);
  none.behaviours = std::move(read.behaviours);
  complete_groups(none, read.on_error, found);
  const std::vector<Replacement>& taken = templates.replacements();
  for (const diagnostics::Diagnostic& one : found.sorted())
    if (is_certain(one) &&
        std::ranges::none_of(taken, [&](const Replacement& at) { return is_in(at, one.span); }))
      out.report(one);
}

}  // namespace tessera::spec
