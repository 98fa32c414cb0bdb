// Communication models and properties for random specifications.
#include <algorithm>

#include "random_specification.hpp"

namespace oracle {
namespace {

using Transition = ModelSide::Transition;

Model hand_over(bool late) {
  Model model{"hand_over", 1, {{"free", 1}, {"there", 0}}, {}, {}};
  model.send = {{{"in"}, {"work", 1}, {"out"}},
                {{"t1", {"in", "free"}, {"work"}}, {"t2", {"work"}, {"out", "there"}}}};
  model.receive = {{{"in"}, {"work", 1}, {"out"}},
                   {{"t1", {"in", "there"}, {"work"}}, {"t2", {"work"}, {"out", "free"}}}};
  if (late) model.receive.transitions.push_back(Transition{"late", {"in", "free"}, {"out", "free"}, true});
  return model;
}

Model fickle(bool late) {
  Model model{"fickle", 1, {{"empty", 1}, {"full", 0}, {"ack", 0}}, {}, {}};
  model.send = {{{"in"}, {"work", 1}, {"wait"}, {"out"}},
                {{"t1", {"in", "empty"}, {"work"}},
                 {"t2", {"work"}, {"wait", "full"}},
                 {"t3", {"wait", "ack"}, {"out"}}}};
  if (late) model.send.transitions.push_back(Transition{"late", {"wait", "full"}, {"out", "empty"}, true});
  model.receive = {{{"in"}, {"work", 1}, {"out"}},
                   {{"t1", {"in", "full"}, {"work"}},
                    {"t2", {"work"}, {"out", "empty", "ack"}},
                    {"pass_by", {"in", "full"}, {"out", "full"}},
                    {"skip", {"in", "empty"}, {"out", "empty"}}}};
  return model;
}

Model queue() {
  Model model{"queue",
              2,
              {{"empty_1", 1},
               {"full_1", 0},
               {"empty_2", 1},
               {"full_2", 0},
               {"put_1", 1},
               {"put_2", 0},
               {"get_1", 1},
               {"get_2", 0}},
              {},
              {}};
  model.send = {{{"in"}, {"first", 1}, {"second", 2}, {"out"}},
                {{"begin_1", {"in", "put_1", "empty_1"}, {"first"}},
                 {"end_1", {"first"}, {"out", "full_1", "put_2"}},
                 {"begin_2", {"in", "put_2", "empty_2"}, {"second"}},
                 {"end_2", {"second"}, {"out", "full_2", "put_1"}}}};
  model.receive = {{{"in"}, {"first", 1}, {"second", 2}, {"out"}},
                   {{"begin_1", {"in", "get_1", "full_1"}, {"first"}},
                    {"end_1", {"first"}, {"out", "empty_1", "get_2"}},
                    {"begin_2", {"in", "get_2", "full_2"}, {"second"}},
                    {"end_2", {"second"}, {"out", "empty_2", "get_1"}}}};
  return model;
}

Model newest(bool late) {
  Model model = hand_over(late);
  model.name = "newest";
  model.send.transitions.push_back(Transition{"again", {"in", "there"}, {"work"}, false});
  return model;
}

/// One token or one arc to a shared place changed; most of what comes out is unsound.
void spoil(Random& random, Model& model) {
  if (random.percent(30)) {
    auto& [name, tokens] =
        model.shared[static_cast<std::size_t>(random.below(static_cast<int>(model.shared.size())))];
    tokens = 1 - tokens;
    return;
  }
  ModelSide& side = random.percent(50) ? model.send : model.receive;
  auto& transition =
      side.transitions[static_cast<std::size_t>(random.below(static_cast<int>(side.transitions.size())))];
  auto& places = random.percent(50) ? transition.from : transition.to;
  if (places.size() > 1)
    places.pop_back();
  else
    places.push_back(random.of(model.shared).first);
}

/// Writes formulas over what a net has.
class Formulas {
 public:
  Formulas(Random& random, const Specification& specification)
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
    return "." + subsystem.name + "." + random_.of(subsystem.behaviours).name +
           (random_.percent(25) ? random_.of(pages_) : "");
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
      if (place.fused)
        channel_states.push_back(place.name);
      else if (place.name.ends_with(".2") || place.name.ends_with(".wait") || place.name.ends_with(".work"))
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
      made.path = random_.of(net_.behaviours).path + (random_.percent(45) ? random_.of(pages_) : "");
    }
    return made;
  }

  Random& random_;
  const Specification& specification_;
  FlatNet net_;
  std::vector<const Agent*> fleets_;
  std::vector<std::string> pages_{".in",     ".out",     ".2",      ".snd",    ".rcv",
                                  ".snd.in", ".snd.out", ".rcv.in", ".rcv.out"};
};

}  // namespace

std::vector<Model> random_models(Random& random) {
  std::vector<Model> models{hand_over(random.percent(50)), fickle(random.percent(40)), queue(),
                            newest(random.percent(50))};
  while (models.size() > 2) models.erase(models.begin() + random.below(static_cast<int>(models.size())));
  if (random.percent(25)) spoil(random, models[0]);
  return models;
}

std::vector<Property> random_properties(Random& random, const Specification& specification) {
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
