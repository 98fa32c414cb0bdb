#include "reduce/components.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <unordered_map>

namespace tessera::reduce {
namespace {

using Colour = std::uint64_t;

Colour mix(Colour a, Colour b) {
  Colour mixed = (a ^ (b + 0x9e3779b97f4a7c15ULL + (a << 6U) + (a >> 2U))) * 0xff51afd7ed558ccdULL;
  return mixed ^ (mixed >> 32U);
}

/// Places and transitions as one list of elements, places first. Equal elements have the same colour.
class Colours {
 public:
  Colours(const net::Net& net, const std::vector<std::vector<std::uint32_t>>& sets)
      : net_(net), places_(static_cast<std::uint32_t>(net.places().size())) {
    // Names are numbered as they come, so that the order of colours does not depend on what they say.
    std::unordered_map<std::string, Colour> numbers;
    const auto number = [&](const std::string& name) {
      return numbers.try_emplace(template_name(name), numbers.size()).first->second;
    };
    for (const net::Place& place : net.places()) colours_.push_back(mix(number(place.name), place.tokens));
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      colours_.push_back(mix(number(net.transitions()[index].name), sets[index].size()));
    // Names distinguish most elements; a few rounds pass the difference on to their neighbours.
    for (int round = 0; round < 4; ++round) refine();
  }

  [[nodiscard]] Colour of(std::uint32_t element) const { return colours_[element]; }

 private:
  void refine() {
    std::vector<Colour> next = colours_;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index) {
      const std::uint32_t transition = places_ + index;
      const auto pass = [&](std::span<const net::Arc> arcs, Colour direction) {
        for (const net::Arc& arc : arcs) {
          const Colour by = direction + arc.weight;
          // Sums are used because they do not depend on the order of the arcs.
          next[arc.place.value] += mix(colours_[transition], by);
          next[transition] += mix(colours_[arc.place.value], by);
        }
      };
      pass(net_.preset({index}), 1);
      pass(net_.postset({index}), Colour{1} << 40U);
    }
    colours_ = std::move(next);
  }

  const net::Net& net_;
  std::uint32_t places_;
  std::vector<Colour> colours_;
};

/// A component described in its canonical order. Components with equal descriptions are equal.
using Description = std::vector<std::uint32_t>;

class Split {
 public:
  Split(const net::Net& net, const std::vector<std::vector<net::TransitionId>>& sets)
      : net_(net),
        places_(static_cast<std::uint32_t>(net.places().size())),
        sets_of_(net.transitions().size()),
        position_(net.places().size()) {
    for (std::uint32_t set = 0; set < sets.size(); ++set)
      for (const net::TransitionId transition : sets[set]) sets_of_[transition.value].push_back(set);
  }

  Components result() {
    const Colours colours(net_, sets_of_);
    Components components;
    std::map<Description, std::uint32_t> kinds;
    for (std::vector<std::uint32_t>& elements : connected()) {
      std::ranges::stable_sort(elements, {}, [&](std::uint32_t element) {
        return std::pair(element >= places_, colours.of(element));
      });
      Component component;
      for (const std::uint32_t element : elements) {
        if (element < places_)
          component.places.push_back({element});
        else
          component.transitions.push_back({element - places_});
      }
      const auto number = static_cast<std::uint32_t>(kinds.size());
      component.kind = kinds.emplace(describe(component), number).first->second;
      components.all.push_back(std::move(component));
    }
    components.kinds = static_cast<std::uint32_t>(kinds.size());
    return components;
  }

 private:
  std::vector<std::vector<std::uint32_t>> connected() const {
    std::vector<std::uint32_t> leader(places_ + net_.transitions().size());
    std::iota(leader.begin(), leader.end(), 0U);
    const auto find = [&](std::uint32_t at) {
      while (leader[at] != at) at = leader[at] = leader[leader[at]];
      return at;
    };
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      for (const auto& arcs : {net_.preset({index}), net_.postset({index})})
        for (const net::Arc& arc : arcs) {
          const std::uint32_t a = find(places_ + index), b = find(arc.place.value);
          leader[std::max(a, b)] = std::min(a, b);
        }
    std::vector<std::vector<std::uint32_t>> groups;
    std::vector<std::uint32_t> number(leader.size());
    for (std::uint32_t element = 0; element < leader.size(); ++element) {
      if (find(element) == element) {
        number[element] = static_cast<std::uint32_t>(groups.size());
        groups.emplace_back();
      }
      groups[number[find(element)]].push_back(element);
    }
    return groups;
  }

  Description describe(const Component& component) {
    Description text;
    for (std::uint32_t index = 0; index < component.places.size(); ++index) {
      position_[component.places[index].value] = index;
      text.push_back(net_[component.places[index]].tokens);
    }
    std::map<std::uint32_t, std::uint32_t> local_sets;
    for (const net::TransitionId transition : component.transitions) {
      for (const auto& arcs : {net_.preset(transition), net_.postset(transition)}) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
        for (const net::Arc& arc : arcs) ends.emplace_back(position_[arc.place.value], arc.weight);
        std::ranges::sort(ends);
        text.push_back(static_cast<std::uint32_t>(ends.size()));
        for (const auto& [place, weight] : ends) text.insert(text.end(), {place, weight});
      }
      text.push_back(static_cast<std::uint32_t>(sets_of_[transition.value].size()));
      for (const std::uint32_t set : sets_of_[transition.value])
        text.push_back(local_sets.emplace(set, static_cast<std::uint32_t>(local_sets.size())).first->second);
    }
    // Descriptions of components of different sizes could otherwise begin alike.
    text.push_back(static_cast<std::uint32_t>(component.places.size()));
    return text;
  }

  const net::Net& net_;
  std::uint32_t places_;
  std::vector<std::vector<std::uint32_t>> sets_of_;  // per transition
  std::vector<std::uint32_t> position_;              // per place, within its component
};

}  // namespace

Components components(const net::Net& net, const std::vector<std::vector<net::TransitionId>>& sets) {
  return Split(net, sets).result();
}

std::string template_name(const std::string& name) {
  std::string text;
  bool inside = false;
  for (const char letter : name) {
    if (letter == ']') inside = false;
    if (!inside) text += letter;
    if (letter == '[') inside = true;
  }
  return text;
}

}  // namespace tessera::reduce
