#include "net/counts.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tessera::net {

Counts count(const HierarchicalNet& pages, const Net& net) {
  Counts counts;
  counts.places = net.places().size();
  counts.fused = static_cast<std::size_t>(
      std::ranges::count_if(net.places(), [](const Place& place) { return !place.page.valid(); }));
  counts.transitions = net.transitions().size();
  counts.arcs = net.arc_count();
  for (const Page& page : pages.pages) {
    Counts::Layer& layer = counts.layers[static_cast<std::size_t>(page.layer)];
    layer.transitions += page.transitions.size();
    for (const Node& node : page.nodes) {
      layer.pages += node.page.valid();
      layer.places += !node.page.valid() && !node.fusion.valid();
    }
  }
  return counts;
}

const char* name_of(Layer layer) {
  constexpr std::array<const char*, layer_count> names{"system", "agent", "subsystem", "behaviour",
                                                       "communication"};
  return names[static_cast<std::size_t>(layer)];
}

std::string to_json(const Counts& counts) {
  nlohmann::ordered_json json;
  json["flat"] = {{"places", counts.places},
                  {"fused", counts.fused},
                  {"transitions", counts.transitions},
                  {"arcs", counts.arcs}};
  for (std::size_t layer = 0; layer < layer_count; ++layer)
    json["layers"][name_of(static_cast<Layer>(layer))] = {{"places", counts.layers[layer].places},
                                                          {"transitions", counts.layers[layer].transitions},
                                                          {"pages", counts.layers[layer].pages}};
  return json.dump(2) + "\n";
}

}  // namespace tessera::net
