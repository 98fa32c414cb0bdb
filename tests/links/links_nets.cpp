#include "links_nets.hpp"

#include "blocks.hpp"

namespace tessera::testing::nets {
namespace {

constexpr Behaviour far_run[] = {{"run"}};
constexpr Port far_sends[] = {{"x", Side::send, "x"}};
constexpr Port far_receives[] = {{"x", Side::receive, "x"}};
constexpr Place far_send_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("run"), SEND_PLACES("run", "x"), WAIT_PLACE("run", "x")};
constexpr Place far_nb_send_places[] = {{"in"}, {"out"}, BEHAVIOUR_PLACES("run"), SEND_PLACES("run", "x")};
constexpr Place far_receive_places[] = {{"in"}, {"out"}, BEHAVIOUR_PLACES("run"), RECEIVE_PLACES("run", "x")};

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

const Transition far_nb_send[] = {FAR_SENDER, FAR_SEND_TO("run.snd.out"), FAR_SEND_MORE_TO("run.snd.out")};
const Transition far_b_send[] = {FAR_SENDER, FAR_SEND_TO("run.snd.x.wait"), FAR_ACKNOWLEDGED};
const Transition far_b_send_timed[] = {
    FAR_SENDER, FAR_SEND_TO("run.snd.x.wait"), FAR_SEND_MORE_TO("run.snd.x.wait"), FAR_ACKNOWLEDGED,
    {"run.snd.x.timeout", {"run.snd.x.wait"}, {"run.snd.out"}, if_elapsed_at("x")},
    {"run.snd.x.withdraw", {"run.snd.x.wait", "x/sent"}, {"run.snd.out", "x/idle"}, if_elapsed},
    {"run.snd.x.withdraw_m", {"run.snd.x.wait", "x/more"}, {"run.snd.out", "x/sent"}, if_elapsed},
    {"run.snd.x.recall", {"run.snd.x.wait", "x/idle", "x/full"}, {"run.snd.out", "x/idle", "x/empty"}, if_elapsed}};
const Transition far_b_receive[] = {FAR_RECEIVER, B_RECEIVE("run", "x", "run.rcv.in", "run.rcv.out")};
const Transition far_b_receive_timed[] = {FAR_RECEIVER, B_RECEIVE("run", "x", "run.rcv.in", "run.rcv.out"),
                                          RECEIVE_TIMEOUT("run", "x", "run.rcv.in", "run.rcv.out")};
const Transition far_nb_receive[] = {FAR_RECEIVER, B_RECEIVE("run", "x", "run.rcv.in", "run.rcv.out"),
                                     RECEIVE_SKIP("run", "x", "run.rcv.in", "run.rcv.out")};
const Transition far_exchange_send[] = {
    ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_RECEIVE("run"), NEXT_END("run", 0),
    {"run.snd.x.t1", {"run.snd.in", "x/sent_memory"}, {"run.snd.x.2"}},
    {"run.snd.x.t2", {"run.snd.x.2"}, {"run.snd.out", "x/sent_memory"}}};
const Transition far_exchange_receive[] = {
    FAR_RECEIVER,
    {"run.rcv.x.t1", {"run.rcv.in", "x/received_memory"}, {"run.rcv.x.2"}},
    {"run.rcv.x.t2", {"run.rcv.x.2"}, {"run.rcv.out", "x/received_memory"}}};
// clang-format on

}  // namespace

const SubsystemNet far_nb_sender{far_run, far_sends, far_nb_send_places, far_nb_send};
const SubsystemNet far_b_sender{far_run, far_sends, far_send_places, far_b_send};
const SubsystemNet far_b_sender_timed{far_run, far_sends, far_send_places, far_b_send_timed};
const SubsystemNet far_b_receiver{far_run, far_receives, far_receive_places, far_b_receive};
const SubsystemNet far_b_receiver_timed{far_run, far_receives, far_receive_places, far_b_receive_timed};
const SubsystemNet far_nb_receiver{far_run, far_receives, far_receive_places, far_nb_receive};
const SubsystemNet far_exchange_sender{far_run, far_sends, far_nb_send_places, far_exchange_send};
const SubsystemNet far_exchange_receiver{far_run, far_receives, far_receive_places, far_exchange_receive};

}  // namespace tessera::testing::nets
