#include "layers/sheet.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {

/// Layer 2, an agent (paper, sec. IV-B): its subsystems run side by side.
net::PageId draw_agent(Draft& draft, net::PageId parent, net::AgentId id) {
  const spec::Agent& agent = draft.model.agents[id];
  Sheet sheet(draft, parent, net::Layer::agent, agent.path, {}, agent.span);
  sheet.drawn().agent = id;
  const std::uint32_t in = sheet.input();
  std::vector<std::uint32_t> subsystems;
  for (const spec::DefinedSubsystemId subsystem : draft.model.definition_of(agent).subsystems.ids())
    subsystems.push_back(sheet.page(draw_subsystem(draft, sheet.id(), agent.instance(subsystem))));
  const std::uint32_t out = sheet.output();
  sheet.transition(words::start, {in}, subsystems).role = Step::start_agent;
  sheet.transition(words::end, subsystems, {out}).role = Step::end_agent;
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
