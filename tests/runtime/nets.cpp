#include "nets.hpp"

#include "blocks.hpp"

namespace tessera::testing::nets {
namespace {

constexpr Behaviour run_only[] = {{"run"}};
constexpr Behaviour first_second[] = {{"first"}, {"second"}};
constexpr Port sends_x[] = {{"x", Side::send, "x"}};
constexpr Port receives_x[] = {{"x", Side::receive, "x"}};
constexpr Port sends_x_y[] = {{"x", Side::send, "x"}, {"y", Side::send, "y"}};

constexpr named::Place alone_places[] = {{"in"}, {"out"}, BEHAVIOUR_PLACES("run")};
const named::Transition alone_transitions[] = {ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_SEND("run"),
                                               NO_RECEIVE("run"), NEXT_END("run", 0)};

constexpr named::Place two_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("first"), BEHAVIOUR_PLACES("second")};
const named::Transition two_transitions[] = {ENTER("first"),
                                             BEHAVIOUR_TRANSITIONS("first"),
                                             NO_SEND("first"),
                                             NO_RECEIVE("first"),
                                             BEHAVIOUR_TRANSITIONS("second"),
                                             NO_SEND("second"),
                                             NO_RECEIVE("second"),
                                             NEXT("first", 0, "second"),
                                             NEXT_END("first", 1),
                                             NEXT("second", 0, "first")};

constexpr named::Place sender_places[] = {{"in"}, {"out"}, BEHAVIOUR_PLACES("run"), SEND_PLACES("run", "x")};
constexpr named::Place waiting_sender_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("run"), SEND_PLACES("run", "x"), WAIT_PLACE("run", "x")};
constexpr named::Place receiver_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("run"), RECEIVE_PLACES("run", "x")};

#define SENDER ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_RECEIVE("run"), NEXT_END("run", 0)
#define RECEIVER ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_SEND("run"), NEXT_END("run", 0)
#define SND "run", "x", "run.snd.in", "run.snd.out"
#define RCV "run", "x", "run.rcv.in", "run.rcv.out"
#define EXPAND(x) x
#define B2(block, ...) EXPAND(block(__VA_ARGS__))

const named::Transition async_send[] = {SENDER, B2(ASYNC_SEND, SND)};
const named::Transition async_receive[] = {RECEIVER, B2(ASYNC_RECEIVE, RCV)};
const named::Transition nb_send[] = {SENDER, B2(NB_SEND, SND)};
const named::Transition nb_send_persistent[] = {ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NO_RECEIVE("run"),
                                                NEXT("run", 0, "run"), B2(NB_SEND, SND)};
const named::Transition b_send[] = {SENDER, B2(B_SEND, SND)};
const named::Transition b_send_timed[] = {SENDER, B2(B_SEND, SND), B2(B_SEND_TIMEOUT, SND)};
/// Iterations may skip the send.
constexpr named::Place skipping_places[] = {{"in"},
                                            {"out"},
                                            {"run.in", named::calls("run")},
                                            {"run.snd.in", named::asks("x")},
                                            {"run.snd.out"},
                                            {"run.2", named::counts()},
                                            {"run.rcv.in"},
                                            {"run.rcv.out", named::decides("run")},
                                            {"run.out", named::routes("run")},
                                            SEND_PLACES("run", "x"),
                                            WAIT_PLACE("run", "x")};
const named::Transition skipping_send[] = {
    SENDER,
    {"run.snd.x.skip", {"run.snd.in"}, {"run.snd.out"}, if_skips},
    {"run.snd.x.t1", {"run.snd.in", "x/empty"}, {"run.snd.x.2"}, if_sends},
    {"run.snd.x.t2", {"run.snd.x.2"}, {"run.snd.x.wait", "x/full"}},
    {"run.snd.x.t3", {"run.snd.x.wait", "x/ack"}, {"run.snd.out"}},
    B2(B_SEND_TIMEOUT, SND)};
const named::Transition b_receive[] = {RECEIVER, B2(B_RECEIVE, RCV)};
const named::Transition b_receive_timed[] = {RECEIVER, B2(B_RECEIVE, RCV), B2(RECEIVE_TIMEOUT, RCV)};
const named::Transition nb_receive[] = {RECEIVER, B2(B_RECEIVE, RCV), B2(RECEIVE_SKIP, RCV)};
const named::Transition once_receive[] = {RECEIVER,
                                          {"run.rcv.x.t1", {"run.rcv.in", "x/full"}, {"run.rcv.x.2"}},
                                          {"run.rcv.x.t2", {"run.rcv.x.2"}, {"run.rcv.out", "x/full"}},
                                          B2(RECEIVE_TIMEOUT, RCV)};
