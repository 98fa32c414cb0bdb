#include "layers/built_in.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

using spec::CommunicationModel;
using spec::Mode;
using spec::ModelSide;

/// One side in the making; arcs name places.
class SidePen {
 public:
  SidePen(const CommunicationModel& around, ModelSide& side) : around_(around), side_(side) {
    place(words::input);
    place(words::output);
  }

  void place(std::string_view name, std::uint32_t slot = ModelSide::no_slot) {
    side_.places.push_back({std::string(name), slot, {}});
  }

  using Names = std::initializer_list<std::string_view>;
  void transition(std::string_view name, Names from, Names to, bool elapsed = false) {
    ModelSide::Transition transition;
    transition.name = name;
    transition.elapsed = elapsed;
    for (const std::string_view end : from) join(end, transition.from, transition.takes);
    for (const std::string_view end : to) join(end, transition.to, transition.gives);
    side_.transitions.push_back(std::move(transition));
  }

 private:
  void join(std::string_view name, std::uint32_t& own, std::vector<std::uint32_t>& shared) const {
    const auto place = std::ranges::find(side_.places, name, &ModelSide::Place::name);
    if (place != side_.places.end()) {
      own = static_cast<std::uint32_t>(place - side_.places.begin());
      return;
    }
    const auto fused = std::ranges::find(around_.shared, name, &spec::SharedPlace::name);
    shared.push_back(static_cast<std::uint32_t>(fused - around_.shared.begin()));
  }

  const CommunicationModel& around_;
  ModelSide& side_;
};

/// Both sides non-blocking.
CommunicationModel exchange() {
  CommunicationModel model;
  model.shared = {{std::string(words::lock), 1, {}}};
  for (ModelSide* side : {&model.send, &model.receive}) {
    SidePen pen(model, *side);
    pen.place(words::transfer, 0);
    pen.transition(words::begin_transfer, {words::input, words::lock}, {words::transfer});
    pen.transition(words::end_transfer, {words::transfer}, {words::output, words::lock});
  }
  return model;
}

void draw_send(CommunicationModel& model, bool blocks, bool timeout) {
  SidePen pen(model, model.send);
  pen.place(words::transfer, 0);
  if (blocks) pen.place(words::waiting);
  pen.transition(words::begin_transfer, {words::input, words::empty}, {words::transfer});
  if (!blocks)
    pen.transition(words::overwrite, {words::input, words::full}, {words::transfer});  // overwrites
  if (!blocks) return pen.transition(words::end_transfer, {words::transfer}, {words::output, words::full});
  pen.transition(words::end_transfer, {words::transfer}, {words::waiting, words::full});
  pen.transition(words::take_acknowledgement, {words::waiting, words::acknowledged}, {words::output});
  if (timeout)
    pen.transition(words::timeout, {words::waiting, words::full}, {words::output, words::empty}, true);
}

void draw_receive(CommunicationModel& model, bool sender_blocks, bool blocks, bool timeout) {
  SidePen pen(model, model.receive);
  pen.place(words::transfer, 0);
  pen.transition(words::begin_transfer, {words::input, words::full}, {words::transfer});
  if (sender_blocks)
    pen.transition(words::end_transfer, {words::transfer},
                   {words::output, words::empty, words::acknowledged});
  else
    pen.transition(words::end_transfer, {words::transfer}, {words::output, words::empty});
  if (!blocks)
    pen.transition(words::skip, {words::input, words::empty}, {words::output, words::empty});
  else if (timeout)
    pen.transition(words::timeout, {words::input, words::empty}, {words::output, words::empty}, true);
}

CommunicationModel hand_over(Mode send, Mode receive, bool send_timeout, bool receive_timeout) {
  const bool sender_blocks = send == Mode::blocking;
  CommunicationModel model;
  model.shared = {{std::string(words::empty), 1, {}}, {std::string(words::full), 0, {}}};
  if (sender_blocks) model.shared.push_back({std::string(words::acknowledged), 0, {}});
  draw_send(model, sender_blocks, send_timeout);
  draw_receive(model, sender_blocks, receive == Mode::blocking, receive_timeout);
  return model;
}

std::array<CommunicationModel, 16> all_built_in() {
  std::array<CommunicationModel, 16> all;
  for (std::size_t index = 0; index < all.size(); ++index) {
    const Mode send{static_cast<std::uint8_t>(index & 1U)},
        receive{static_cast<std::uint8_t>(index >> 1U & 1U)};
    const bool blocks = send == Mode::blocking || receive == Mode::blocking;
    all[index] = blocks ? hand_over(send, receive, (index & 4U) != 0, (index & 8U) != 0) : exchange();
  }
  return all;
}

}  // namespace

const CommunicationModel& model_of(const spec::Model& model, const spec::Channel& channel) {
  static const std::array<CommunicationModel, 16> built_in = all_built_in();
  if (channel.model != spec::none) return model.models[channel.model];
  return built_in[static_cast<std::size_t>(channel.send) | static_cast<std::size_t>(channel.receive) << 1U |
                  static_cast<std::size_t>(channel.send_timeout.has_value()) << 2U |
                  static_cast<std::size_t>(channel.receive_timeout.has_value()) << 3U];
}

net::PlaceRole role_of(const spec::SharedPlace& place) {
  struct Known {
    std::string_view name;
    std::uint32_t tokens;
    net::PlaceRole role;
  };
  constexpr std::array<Known, 4> known{{{words::lock, 1, net::PlaceRole::lock},
                                        {words::empty, 1, net::PlaceRole::empty},
                                        {words::full, 0, net::PlaceRole::full},
                                        {words::acknowledged, 0, net::PlaceRole::acknowledged}}};
  const auto found = std::ranges::find(known, place.name, &Known::name);
  return found != known.end() && found->tokens == place.tokens ? found->role : net::PlaceRole::none;
}

net::PlaceRole role_of(const ModelSide::Place& place) {
  return place.name == words::waiting ? net::PlaceRole::waiting : net::PlaceRole::none;
}

net::TransitionRole role_of(const ModelSide::Transition& transition) {
  if (transition.name == words::overwrite) return net::TransitionRole::overwrite;
  return transition.name == words::skip ? net::TransitionRole::skip : net::TransitionRole::none;
}

}  // namespace tessera::layers
