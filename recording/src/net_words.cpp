#include "tessera/net_words.hpp"

/// A prefix of every word. Only a test sets one.
#ifndef TESSERA_WORD_PREFIX
#define TESSERA_WORD_PREFIX ""
#endif

namespace tessera::words {

// Words of every page.
const std::string_view input = TESSERA_WORD_PREFIX "in";
const std::string_view output = TESSERA_WORD_PREFIX "out";
const std::string_view start = TESSERA_WORD_PREFIX "t_in";
const std::string_view end = TESSERA_WORD_PREFIX "t_out";
const std::string_view leave = TESSERA_WORD_PREFIX "t_";

// Words of a behaviour.
const std::string_view send_page = TESSERA_WORD_PREFIX "snd";
const std::string_view receive_page = TESSERA_WORD_PREFIX "rcv";
const std::string_view step = TESSERA_WORD_PREFIX "2";
const std::string_view first_step = TESSERA_WORD_PREFIX "t1";
const std::string_view second_step = TESSERA_WORD_PREFIX "t2";
const std::string_view third_step = TESSERA_WORD_PREFIX "t3";
const std::string_view go_on = TESSERA_WORD_PREFIX "t4";
const std::string_view terminal = TESSERA_WORD_PREFIX "t5";
const std::string_view error = TESSERA_WORD_PREFIX "t6";

// Words of a block of a communication page.
const std::string_view transfer = TESSERA_WORD_PREFIX "2";
const std::string_view waiting = TESSERA_WORD_PREFIX "wait";
const std::string_view begin_transfer = TESSERA_WORD_PREFIX "t1";
const std::string_view overwrite = TESSERA_WORD_PREFIX "t1o";
const std::string_view end_transfer = TESSERA_WORD_PREFIX "t2";
const std::string_view take_acknowledgement = TESSERA_WORD_PREFIX "t3";
const std::string_view timeout = TESSERA_WORD_PREFIX "timeout";
const std::string_view skip = TESSERA_WORD_PREFIX "skip";
const std::string_view fork = TESSERA_WORD_PREFIX "fork";
const std::string_view join = TESSERA_WORD_PREFIX "join";
const std::string_view pass = TESSERA_WORD_PREFIX "t1";

// Words of the memory of a channel.
const std::string_view lock = TESSERA_WORD_PREFIX "channel";
const std::string_view empty = TESSERA_WORD_PREFIX "empty";
const std::string_view full = TESSERA_WORD_PREFIX "full";
const std::string_view acknowledged = TESSERA_WORD_PREFIX "ack";

// Words of the memory of a channel between processes, and of the transitions that move its values.
const std::string_view idle = TESSERA_WORD_PREFIX "idle";
const std::string_view sent = TESSERA_WORD_PREFIX "sent";
const std::string_view more = TESSERA_WORD_PREFIX "more";
const std::string_view sent_memory = TESSERA_WORD_PREFIX "sent_memory";
const std::string_view received_memory = TESSERA_WORD_PREFIX "received_memory";
const std::string_view end_transfer_second = TESSERA_WORD_PREFIX "t2n";
const std::string_view end_transfer_more = TESSERA_WORD_PREFIX "t2m";
const std::string_view withdraw = TESSERA_WORD_PREFIX "withdraw";
const std::string_view withdraw_newest = TESSERA_WORD_PREFIX "withdraw_m";
const std::string_view recall = TESSERA_WORD_PREFIX "recall";
const std::string_view deliver = TESSERA_WORD_PREFIX "deliver";
const std::string_view replace = TESSERA_WORD_PREFIX "replace";
const std::string_view deliver_older = TESSERA_WORD_PREFIX "older";
const std::string_view lose_older = TESSERA_WORD_PREFIX "lost";

const std::string_view no_successor = TESSERA_WORD_PREFIX " none";

const std::string_view link = TESSERA_WORD_PREFIX ".link";
const std::string_view link_back = TESSERA_WORD_PREFIX ".link_back";
const std::string_view cut = TESSERA_WORD_PREFIX ".cut";
const std::string_view cut_back = TESSERA_WORD_PREFIX ".cut_back";

}  // namespace tessera::words