const named::Transition b_receive_ack[] = {RECEIVER, B2(B_RECEIVE_ACK, RCV)};
const named::Transition b_receive_ack_timed[] = {RECEIVER, B2(B_RECEIVE_ACK, RCV), B2(RECEIVE_TIMEOUT, RCV)};
const named::Transition nb_receive_ack[] = {RECEIVER, B2(B_RECEIVE_ACK, RCV), B2(RECEIVE_SKIP, RCV)};

constexpr named::Place parallel_places[] = {{"in"},
                                            {"out"},
                                            BEHAVIOUR_PLACES("run"),
                                            SEND_PLACES("run", "x"),
                                            WAIT_PLACE("run", "x"),
                                            {"run.snd.x.in"},
                                            {"run.snd.x.out"},
                                            SEND_PLACES("run", "y"),
                                            WAIT_PLACE("run", "y"),
                                            {"run.snd.y.in"},
                                            {"run.snd.y.out"}};
const named::Transition parallel_send[] = {
    SENDER,
    {"run.snd.fork", {"run.snd.in"}, {"run.snd.x.in", "run.snd.y.in"}},
    B_SEND("run", "x", "run.snd.x.in", "run.snd.x.out"),
    B_SEND("run", "y", "run.snd.y.in", "run.snd.y.out"),
    {"run.snd.join", {"run.snd.x.out", "run.snd.y.out"}, {"run.snd.out"}}};

constexpr Port relay_ports[] = {{"in", Side::receive, "x"}, {"out", Side::send, "x"}};
constexpr named::Place relay_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("run"), SEND_PLACES("run", "out"), RECEIVE_PLACES("run", "in")};
const named::Transition relay_transitions[] = {ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NEXT_END("run", 0),
                                               ASYNC_SEND("run", "out", "run.snd.in", "run.snd.out"),
                                               ASYNC_RECEIVE("run", "in", "run.rcv.in", "run.rcv.out")};

constexpr Behaviour watch_only[] = {{"watch"}}, drive_only[] = {{"drive"}},
                    init_follow[] = {{"init"}, {"follow"}};
constexpr Port line_out[] = {{"line", Side::send, "x"}}, velocity_in[] = {{"velocity", Side::receive, "x"}};
constexpr Port control_ports[] = {{"line", Side::receive, "x"}, {"motion", Side::send, "x"}};
constexpr named::Place paper_sensor_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("watch"), SEND_PLACES("watch", "line")};
constexpr named::Place paper_motor_places[] = {
    {"in"}, {"out"}, BEHAVIOUR_PLACES("drive"), RECEIVE_PLACES("drive", "velocity")};
constexpr named::Place paper_control_places[] = {{"in"},
                                                 {"out"},
                                                 BEHAVIOUR_PLACES("init"),
                                                 SEND_PLACES("init", "motion"),
                                                 RECEIVE_PLACES("init", "line"),
                                                 BEHAVIOUR_PLACES("follow"),
                                                 SEND_PLACES("follow", "motion"),
                                                 RECEIVE_PLACES("follow", "line")};
const named::Transition paper_sensor_transitions[] = {
    ENTER("watch"), BEHAVIOUR_TRANSITIONS("watch"), NO_RECEIVE("watch"), NEXT_END("watch", 0),
    ASYNC_SEND("watch", "line", "watch.snd.in", "watch.snd.out")};
const named::Transition paper_motor_transitions[] = {
    ENTER("drive"),
    BEHAVIOUR_TRANSITIONS("drive"),
    NO_SEND("drive"),
    NEXT_END("drive", 0),
    B_RECEIVE("drive", "velocity", "drive.rcv.in", "drive.rcv.out"),
    RECEIVE_TIMEOUT("drive", "velocity", "drive.rcv.in", "drive.rcv.out")};
const named::Transition paper_control_transitions[] = {
    ENTER("init"),
    BEHAVIOUR_TRANSITIONS("init"),
    NEXT("init", 0, "follow"),
    ASYNC_RECEIVE("init", "line", "init.rcv.in", "init.rcv.out"),
    NB_SEND("init", "motion", "init.snd.in", "init.snd.out"),
    BEHAVIOUR_TRANSITIONS("follow"),
    NEXT_END("follow", 0),
    ASYNC_RECEIVE("follow", "line", "follow.rcv.in", "follow.rcv.out"),
    NB_SEND("follow", "motion", "follow.snd.in", "follow.snd.out")};

