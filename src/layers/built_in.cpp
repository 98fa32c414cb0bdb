#include "layers/built_in.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "layers/networked.hpp"
#include "layers/side_pen.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

using spec::CommunicationModel;
using spec::Mode;
using spec::ModelSide;

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

void draw_send(CommunicationModel& model, bool blocks, bool timeout, bool again) {
  SidePen pen(model, model.send);
  pen.place(words::transfer, 0);
  if (blocks) pen.place(words::waiting);
  pen.transition(words::begin_transfer, {words::input, words::empty}, {words::transfer});
  // A value that may be read again may have been read before.
  if (!blocks)
    pen.transition(again ? words::replace : words::overwrite, {words::input, words::full}, {words::transfer});
  if (!blocks) return pen.transition(words::end_transfer, {words::transfer}, {words::output, words::full});
  pen.transition(words::end_transfer, {words::transfer}, {words::waiting, words::full});
  pen.transition(words::take_acknowledgement, {words::waiting, words::acknowledged}, {words::output});
  if (timeout)
    pen.transition(words::timeout, {words::waiting, words::full}, {words::output, words::empty}, true);
}

void draw_receive(CommunicationModel& model, bool sender_blocks, Mode mode, bool timeout) {
  SidePen pen(model, model.receive);
  pen.place(words::transfer, 0);
  pen.transition(words::begin_transfer, {words::input, words::full}, {words::transfer});
  if (sender_blocks)
    pen.transition(words::end_transfer, {words::transfer},
                   {words::output, words::empty, words::acknowledged});
  else  // blocking_once: the value stays, so that no receive after the first one waits
    pen.transition(words::end_transfer, {words::transfer},
                   {words::output, mode == Mode::blocking_once ? words::full : words::empty});
  if (mode == Mode::non_blocking)
    pen.transition(words::skip, {words::input, words::empty}, {words::output, words::empty});
  else if (timeout)
    pen.transition(words::timeout, {words::input, words::empty}, {words::output, words::empty}, true);
}

CommunicationModel hand_over(Mode send, Mode receive, bool send_timeout, bool receive_timeout) {
  const bool sender_blocks = send == Mode::blocking;
  CommunicationModel model;
  model.shared = {{std::string(words::empty), 1, {}}, {std::string(words::full), 0, {}}};
  if (sender_blocks) model.shared.push_back({std::string(words::acknowledged), 0, {}});
  draw_send(model, sender_blocks, send_timeout, receive == Mode::blocking_once);
  draw_receive(model, sender_blocks, receive, receive_timeout);
  return model;
}

struct Form {
  Mode send, receive;
  bool send_timeout, receive_timeout;
  bool crosses;  ///< its ends are in different processes
};

constexpr std::size_t modes = static_cast<std::size_t>(Mode::blocking_once) + 1, forms = modes * modes * 8;

[[nodiscard]] std::size_t number_of(const Form& form) {
  std::size_t number = static_cast<std::size_t>(form.send) * modes + static_cast<std::size_t>(form.receive);
  for (const bool part : {form.send_timeout, form.receive_timeout, form.crosses}) number = number * 2 + part;
  return number;
}

[[nodiscard]] CommunicationModel drawn(const Form& form) {
  const bool send_blocks = form.send == Mode::blocking, receive_blocks = form.receive != Mode::non_blocking;
  if (form.crosses)
    return networked({send_blocks, form.send_timeout}, {receive_blocks, form.receive_timeout});
  if (!send_blocks && !receive_blocks) return exchange();
  return hand_over(form.send, form.receive, form.send_timeout, form.receive_timeout);
}

[[nodiscard]] std::array<CommunicationModel, forms> all_built_in() {
  std::array<CommunicationModel, forms> all;
  for (std::size_t number = 0; number < forms; ++number) {
    const Form form{Mode(number / 8 / modes), Mode(number / 8 % modes), (number & 4U) != 0,
                    (number & 2U) != 0, (number & 1U) != 0};
    all[number_of(form)] = drawn(form);
  }
  return all;
}

}  // namespace

const CommunicationModel& model_of(const spec::Model& model, const spec::Channel& channel) {
  static const std::array<CommunicationModel, forms> built_in = all_built_in();
  if (channel.model.valid()) return model.models[channel.model];
  return built_in[number_of({channel.send, channel.receive, channel.send_timeout.has_value(),
                             channel.receive_timeout.has_value(), model.crosses_processes(channel)})];
}

PlaceRole role_of(const spec::SharedPlace& place) {
  struct Known {
    std::string_view name;
    std::uint32_t tokens;
    PlaceRole role;
  };
  static const std::array<Known, 9> known{{{words::lock, 1, PlaceRole::lock},
                                           {words::empty, 1, PlaceRole::empty},
                                           {words::full, 0, PlaceRole::full},
                                           {words::acknowledged, 0, PlaceRole::acknowledged},
                                           {words::idle, 1, PlaceRole::idle},
                                           {words::sent, 0, PlaceRole::sent},
                                           {words::more, 0, PlaceRole::more},
                                           {words::sent_memory, 1, PlaceRole::sent_memory},
                                           {words::received_memory, 1, PlaceRole::received_memory}}};
  const auto found = std::ranges::find(known, place.name, &Known::name);
  return found != known.end() && found->tokens == place.tokens ? found->role : PlaceRole::none;
}

PlaceRole role_of(const ModelSide::Place& place) {
  return place.name == words::waiting ? PlaceRole::waiting : PlaceRole::none;
}

Step role_of(const spec::MediumTransition& transition) {
  if (transition.name == words::replace) return Step::replace;
  if (transition.name == words::deliver_older) return Step::deliver_older;
  return transition.name == words::lose_older ? Step::lose_older : Step::deliver;
}

Step role_of(const ModelSide::Transition& transition) {
  if (transition.elapsed) return Step::timeout;
  if (transition.name == words::overwrite) return Step::overwrite;
  return transition.name == words::skip ? Step::skip : Step::transfer;
}

}  // namespace tessera::layers
