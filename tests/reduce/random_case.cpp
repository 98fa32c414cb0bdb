#include "reduce/random_case.hpp"

#include "oracle/nets/of_net.hpp"
#include "oracle/nets/random_net.hpp"

namespace tessera::test {
namespace {

using oracle::below;
using oracle::Random;

net::Net random_net(Random& random) {
  oracle::PetriNet net =
      below(random, 2) == 0 ? oracle::random_processes(random) : oracle::random_sparse(random);
  for (oracle::PetriNet::Transition& transition : net.transitions) transition.never = below(random, 25) == 0;
  return oracle::tessera_net(net);
}

template <class Id>
std::vector<Id> some_of(Random& random, std::size_t count, std::uint32_t one_in) {
  std::vector<Id> chosen;
  for (std::uint32_t index = 0; index < count; ++index)
    if (below(random, one_in) == 0) chosen.push_back({index});
  return chosen;
}

}  // namespace

RandomCase random_case(std::uint32_t seed) {
  Random random(seed);
  RandomCase made{random_net(random), {}};
  made.what.observed = some_of<net::PlaceId>(random, made.net.places().size(), 6);
  for (std::uint32_t set = below(random, 4); set > 0; --set)
    made.what.sets.push_back(some_of<net::TransitionId>(random, made.net.transitions().size(), 4));
  return made;
}

}  // namespace tessera::test