// Two items in store: the lock and a free slot are taken together, or the lock and an item.
constexpr FusedPlace store[] = {{"lock", 1}, {"free1", 1}, {"free2", 1}, {"item1", 0}, {"item2", 0}};
constexpr named::Place store_send_places[] = {{"in"},
                                              {"out"},
                                              BEHAVIOUR_PLACES("run"),
                                              {"run.put1", named::writes("x")},
                                              {"run.put2", named::writes("x")}};
const named::Transition store_send[] = {SENDER,
                                        {"run.take1", {"run.snd.in", "x/lock", "x/free1"}, {"run.put1"}},
                                        {"run.take2", {"run.snd.in", "x/lock", "x/free2"}, {"run.put2"}},
                                        {"run.give1", {"run.put1"}, {"run.snd.out", "x/lock", "x/item1"}},
                                        {"run.give2", {"run.put2"}, {"run.snd.out", "x/lock", "x/item2"}}};
constexpr named::Place store_receive_places[] = {{"in"},
                                                 {"out"},
                                                 BEHAVIOUR_PLACES("run"),
                                                 {"run.get1", named::reads("x")},
                                                 {"run.get2", named::reads("x")}};
const named::Transition store_receive[] = {RECEIVER,
                                           {"run.take1", {"run.rcv.in", "x/lock", "x/item1"}, {"run.get1"}},
                                           {"run.take2", {"run.rcv.in", "x/lock", "x/item2"}, {"run.get2"}},
                                           {"run.free1", {"run.get1"}, {"run.rcv.out", "x/lock", "x/free1"}},
                                           {"run.free2", {"run.get2"}, {"run.rcv.out", "x/lock", "x/free2"}}};

constexpr FusedPlace queue_places[] = {{"empty_1", 1}, {"full_1", 0}, {"empty_2", 1}, {"full_2", 0},
                                       {"put_1", 1},   {"put_2", 0},  {"get_1", 1},   {"get_2", 0}};
constexpr named::Place queue_send_places[] = {{"in"},
                                              {"out"},
                                              BEHAVIOUR_PLACES("run"),
                                              {"run.snd.x.first", named::writes("x", 1)},
                                              {"run.snd.x.second", named::writes("x", 2)}};
const named::Transition queue_send[] = {
    SENDER,
    {"run.snd.x.begin_1", {"run.snd.in", "x/put_1", "x/empty_1"}, {"run.snd.x.first"}},
    {"run.snd.x.end_1", {"run.snd.x.first"}, {"run.snd.out", "x/full_1", "x/put_2"}},
    {"run.snd.x.begin_2", {"run.snd.in", "x/put_2", "x/empty_2"}, {"run.snd.x.second"}},
    {"run.snd.x.end_2", {"run.snd.x.second"}, {"run.snd.out", "x/full_2", "x/put_1"}}};
constexpr named::Place queue_receive_places[] = {{"in"},
                                                 {"out"},
                                                 BEHAVIOUR_PLACES("run"),
                                                 {"run.rcv.x.first", named::reads("x", 1)},
                                                 {"run.rcv.x.second", named::reads("x", 2)}};
const named::Transition queue_receive[] = {
    RECEIVER,
    {"run.rcv.x.begin_1", {"run.rcv.in", "x/get_1", "x/full_1"}, {"run.rcv.x.first"}},
    {"run.rcv.x.end_1", {"run.rcv.x.first"}, {"run.rcv.out", "x/empty_1", "x/get_2"}},
    {"run.rcv.x.begin_2", {"run.rcv.in", "x/get_2", "x/full_2"}, {"run.rcv.x.second"}},
    {"run.rcv.x.end_2", {"run.rcv.x.second"}, {"run.rcv.out", "x/empty_2", "x/get_1"}}};
constexpr named::Place first_receiver_places[] = {
    {"in"}, {"out"}, FIRST_PLACES("run"), RECEIVE_PLACES("run", "x")};
#define FIRST_RECEIVER ENTER("run"), FIRST_TRANSITIONS("run"), NO_SEND("run"), NEXT_END("run", 0)
const named::Transition first_async_receive[] = {FIRST_RECEIVER, B2(ASYNC_RECEIVE, RCV)};
const named::Transition first_b_receive[] = {FIRST_RECEIVER, B2(B_RECEIVE, RCV)};
const named::Transition first_b_receive_timed[] = {FIRST_RECEIVER, B2(B_RECEIVE, RCV),
                                                   B2(RECEIVE_TIMEOUT, RCV)};
constexpr named::Place first_relay_places[] = {
    {"in"}, {"out"}, FIRST_PLACES("run"), SEND_PLACES("run", "out"), RECEIVE_PLACES("run", "in")};
