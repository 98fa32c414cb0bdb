#pragma once

#include "named_net.hpp"

/// The patterns of behaviours and communication blocks as rows of tables, for nets written by hand. `b` is
/// the name of a behaviour, `p` that of a port, `in`/`out` the places that the block joins. All of them are
/// string literals.
// clang-format off

#define BEHAVIOUR_PLACES(b)                                                                       \
  {b ".in", named::calls(b)}, {b ".snd.in"}, {b ".snd.out"}, {b ".2", named::counts()},           \
  {b ".rcv.in"}, {b ".rcv.out", named::decides(b)}, {b ".out", named::routes(b)}
#define BEHAVIOUR_TRANSITIONS(b)                                                                  \
  {b ".t1", {b ".in"}, {b ".snd.in"}}, {b ".t2", {b ".snd.out"}, {b ".2"}},                       \
  {b ".t3", {b ".2"}, {b ".rcv.in"}}, {b ".t4", {b ".rcv.out"}, {b ".in"}, if_go_on},             \
  {b ".t5", {b ".rcv.out"}, {b ".out"}, if_terminal}, {b ".t6", {b ".rcv.out"}, {b ".out"}, if_error}

// The same of a subsystem that receives first.
#define FIRST_PLACES(b)                                                                           \
  {b ".in", named::begins(b)}, {b ".rcv.in"}, {b ".rcv.out"}, {b ".2", named::calls(b)},          \
  {b ".snd.in"}, {b ".snd.out", named::decides(b)}, {b ".out", named::routes(b)}
#define FIRST_TRANSITIONS(b)                                                                      \
  {b ".t1", {b ".in"}, {b ".rcv.in"}}, {b ".t2", {b ".rcv.out"}, {b ".2"}},                       \
  {b ".t3", {b ".2"}, {b ".snd.in"}}, {b ".t4", {b ".snd.out"}, {b ".in"}, if_go_on},             \
  {b ".t5", {b ".snd.out"}, {b ".out"}, if_terminal}, {b ".t6", {b ".snd.out"}, {b ".out"}, if_error}

#define NO_SEND(b) {b ".snd.t1", {b ".snd.in"}, {b ".snd.out"}}
#define NO_RECEIVE(b) {b ".rcv.t1", {b ".rcv.in"}, {b ".rcv.out"}}

// A block between places i and o; its own places come from the *_PLACES rows.
#define SEND_PLACES(b, p) {b ".snd." p ".2", named::writes(p)}
#define WAIT_PLACE(b, p) {b ".snd." p ".wait"}
#define RECEIVE_PLACES(b, p) {b ".rcv." p ".2", named::reads(p)}

#define ASYNC_SEND(b, p, i, o)                                              \
  {b ".snd." p ".t1", {i, p "/channel"}, {b ".snd." p ".2"}},               \
  {b ".snd." p ".t2", {b ".snd." p ".2"}, {o, p "/channel"}}
#define ASYNC_RECEIVE(b, p, i, o)                                           \
  {b ".rcv." p ".t1", {i, p "/channel"}, {b ".rcv." p ".2"}},               \
  {b ".rcv." p ".t2", {b ".rcv." p ".2"}, {o, p "/channel"}}

#define NB_SEND(b, p, i, o)                                                 \
  {b ".snd." p ".t1", {i, p "/empty"}, {b ".snd." p ".2"}},                 \
  {b ".snd." p ".t1o", {i, p "/full"}, {b ".snd." p ".2"}},                 \
  {b ".snd." p ".t2", {b ".snd." p ".2"}, {o, p "/full"}}
#define B_SEND(b, p, i, o)                                                  \
  {b ".snd." p ".t1", {i, p "/empty"}, {b ".snd." p ".2"}},                 \
  {b ".snd." p ".t2", {b ".snd." p ".2"}, {b ".snd." p ".wait", p "/full"}}, \
  {b ".snd." p ".t3", {b ".snd." p ".wait", p "/ack"}, {o}}
#define B_SEND_TIMEOUT(b, p, i, o)                                          \
  {b ".snd." p ".timeout", {b ".snd." p ".wait", p "/full"}, {o, p "/empty"}, if_elapsed}

#define B_RECEIVE(b, p, i, o)                                               \
  {b ".rcv." p ".t1", {i, p "/full"}, {b ".rcv." p ".2"}},                  \
  {b ".rcv." p ".t2", {b ".rcv." p ".2"}, {o, p "/empty"}}
#define B_RECEIVE_ACK(b, p, i, o)                                           \
  {b ".rcv." p ".t1", {i, p "/full"}, {b ".rcv." p ".2"}},                  \
  {b ".rcv." p ".t2", {b ".rcv." p ".2"}, {o, p "/empty", p "/ack"}}
#define RECEIVE_SKIP(b, p, i, o) {b ".rcv." p ".skip", {i, p "/empty"}, {o, p "/empty"}}
#define RECEIVE_TIMEOUT(b, p, i, o) {b ".rcv." p ".timeout", {i, p "/empty"}, {o, p "/empty"}, if_elapsed}

#define ENTER(b) {"t_in", {"in"}, {b ".in"}}
#define NEXT(b, k, to) {"t_" b "_" #k, {b ".out"}, {to ".in"}, if_next(k)}
#define NEXT_END(b, k) {"t_" b "_" #k, {b ".out"}, {"out"}, if_next(k)}
// clang-format on
