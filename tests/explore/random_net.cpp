#include "random_net.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "small_nets.hpp"

namespace tessera::explore {
namespace {

void add_places(net::Net& net, const std::vector<std::uint32_t>& tokens) {
  for (const std::uint32_t count : tokens) {
    net::Place place;
    place.tokens = count;
    net.add(std::move(place));
  }
}

using Ends = std::map<std::uint32_t, std::uint32_t>;  // place -> weight

void add_transition(net::Net& net, const Ends& inputs, const Ends& outputs) {
  const auto arcs = [](const Ends& ends) {
    std::vector<net::Arc> result;
    for (const auto& [place, weight] : ends) result.push_back({PlaceId{place}, weight});
    return result;
  };
  net.add(net::Transition{}, arcs(inputs), arcs(outputs));
}

std::uint32_t sum(const Ends& ends) {
  std::uint32_t total = 0;
  for (const auto& end : ends) total += end.second;
  return total;
}

Ends random_ends(Random& random, std::uint32_t places, std::uint32_t most_ends, std::uint32_t most_weight) {
  Ends ends;
  for (std::uint32_t end = below(random, most_ends + 1); end > 0; --end)
    ends[below(random, places)] = 1 + below(random, most_weight);
  return ends;
}

}  // namespace

net::Net random_machines(Random& random) {
  const std::uint32_t machines = 1 + below(random, 4);
  const std::uint32_t states = 2 + below(random, 3);
  const std::uint32_t places = machines * states;
  std::vector<std::uint32_t> tokens(places, 0);
  for (std::uint32_t machine = 0; machine < machines; ++machine)
    tokens[machine * states + below(random, states)] = 1;
  net::Net net;
  add_places(net, tokens);
  for (std::uint32_t transition = 2 + below(random, 3 * places / 2); transition > 0; --transition) {
    Ends inputs, outputs;
    for (std::uint32_t taking_part = 1 + below(random, 2); taking_part > 0; --taking_part) {
      const std::uint32_t machine = below(random, machines);
      inputs[machine * states + below(random, states)] = 1;
      outputs[machine * states + below(random, states)] = 1;
    }
    if (below(random, 20) == 0) outputs[below(random, places)] = 1;
    if (below(random, 20) == 0) outputs.erase(outputs.begin());
    add_transition(net, inputs, outputs);
  }
  return net;
}

net::Net random_weighted(Random& random) {
  const std::uint32_t places = 2 + below(random, 6);
  std::vector<std::uint32_t> tokens(places);
  for (std::uint32_t& count : tokens) count = below(random, 3) * below(random, 3);
  net::Net net;
  add_places(net, tokens);
  for (std::uint32_t transition = 1 + below(random, 8); transition > 0; --transition) {
    const Ends inputs = random_ends(random, places, 3, 2);
    Ends outputs = random_ends(random, places, 3, 2);
    while (sum(outputs) > sum(inputs)) outputs.erase(outputs.begin());
    if (below(random, 16) == 0) outputs[below(random, places)] += 1;
    add_transition(net, inputs, outputs);
  }
  return net;
}

net::Net random_wild(Random& random) {
  const std::uint32_t places = 1 + below(random, 6);
  std::vector<std::uint32_t> tokens(places);
  for (std::uint32_t& count : tokens) count = below(random, 4);
  net::Net net;
  add_places(net, tokens);
  for (std::uint32_t transition = below(random, 7); transition > 0; --transition)
    add_transition(net, random_ends(random, places, 3, 5), random_ends(random, places, 3, 3));
  return net;
}

Formula random_formula(Random& random, const net::Net& net, int depth) {
  const auto places = static_cast<std::uint32_t>(net.places().size());
  const auto transitions = static_cast<std::uint32_t>(net.transitions().size());
  switch (below(random, depth > 0 ? 7 : 4)) {
    case 0:
    case 1:
      return Formula::at_least(PlaceId{below(random, places)}, below(random, 4));
    case 2:
      return transitions > 0 ? Formula::enabled(TransitionId{below(random, transitions)}) : Formula::dead();
    case 3:
      return Formula::marked(PlaceId{below(random, places)});
    case 4:
      return Formula::negation(random_formula(random, net, depth - 1));
    case 5:
      return Formula::all({random_formula(random, net, depth - 1), random_formula(random, net, depth - 1)});
    default:
      return Formula::any({random_formula(random, net, depth - 1), random_formula(random, net, depth - 1)});
  }
}

}  // namespace tessera::explore
