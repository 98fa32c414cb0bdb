#include "links_nets.hpp"

#include "blocks.hpp"

namespace tessera::testing::nets {
namespace {

constexpr Behaviour far_run[] = {{"run"}};
constexpr Port far_sends[] = {{"x", Side::send, "x"}};
constexpr Port far_receives[] = {{"x", Side::receive, "x"}};
constexpr named::Place far_send_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("run"), SEND_PLACES("run", "x"), WAIT_PLACE("run", "x")};
constexpr named::Place far_nb_send_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("run"), SEND_PLACES("run", "x")};
constexpr named::Place far_receive_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("run"), RECEIVE_PLACES("run", "x")};

// clang-format off
#define FAR_SENDER ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_RECEIVE("run"), NEXT_END("run", 0), \
  {"run.snd.x.t1", {"run.snd.in"}, {"run.snd.x.2"}}
#define FAR_RECEIVER ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_SEND("run"), NEXT_END("run", 0)
#define FAR_SEND_TO(after) \
  {"run.snd.x.t2", {"run.snd.x.2", "x/idle"}, {after, "x/sent"}}
#define FAR_SEND_MORE_TO(after) \
  {"run.snd.x.t2n", {"run.snd.x.2", "x/sent"}, {after, "x/more"}}, \
  {"run.snd.x.t2m", {"run.snd.x.2", "x/more"}, {after, "x/more"}}
#define FAR_ACKNOWLEDGED \
  {"run.snd.x.t3", {"run.snd.x.wait", "x/idle", "x/empty"}, {"run.snd.out", "x/idle", "x/empty"}}

const named::Transition far_nb_send[] = {FAR_SENDER, FAR_SEND_TO("run.snd.out"), FAR_SEND_MORE_TO("run.snd.out")};
const named::Transition far_b_send[] = {FAR_SENDER, FAR_SEND_TO("run.snd.x.wait"), FAR_ACKNOWLEDGED};
const named::Transition far_b_send_timed[] = {
    FAR_SENDER, FAR_SEND_TO("run.snd.x.wait"), FAR_SEND_MORE_TO("run.snd.x.wait"), FAR_ACKNOWLEDGED,
    {"run.snd.x.timeout", {"run.snd.x.wait"}, {"run.snd.out"}, named::if_elapsed_at("x")},
    {"run.snd.x.withdraw", {"run.snd.x.wait", "x/sent"}, {"run.snd.out", "x/idle"}, if_elapsed},
    {"run.snd.x.withdraw_m", {"run.snd.x.wait", "x/more"}, {"run.snd.out", "x/sent"}, if_elapsed},
    {"run.snd.x.recall", {"run.snd.x.wait", "x/idle", "x/full"}, {"run.snd.out", "x/idle", "x/empty"}, if_elapsed}};
const named::Transition far_b_receive[] = {FAR_RECEIVER, B_RECEIVE("run", "x", "run.rcv.in", "run.rcv.out")};
const named::Transition far_b_receive_timed[] = {FAR_RECEIVER, B_RECEIVE("run", "x", "run.rcv.in", "run.rcv.out"),
                                          RECEIVE_TIMEOUT("run", "x", "run.rcv.in", "run.rcv.out")};
const named::Transition far_nb_receive[] = {FAR_RECEIVER, B_RECEIVE("run", "x", "run.rcv.in", "run.rcv.out"),
                                     RECEIVE_SKIP("run", "x", "run.rcv.in", "run.rcv.out")};
const named::Transition far_exchange_send[] = {
    ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_RECEIVE("run"), NEXT_END("run", 0),
    {"run.snd.x.t1", {"run.snd.in", "x/sent_memory"}, {"run.snd.x.2"}},
    {"run.snd.x.t2", {"run.snd.x.2"}, {"run.snd.out", "x/sent_memory"}}};
const named::Transition far_exchange_receive[] = {
    FAR_RECEIVER,
    {"run.rcv.x.t1", {"run.rcv.in", "x/received_memory"}, {"run.rcv.x.2"}},
    {"run.rcv.x.t2", {"run.rcv.x.2"}, {"run.rcv.out", "x/received_memory"}}};
// clang-format on

}  // namespace

const SubsystemNet far_nb_sender = numbered(far_run, far_sends, far_nb_send_places, far_nb_send, networked);
const SubsystemNet far_b_sender = numbered(far_run, far_sends, far_send_places, far_b_send, networked);
const SubsystemNet far_b_sender_timed =
    numbered(far_run, far_sends, far_send_places, far_b_send_timed, networked);
const SubsystemNet far_b_receiver =
    numbered(far_run, far_receives, far_receive_places, far_b_receive, networked);
const SubsystemNet far_b_receiver_timed =
    numbered(far_run, far_receives, far_receive_places, far_b_receive_timed, networked);
const SubsystemNet far_nb_receiver =
    numbered(far_run, far_receives, far_receive_places, far_nb_receive, networked);
const SubsystemNet far_exchange_sender =
    numbered(far_run, far_sends, far_nb_send_places, far_exchange_send, networked_exchange);
const SubsystemNet far_exchange_receiver =
    numbered(far_run, far_receives, far_receive_places, far_exchange_receive, networked_exchange);

}  // namespace tessera::testing::nets
