#include <string>
#include <vector>

#include "layers/built_in.hpp"
#include "layers/sheet.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {

namespace {

/// The transitions that carry the values of a channel between processes. They are drawn on the page with both
/// agents, and belong to neither.
void draw_medium_of(const Draft& draft, Sheet& sheet, spec::ChannelId channel) {
  const spec::CommunicationModel& model = model_of(draft.model, draft.model.channels[channel]);
  if (draft.memory[channel].empty() || model.medium.empty()) return;
  const std::string prefix = draft.net.parts[channel] + ".";
  std::vector<std::uint32_t> nodes;
  for (std::size_t place = 0; place < model.shared.size(); ++place)
    nodes.push_back(sheet.fused(prefix + model.shared[place].name, draft.memory[channel][place]));
  const auto ends = [&](const std::vector<std::uint32_t>& places) {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t place : places) all.push_back(nodes[place]);
    return all;
  };
  for (const spec::MediumTransition& transition : model.medium) {
    net::PageTransition& drawn =
        sheet.transition(prefix + transition.name, ends(transition.takes), ends(transition.gives));
    drawn.role = role_of(transition);
    drawn.span = draft.model.channels[channel].span;
  }
}

}  // namespace

/// Layer 1, the multi-agent system (paper, sec. IV-A). The paper draws no `in` and `out` here; without them
/// `t_in` would fire for ever.
net::PageId draw_system(Draft& draft) {
  Sheet sheet(draft, {}, net::Layer::system, "", {}, {});
  const std::uint32_t in = sheet.input({}, 1);
  std::vector<std::uint32_t> agents;
  for (const spec::AgentId agent : draft.model.agents.ids())
    agents.push_back(sheet.page(draw_agent(draft, sheet.id(), agent)));
  const std::uint32_t out = sheet.output();
  sheet.transition(words::start, {in}, agents).role = Step::start_system;
  sheet.transition(words::end, agents, {out}).role = Step::end_system;
  for (const spec::ChannelId channel : draft.model.channels.ids()) draw_medium_of(draft, sheet, channel);
  return sheet.finish(in, out);
}

}  // namespace tessera::layers
