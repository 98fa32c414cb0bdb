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
void spoil(RandomNumbers& random, Model& model) {
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

}  // namespace

std::vector<Model> random_models(RandomNumbers& random) {
  std::vector<Model> models{hand_over(random.percent(50)), fickle(random.percent(40)), queue(),
                            newest(random.percent(50))};
  while (models.size() > 2) models.erase(models.begin() + random.below(static_cast<int>(models.size())));
  if (random.percent(25)) spoil(random, models[0]);
  return models;
}

}  // namespace oracle
