#include "small_nets.hpp"

#include <vector>

namespace tessera::explore {
namespace {

std::vector<net::Arc> arcs(std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> ends) {
  std::vector<net::Arc> result;
  for (const auto& [place, weight] : ends) result.push_back({net::PlaceId{place}, weight});
  return result;
}

}  // namespace

net::Net places_with(std::initializer_list<std::uint32_t> tokens) {
  net::Net net;
  for (const std::uint32_t count : tokens) {
    net::Place place;
    place.name = "p" + std::to_string(net.places().size());
    place.tokens = count;
    net.add(std::move(place));
  }
  return net;
}

net::TransitionId join(net::Net& net, std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> inputs,
                       std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> outputs) {
  net::Transition transition;
  transition.name = "t" + std::to_string(net.transitions().size());
  return net.add(std::move(transition), arcs(inputs), arcs(outputs));
}

net::Net ring_of(std::uint32_t places, std::uint32_t tokens) {
  net::Net net = places_with({tokens});
  for (std::uint32_t place = 1; place < places; ++place) {
    net::Place next;
    next.name = "p" + std::to_string(place);
    net.add(std::move(next));
  }
  for (std::uint32_t place = 0; place < places; ++place) join(net, {{place, 1}}, {{(place + 1) % places, 1}});
  return net;
}

net::Net fork_in_the_road() {
  net::Net net = places_with({1, 0, 0});
  join(net, {{0, 1}}, {{1, 1}});
  join(net, {{0, 1}}, {{2, 1}});
  join(net, {{1, 1}}, {{1, 1}});
  return net;
}

net::Net philosophers(std::uint32_t count) {
  net::Net net;
  for (std::uint32_t seat = 0; seat < count; ++seat)
    for (const auto& [name, tokens] :
         {std::pair{"thinking", 1U}, {"left", 0U}, {"eating", 0U}, {"fork", 1U}}) {
      net::Place place;
      place.name = name + std::to_string(seat);
      place.tokens = tokens;
      net.add(std::move(place));
    }
  for (std::uint32_t seat = 0; seat < count; ++seat) {
    const std::uint32_t own = 4 * seat, other_fork = 4 * ((seat + 1) % count) + 3;
    join(net, {{own, 1}, {own + 3, 1}}, {{own + 1, 1}});
    join(net, {{own + 1, 1}, {other_fork, 1}}, {{own + 2, 1}});
    join(net, {{own + 2, 1}}, {{own, 1}, {own + 3, 1}, {other_fork, 1}});
  }
  return net;
}

net::Net spring() {
  net::Net net = places_with({0});
  join(net, {}, {{0, 1}});
  return net;
}

}  // namespace tessera::explore
