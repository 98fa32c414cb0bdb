#include "layers/sheet.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {

/// Layer 1, the multi-agent system (paper, sec. IV-A). The paper draws no `in` and `out` here; without them
/// `t_in` would fire for ever.
net::PageId draw_system(Draft& draft) {
  Sheet sheet(draft, {}, net::Layer::system, "", {}, {});
  const std::uint32_t in = sheet.input({}, 1);
  std::vector<std::uint32_t> agents;
  for (spec::Index agent = 0; agent < draft.model.agents.size(); ++agent)
    agents.push_back(sheet.page(draw_agent(draft, sheet.id(), {agent})));
  const std::uint32_t out = sheet.output();
  sheet.transition(words::start, {in}, agents).role = net::TransitionRole::start;
  sheet.transition(words::end, agents, {out}).role = net::TransitionRole::end;
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
