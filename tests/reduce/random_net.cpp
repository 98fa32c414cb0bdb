#include "reduce/random_net.hpp"

#include <algorithm>
#include <random>
#include <string>

namespace tessera::test {
namespace {

class RandomNet {
 public:
  explicit RandomNet(std::uint64_t seed) : random_(seed) {}

  RandomCase result() {
    if (chance(2))
      processes();
    else
      anything();
    for (std::uint32_t place = 0; place < made_.net.places().size(); ++place)
      if (chance(6)) made_.what.observed.push_back({place});
    for (std::uint32_t set = between(0, 3); set > 0; --set) {
      auto& transitions = made_.what.sets.emplace_back();
      for (std::uint32_t transition = 0; transition < made_.net.transitions().size(); ++transition)
        if (chance(4)) transitions.push_back({transition});
    }
    return std::move(made_);
  }

 private:
  std::uint32_t between(std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random_);
  }
  bool chance(std::uint32_t one_in) { return between(1, one_in) == 1; }

  net::PlaceId any_of(const std::vector<net::PlaceId>& places) {
    return places[between(0, static_cast<std::uint32_t>(places.size() - 1))];
  }

  net::PlaceId place(std::uint32_t tokens) {
    net::Place made;
    made.name = "p" + std::to_string(made_.net.places().size());
    made.tokens = tokens;
    return made_.net.add(std::move(made));
  }

  void transition(std::vector<net::Arc> inputs, std::vector<net::Arc> outputs) {
    for (auto* arcs : {&inputs, &outputs}) {
      std::ranges::sort(*arcs);
      arcs->erase(std::ranges::unique(*arcs, {}, &net::Arc::place).begin(), arcs->end());
    }
    net::Transition made;
    made.name = "t" + std::to_string(made_.net.transitions().size());
    if (chance(25)) made.condition.truth = net::Condition::Truth::never;
    made_.net.add(std::move(made), inputs, outputs);
  }

  /// Rings or paths of places, each with a token, that share buffers.
  void processes() {
    std::vector<net::PlaceId> buffers;
    for (std::uint32_t count = between(0, 3); count > 0; --count) buffers.push_back(place(between(0, 1)));
    for (std::uint32_t count = between(1, 3); count > 0; --count) {
      std::vector<net::PlaceId> ring{place(1)};
      for (std::uint32_t more = between(1, 5); more > 0; --more) ring.push_back(place(0));
      const bool closed = !chance(3);
      for (std::size_t index = 0; index + (closed ? 0 : 1) < ring.size(); ++index)
        step(ring[index], ring[(index + 1) % ring.size()], buffers);
      for (std::uint32_t more = between(0, 2); more > 0; --more) step(any_of(ring), any_of(ring), buffers);
    }
  }

  void step(net::PlaceId from, net::PlaceId to, const std::vector<net::PlaceId>& buffers) {
    std::vector<net::Arc> inputs{{from}}, outputs{{to}};
    for (const net::PlaceId buffer : buffers) {
      if (chance(4)) inputs.push_back({buffer});
      if (chance(4)) outputs.push_back({buffer});
    }
    transition(std::move(inputs), std::move(outputs));
  }

  void anything() {
    const std::uint32_t places = between(2, 7);
    for (std::uint32_t index = 0; index < places; ++index) place(chance(3) ? between(1, 2) : 0);
    for (std::uint32_t count = between(1, 8); count > 0; --count) {
      std::vector<net::Arc> inputs, outputs;
      for (std::uint32_t arcs = chance(12) ? 0 : between(1, 2); arcs > 0; --arcs)
        inputs.push_back(arc(places));
      for (std::uint32_t arcs = between(0, 2); arcs > 0; --arcs) outputs.push_back(arc(places));
      transition(std::move(inputs), std::move(outputs));
    }
  }

  net::Arc arc(std::uint32_t places) { return {{between(0, places - 1)}, chance(6) ? 2U : 1U}; }

  std::mt19937_64 random_;
  RandomCase made_;
};

}  // namespace

RandomCase random_case(std::uint64_t seed) { return RandomNet(seed).result(); }

}  // namespace tessera::test
