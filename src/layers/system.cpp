#include "layers/sheet.hpp"

namespace tessera::layers {

/// Layer 1, the multi-agent system (paper, sec. IV-A). The paper draws no `in` and `out` here; without them
/// `t_in` would fire for ever.
net::PageId draw_system(Draft& draft) {
  Sheet sheet(draft, {}, net::Layer::system, "", net::no_subsystem, {});
  const std::uint32_t in = sheet.place("in", {}, 1);
  std::vector<std::uint32_t> agents;
  for (spec::Index agent = 0; agent < draft.model.agents.size(); ++agent)
    agents.push_back(sheet.page(draw_agent(draft, sheet.id(), agent)));
  const std::uint32_t out = sheet.place("out");
  sheet.transition("t_in", {in}, agents);
  sheet.transition("t_out", agents, {out});
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