const named::Transition first_relay_transitions[] = {ENTER("run"), FIRST_TRANSITIONS("run"),
                                                     NEXT("run", 0, "run"),
                                                     ASYNC_SEND("run", "out", "run.snd.in", "run.snd.out"),
                                                     ASYNC_RECEIVE("run", "in", "run.rcv.in", "run.rcv.out")};
constexpr named::Place first_two_places[] = {{"in"}, {"out"}, FIRST_PLACES("first"), FIRST_PLACES("second")};
const named::Transition first_two_transitions[] = {
    ENTER("first"),       FIRST_TRANSITIONS("first"),  NO_SEND("first"),
    NO_RECEIVE("first"),  FIRST_TRANSITIONS("second"), NO_SEND("second"),
    NO_RECEIVE("second"), NEXT("first", 0, "second"),  NEXT("second", 0, "first")};
const named::Transition impatient_receive[] = {
    RECEIVER,
    B_RECEIVE("run", "x", "run.rcv.in", "run.rcv.out"),
    {"run.rcv.x.give_up", {"run.rcv.in"}, {"run.rcv.out"}, named::if_elapsed_at("x")}};

}  // namespace

const SubsystemNet alone = numbered(run_only, {}, alone_places, alone_transitions);
const SubsystemNet two_behaviours = numbered(first_second, {}, two_places, two_transitions);
const SubsystemNet async_sender = numbered(run_only, sends_x, sender_places, async_send);
const SubsystemNet async_receiver = numbered(run_only, receives_x, receiver_places, async_receive);
const SubsystemNet nb_sender = numbered(run_only, sends_x, sender_places, nb_send);
const SubsystemNet nb_sender_persistent = numbered(run_only, sends_x, sender_places, nb_send_persistent);
const SubsystemNet b_sender = numbered(run_only, sends_x, waiting_sender_places, b_send);
const SubsystemNet b_sender_timed = numbered(run_only, sends_x, waiting_sender_places, b_send_timed);
const SubsystemNet b_sender_skipping = numbered(run_only, sends_x, skipping_places, skipping_send);
const SubsystemNet b_receiver = numbered(run_only, receives_x, receiver_places, b_receive);
const SubsystemNet b_receiver_timed = numbered(run_only, receives_x, receiver_places, b_receive_timed);
const SubsystemNet once_receiver = numbered(run_only, receives_x, receiver_places, once_receive);
const SubsystemNet nb_receiver = numbered(run_only, receives_x, receiver_places, nb_receive);
const SubsystemNet b_receiver_ack = numbered(run_only, receives_x, receiver_places, b_receive_ack);
const SubsystemNet b_receiver_ack_timed =
    numbered(run_only, receives_x, receiver_places, b_receive_ack_timed);
const SubsystemNet nb_receiver_ack = numbered(run_only, receives_x, receiver_places, nb_receive_ack);
const SubsystemNet parallel_sender = numbered(run_only, sends_x_y, parallel_places, parallel_send);
const SubsystemNet async_relay = numbered(run_only, relay_ports, relay_places, relay_transitions);
const SubsystemNet paper_sensor =
    numbered(watch_only, line_out, paper_sensor_places, paper_sensor_transitions);
const SubsystemNet paper_control =
    numbered(init_follow, control_ports, paper_control_places, paper_control_transitions);
const SubsystemNet paper_motor =
    numbered(drive_only, velocity_in, paper_motor_places, paper_motor_transitions);
const SubsystemNet store_sender = numbered(run_only, sends_x, store_send_places, store_send, store);
const SubsystemNet store_receiver =
    numbered(run_only, receives_x, store_receive_places, store_receive, store);
const std::span<const FusedPlace> two_slots{store};
const SubsystemNet queue_sender = numbered(run_only, sends_x, queue_send_places, queue_send, queue_places);
const SubsystemNet queue_receiver =
    numbered(run_only, receives_x, queue_receive_places, queue_receive, queue_places);
const std::span<const FusedPlace> queue{queue_places};
const SubsystemNet first_async_receiver =
    numbered(run_only, receives_x, first_receiver_places, first_async_receive);
const SubsystemNet first_b_receiver = numbered(run_only, receives_x, first_receiver_places, first_b_receive);
const SubsystemNet first_b_receiver_timed =
    numbered(run_only, receives_x, first_receiver_places, first_b_receive_timed);
const SubsystemNet first_relay = numbered(run_only, relay_ports, first_relay_places, first_relay_transitions);
const SubsystemNet first_two_behaviours = numbered(first_second, {}, first_two_places, first_two_transitions);
const SubsystemNet impatient_receiver = numbered(run_only, receives_x, receiver_places, impatient_receive);

}  // namespace tessera::testing::nets
