#include "oracle/judge/flat_net.hpp"
#include "oracle/judge/groups.hpp"
#include "random_specification.hpp"

namespace oracle {
namespace {

/// Writes formulas over the elements of a net.
class Formulas {
 public:
  Formulas(RandomNumbers& random, const Specification& specification)
      : random_(random), specification_(specification), net_(flat_net(specification)) {
    for (const Agent& agent : specification.agents)
      if (agent.count > 0) fleets_.push_back(&agent);
  }

  Formula formula(int depth) {
    const int kind = depth == 0 ? 0 : random_.below(100);
    if (kind < 50) return atom();
    Formula made;
    made.kind = kind < 70   ? Formula::Kind::all_of
                : kind < 85 ? Formula::Kind::any_of
                            : Formula::Kind::negation;
    made.parts.push_back(formula(depth - 1));
    if (made.kind != Formula::Kind::negation) made.parts.push_back(formula(depth - 1));
    return made;
  }
  bool fleets() const { return !fleets_.empty(); }

  /// Said of every agent of a fleet on its own, or of every `i`.
  void said_of_all(Property& property) {
    const Agent& fleet = *random_.of(fleets_);
    const bool neighbours = random_.percent(60);
    const auto path = [&](const char* index) {
      Formula made;
      made.path = fleet.name + index + behaviour_in(fleet);
      return made;
    };
    property.first = path(neighbours ? "[i]" : "[*]");
    property.second = path(neighbours ? "[i+1]" : "[*]");
    if (neighbours && property.kind != Property::Kind::leads_to) {
      Formula both;
      both.kind = random_.percent(70) ? Formula::Kind::all_of : Formula::Kind::any_of;
      both.parts = {property.first, path("[i+1]")};
      property.first = both;
    }
  }

 private:
  std::string behaviour_in(const Agent& agent) {
    const Subsystem& subsystem = random_.of(subsystems_of(specification_, agent));
    const Behaviour& behaviour = random_.of(subsystem.behaviours);
    return "." + subsystem.name + "." + path_in(subsystem, behaviour) +
           (random_.percent(25) ? page_in(behaviour) : "");
  }

  std::string page_in(const Behaviour& behaviour) {
    const std::string& page = random_.of(pages_);
    return !behaviour.is_group ? page : page.size() % 2 == 0 ? ".in" : ".out";
  }

  Formula atom() {
    Formula made;
    const int kind = random_.below(100);
    if (kind < 15 && fleets()) {
      const Agent& fleet = *random_.of(fleets_);
      made.kind = random_.percent(50) ? Formula::Kind::any : Formula::Kind::all;
      made.path = fleet.name + "[*]" + behaviour_in(fleet);
      return made;
    }
    std::vector<std::string> channel_states, inner;
    for (const auto& place : net_.places) {
      if (place.fused && place.name.find("->") != std::string::npos)
        channel_states.push_back(place.name);
      else if (!place.fused &&
               (place.name.ends_with(".2") || place.name.ends_with(".wait") || place.name.ends_with(".work")))
        inner.push_back(place.name);
    }
    if (kind < 40 && !channel_states.empty()) {
      made.path = random_.of(channel_states);
      if (random_.percent(50)) made.path.replace(made.path.find("->"), 2, " -> ");
    } else if (kind < 48) {
      made.path = random_.of(inner);
    } else if (kind < 53) {
      made.path = random_.of(net_.subsystems).path + ".out";
    } else {
      const FlatNet::BehaviourInfo& behaviour = random_.of(net_.behaviours);
      made.path = behaviour.path + (random_.percent(45) ? page_in(*behaviour.of) : "");
    }
    return made;
  }

  RandomNumbers& random_;
  const Specification& specification_;
  FlatNet net_;
  std::vector<const Agent*> fleets_;
  std::vector<std::string> pages_{".in",     ".out",     ".2",      ".snd",    ".rcv",
                                  ".snd.in", ".snd.out", ".rcv.in", ".rcv.out"};
};

}  // namespace

std::vector<Property> random_properties(RandomNumbers& random, const Specification& specification) {
  Formulas formulas(random, specification);
  std::vector<Property> properties;
  const int number = 1 + random.below(4);
  for (int p = 0; p < number; ++p) {
    Property property;
    property.kind = static_cast<Property::Kind>(random.below(5));
    property.name = "q" + std::to_string(p);
    property.arrow = random.percent(50);
    if (formulas.fleets() && random.percent(25)) {
      formulas.said_of_all(property);
    } else {
      property.first = formulas.formula(2);
      property.second = formulas.formula(1);
    }
    properties.push_back(property);
  }
  return properties;
}

}  // namespace oracle
