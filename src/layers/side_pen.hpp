#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/model/communication_model.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {

/// Draws a built-in communication model; arcs name places.
class ModelPen {
 public:
  using Names = std::initializer_list<std::string_view>;

  explicit ModelPen(spec::CommunicationModel& model) : model_(model) {}

  void shared(std::string_view name, std::uint32_t tokens) {
    model_.shared.push_back({std::string(name), tokens, {}});
  }
  void medium(std::string_view name, Names takes, Names gives) {
    spec::MediumTransition transition{std::string(name), {}, {}};
    for (const std::string_view place : takes) transition.takes.push_back(of(place));
    for (const std::string_view place : gives) transition.gives.push_back(of(place));
    model_.medium.push_back(std::move(transition));
  }
  /// Precondition: the shared place exists.
  [[nodiscard]] std::uint32_t of(std::string_view name) const {
    const auto place = std::ranges::find(model_.shared, name, &spec::SharedPlace::name);
    return static_cast<std::uint32_t>(place - model_.shared.begin());
  }

 private:
  spec::CommunicationModel& model_;
};

/// One side in the making.
class SidePen {
 public:
  SidePen(spec::CommunicationModel& around, spec::ModelSide& side) : around_(around), side_(side) {
    place(words::input);
    place(words::output);
  }

  void place(std::string_view name, std::optional<std::uint32_t> slot = {}) {
    side_.places.push_back({std::string(name), slot, {}});
  }

  using Names = std::initializer_list<std::string_view>;
  void transition(std::string_view name, Names from, Names to, bool elapsed = false) {
    spec::ModelSide::Transition transition;
    transition.name = name;
    transition.elapsed = elapsed;
    for (const std::string_view end : from) join(end, transition.from, transition.takes);
    for (const std::string_view end : to) join(end, transition.to, transition.gives);
    side_.transitions.push_back(std::move(transition));
  }

 private:
  void join(std::string_view name, std::uint32_t& own, std::vector<std::uint32_t>& shared) const {
    const auto place = std::ranges::find(side_.places, name, &spec::ModelSide::Place::name);
    if (place != side_.places.end())
      own = static_cast<std::uint32_t>(place - side_.places.begin());
    else
      shared.push_back(around_.of(name));
  }

  ModelPen around_;
  spec::ModelSide& side_;
};

}  // namespace tessera::layers
