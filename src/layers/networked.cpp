#include "layers/networked.hpp"

#include "layers/side_pen.hpp"

namespace tessera::layers {
namespace {

using spec::CommunicationModel;
using spec::ModelSide;

constexpr std::uint32_t senders_slot = 0, receivers_slot = 1;

/// Both sides non-blocking: each uses its own memory, and nothing joins them.
void draw_independent(CommunicationModel& model) {
  ModelPen pen(model);
  pen.shared(words::sent_memory, 1);
  pen.shared(words::received_memory, 1);
  const auto draw = [&](ModelSide& whose, std::uint32_t slot, std::string_view memory) {
    SidePen side(model, whose);
    side.place(words::transfer, slot);
    side.transition(words::begin_transfer, {words::input, memory}, {words::transfer});
    side.transition(words::end_transfer, {words::transfer}, {words::output, memory});
  };
  draw(model.send, senders_slot, words::sent_memory);
  draw(model.receive, receivers_slot, words::received_memory);
}

/// The sender gave up, and cannot tell what became of the value.
void draw_ends_of_timeout(SidePen& side) {
  const auto ends = [&](std::string_view name, SidePen::Names from, SidePen::Names to) {
    side.transition(name, from, to, true);
  };
  ends(words::timeout, {words::waiting}, {words::output});
  ends(words::withdraw, {words::waiting, words::sent}, {words::output, words::idle});
  ends(words::withdraw_newest, {words::waiting, words::more}, {words::output, words::sent});
  ends(words::recall, {words::waiting, words::idle, words::full}, {words::output, words::idle, words::empty});
}

void draw_networked_send(CommunicationModel& model, SideMode mode) {
  SidePen side(model, model.send);
  const bool one_at_most = mode.blocks && !mode.timeout;
  const std::string_view after = mode.blocks ? words::waiting : words::output;
  side.place(words::transfer, senders_slot);
  if (mode.blocks) side.place(words::waiting);
  side.transition(words::begin_transfer, {words::input}, {words::transfer});
  side.transition(words::end_transfer, {words::transfer, words::idle}, {after, words::sent});
  if (!one_at_most) {
    side.transition(words::end_transfer_second, {words::transfer, words::sent}, {after, words::more});
    side.transition(words::end_transfer_more, {words::transfer, words::more}, {after, words::more});
  }
  if (!mode.blocks) return;
  // Neither on the way nor in the slot nor being read: it was taken.
  side.transition(words::take_acknowledgement, {words::waiting, words::idle, words::empty},
                  {words::output, words::idle, words::empty});
  if (mode.timeout) draw_ends_of_timeout(side);
}

void draw_networked_receive(CommunicationModel& model, SideMode mode) {
  SidePen side(model, model.receive);
  side.place(words::transfer, receivers_slot);
  side.transition(words::begin_transfer, {words::input, words::full}, {words::transfer});
  side.transition(words::end_transfer, {words::transfer}, {words::output, words::empty});
  if (!mode.blocks || mode.timeout)
    side.transition(mode.blocks ? words::timeout : words::skip, {words::input, words::empty},
                    {words::output, words::empty}, mode.blocks);
}

void draw_medium(CommunicationModel& model, bool one_at_most) {
  ModelPen pen(model);
  pen.medium(words::deliver, {words::sent, words::empty}, {words::idle, words::full});
  if (one_at_most) return;
  pen.medium(words::replace, {words::sent, words::full}, {words::idle, words::full});
  pen.medium(words::deliver_older, {words::more, words::empty}, {words::more, words::full});
  pen.medium(words::lose_older, {words::more}, {words::sent});
}

}  // namespace

CommunicationModel networked(SideMode send, SideMode receive) {
  CommunicationModel model;
  model.slots = 2;
  if (!send.blocks && !receive.blocks) {
    draw_independent(model);
    return model;
  }
  const bool one_at_most = send.blocks && !send.timeout;
  ModelPen pen(model);
  pen.shared(words::idle, 1);
  pen.shared(words::sent, 0);
  if (!one_at_most) pen.shared(words::more, 0);
  pen.shared(words::empty, 1);
  pen.shared(words::full, 0);
  draw_networked_send(model, send);
  draw_networked_receive(model, receive);
  draw_medium(model, one_at_most);
  return model;
}

}  // namespace tessera::layers
