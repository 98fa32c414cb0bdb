#include "layers/layers.hpp"

#include <utility>

#include "layers/sheet.hpp"

namespace tessera::layers {
namespace {

/// A transition that starts nothing would fire for ever, so a system needs something to run.
bool examine(const spec::Model& model, diagnostics::Diagnostics& out) {
  const std::size_t before = out.error_count();
  if (model.agents.empty()) out.error("E410", {}, "the system has no agents");
  for (const spec::Definition& definition : model.definitions) {
    if (definition.subsystems.empty())
      out.error("E411", definition.span, "agent '" + definition.name + "' has no subsystems");
    for (const spec::Subsystem& subsystem : definition.subsystems)
      if (subsystem.behaviours.empty())
        out.error("E412", subsystem.span, "subsystem '" + subsystem.name + "' has no behaviours");
  }
  return out.error_count() == before;
}

}  // namespace

std::optional<net::HierarchicalNet> build(const spec::Model& model, diagnostics::Diagnostics& out) {
  if (!examine(model, out)) return std::nullopt;
  Draft draft(model);
  draw_system(draft);
  draft.net.parts.sources = model.sources;
  return std::move(draft.net);
}

}  // namespace tessera::layers
