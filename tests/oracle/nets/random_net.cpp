#include "oracle/nets/random_net.hpp"

#include <map>
#include <vector>

namespace oracle {
namespace {

using Ends = std::map<std::uint32_t, std::uint32_t>;  // place -> weight

std::uint32_t between(Random& random, std::uint32_t low, std::uint32_t high) {
  return low + below(random, high - low + 1);
}

bool one_in(Random& random, std::uint32_t chances) { return below(random, chances) == 0; }

std::uint32_t add_place(PetriNet& net, std::uint32_t tokens) {
  net.initial.push_back(tokens);
  return static_cast<std::uint32_t>(net.initial.size() - 1);
}

void add_transition(PetriNet& net, const Ends& inputs, const Ends& outputs) {
  PetriNet::Transition& transition = net.transitions.emplace_back();
  for (const auto& [place, weight] : inputs) transition.inputs.push_back({place, weight});
  for (const auto& [place, weight] : outputs) transition.outputs.push_back({place, weight});
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

/// A process that goes from one place to another may take from buffers and give to them.
void add_step(PetriNet& net, Random& random, std::uint32_t from, std::uint32_t to, std::uint32_t buffers) {
  Ends inputs{{from, 1}}, outputs{{to, 1}};
  for (std::uint32_t buffer = 0; buffer < buffers; ++buffer) {
    if (one_in(random, 4)) inputs[buffer] = 1;
    if (one_in(random, 4)) outputs[buffer] = 1;
  }
  add_transition(net, inputs, outputs);
}

void add_process(PetriNet& net, Random& random, std::uint32_t buffers) {
  const std::uint32_t first = add_place(net, 1), places = between(random, 2, 6);
  for (std::uint32_t place = 1; place < places; ++place) add_place(net, 0);
  const bool closed = !one_in(random, 3);
  for (std::uint32_t place = 0; place + (closed ? 0 : 1) < places; ++place)
    add_step(net, random, first + place, first + (place + 1) % places, buffers);
  for (std::uint32_t more = below(random, 3); more > 0; --more) {
    const std::uint32_t from = first + below(random, places);
    add_step(net, random, from, first + below(random, places), buffers);
  }
}

}  // namespace

PetriNet random_machines(Random& random) {
  PetriNet net;
  const std::uint32_t machines = 1 + below(random, 4);
  const std::uint32_t states = 2 + below(random, 3);
  const std::uint32_t places = machines * states;
  net.initial.assign(places, 0);
  for (std::uint32_t machine = 0; machine < machines; ++machine)
    net.initial[machine * states + below(random, states)] = 1;
  for (std::uint32_t transition = 2 + below(random, 3 * places / 2); transition > 0; --transition) {
    Ends inputs, outputs;
    for (std::uint32_t taking_part = 1 + below(random, 2); taking_part > 0; --taking_part) {
      const std::uint32_t machine = below(random, machines);
      inputs[machine * states + below(random, states)] = 1;
      outputs[machine * states + below(random, states)] = 1;
    }
    if (one_in(random, 20)) outputs[below(random, places)] = 1;
    if (one_in(random, 20)) outputs.erase(outputs.begin());
    add_transition(net, inputs, outputs);
  }
  return net;
}

PetriNet random_processes(Random& random) {
  PetriNet net;
  const std::uint32_t buffers = below(random, 4);
  for (std::uint32_t buffer = 0; buffer < buffers; ++buffer) add_place(net, below(random, 2));
  for (std::uint32_t process = between(random, 1, 3); process > 0; --process)
    add_process(net, random, buffers);
  return net;
}

PetriNet random_weighted(Random& random) {
  PetriNet net;
  const std::uint32_t places = 2 + below(random, 6);
  for (std::uint32_t place = 0; place < places; ++place) add_place(net, below(random, 3) * below(random, 3));
  for (std::uint32_t transition = 1 + below(random, 8); transition > 0; --transition) {
    const Ends inputs = random_ends(random, places, 3, 2);
    Ends outputs = random_ends(random, places, 3, 2);
    while (sum(outputs) > sum(inputs)) outputs.erase(outputs.begin());
    if (one_in(random, 16)) outputs[below(random, places)] += 1;
    add_transition(net, inputs, outputs);
  }
  return net;
}

PetriNet random_sparse(Random& random) {
  PetriNet net;
  const std::uint32_t places = between(random, 2, 7);
  for (std::uint32_t place = 0; place < places; ++place)
    add_place(net, one_in(random, 3) ? between(random, 1, 2) : 0);
  for (std::uint32_t transition = between(random, 1, 8); transition > 0; --transition) {
    Ends inputs, outputs;
    for (std::uint32_t arcs = one_in(random, 12) ? 0 : between(random, 1, 2); arcs > 0; --arcs)
      inputs[below(random, places)] = one_in(random, 6) ? 2 : 1;
    for (std::uint32_t arcs = below(random, 3); arcs > 0; --arcs)
      outputs[below(random, places)] = one_in(random, 6) ? 2 : 1;
    add_transition(net, inputs, outputs);
  }
  return net;
}

PetriNet random_wild(Random& random) {
  PetriNet net;
  const std::uint32_t places = 1 + below(random, 6);
  for (std::uint32_t place = 0; place < places; ++place) add_place(net, below(random, 4));
  for (std::uint32_t transition = below(random, 7); transition > 0; --transition) {
    const Ends inputs = random_ends(random, places, 3, 5);
    add_transition(net, inputs, random_ends(random, places, 3, 3));
  }
  return net;
}

}  // namespace oracle
