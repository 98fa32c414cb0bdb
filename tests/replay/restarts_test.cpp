#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "deployed_run.hpp"
#include "layers/models.hpp"
#include "net/token_game.hpp"
#include "network/receiver.hpp"
#include "network/sender.hpp"
#include "replay/legality.hpp"

/// Recordings of processes that restart, made by the real protocol over a bad network.
namespace tessera::replay {
namespace {

using net::TransitionId;
using network::Data;
using network::Incarnation;
using network::State;
using test::B;
using test::N;
using RestartVerdict = Legality::Verdict;

struct Ends {
  spec::Mode send, receive;
  bool send_timeout, receive_timeout;
};
const std::vector<Ends> all_ends{{N, N, false, false}, {N, B, false, false}, {N, B, false, true},
                                 {B, N, false, false}, {B, B, false, false}, {B, B, true, true},
                                 {B, N, true, false},  {B, B, true, false}};

Deployed two_agents(Ends ends) {
  test::ModelBuilder builder;
  const spec::InstanceId a = builder.agent(
      "a", {test::subsystem(spec::SubsystemKind::control, "s", {}, {"y"}, {test::behaviour("give", {0})})});
  const spec::InstanceId b = builder.agent(
      "b", {test::subsystem(spec::SubsystemKind::control, "r", {"x"}, {}, {test::behaviour("take", {0})})});
  spec::Channel& channel = builder.channel({a, {0}}, {b, {0}});
  channel.send = ends.send;
  channel.receive = ends.receive;
  if (ends.send_timeout) channel.send_timeout = std::chrono::milliseconds(10);
  if (ends.receive_timeout) channel.receive_timeout = std::chrono::milliseconds(10);
  return each_apart(builder.result());
}

/// The two processes, their users and the network between them.
template <class Receiver>
class TwoProcesses {
 public:
  TwoProcesses(const Deployed& system, Ends ends, std::mt19937& random)
      : system_(system), random_(random), deployed_(system.net, system.processes), ends_(ends) {
    start(0);
    start(1);
  }

  std::vector<Recording> run(std::size_t steps, std::size_t restarts) {
    for (std::size_t step = 0; step < steps; ++step) {
      now_ns_ += 1000;
      const auto choice = random_() % 100;
      if (choice < 2 && restarts > 0) {
        --restarts;
        start(random_() % 2);
      } else if (choice < 60) {
        use(random_() % 2);
      } else if (choice < 90) {
        deliver();
      } else {
        repeat();
      }
    }
    for (Process& process : processes_) done_.push_back(std::move(process.recording));
    return std::move(done_);
  }

 private:
  struct Process {
    net::Marking marking;
    Recording recording;
    std::map<std::uint32_t, std::uint32_t> sequences;
    std::uint64_t told = 0;  ///< the peer
  };

  /// It begins again, with a greater incarnation.
  void start(std::size_t which) {
    Process& process = processes_[which];
    if (!process.marking.empty()) done_.push_back(std::move(process.recording));
    later_.reset();
    process = {};
    process.marking = net::initial_marking(system_.net);
    net::fire(system_.net, deployed_.start(), process.marking);
    const std::uint64_t incarnation = ++incarnations_;
    Recording& recording = process.recording;
    recording.clock = "steady";
    recording.processes = system_.processes.names;
    recording.process =
        Recording::OneProcess{system_.processes.names[which], static_cast<std::uint32_t>(which), incarnation};
    for (const net::Parts::Subsystem& subsystem : system_.net.parts().subsystems)
      recording.instances.push_back(subsystem.path);
    for (const net::Transition& transition : system_.net.transitions())
      recording.transitions.push_back(
          {transition.name, transition.subsystem.valid() ? transition.subsystem.value : system_instance});
    const bool exchange = ends_.send == N && ends_.receive == N;
    if (which == 0) {
      sender_.emplace(exchange          ? network::Sending::exchange
                      : ends_.send == B ? network::Sending::blocking
                                        : network::Sending::non_blocking,
                      Incarnation{incarnation});
      taken_by_ = {};
    } else {
      receiver_.emplace(exchange ? network::Receiving::exchange : network::Receiving::once,
                        Incarnation{incarnation});
    }
  }

  /// One firing of one process, if it can do anything.
  void use(std::size_t which) {
    Process& process = processes_[which];
    std::vector<TransitionId> possible;
    for (std::uint32_t index = 0; index < system_.net.transitions().size(); ++index)
      if (const TransitionId id{index}; deployed_[id].process.value == which && can(process, id))
        possible.push_back(id);
    if (possible.empty()) return;
    const TransitionId id = possible[random_() % possible.size()];
    fire(process, id, number_of(process, id));
  }

  [[nodiscard]] bool can(const Process& process, TransitionId id) const {
    if (system_.net[id].condition.truth == net::Condition::Truth::never) return false;
    for (const net::Arc& arc : system_.net.preset(id))
      if (!deployed_.is_hidden(arc.place) && !net::suffices(process.marking, arc)) return false;
    const bool exchange = ends_.send == N && ends_.receive == N;
    switch (deployed_[id].effect) {
      case ChannelEffect::is_acknowledged:
        return !sender_->waiting();
      case ChannelEffect::gives_up:
        return sender_->waiting();
      case ChannelEffect::begins_read:
        return exchange || receiver_->full();
      case ChannelEffect::skips:
        return !receiver_->full();
      default:
        return true;
    }
  }

  /// Does what the firing means. Returns the number that is recorded with it.
  std::uint32_t number_of(Process& process, TransitionId id) {
    std::uint64_t number = 0;
    switch (deployed_[id].effect) {
      case ChannelEffect::none:
      case ChannelEffect::skips:
        break;
      case ChannelEffect::begins_write:
        number = sender_->number().value + 1;
        break;
      case ChannelEffect::writes:
        send(sender_->write().send);
        number = sender_->number().value;
        break;
      case ChannelEffect::is_acknowledged:
        number = sender_->number().value;
        tell(process, taken_by_);
        break;
      case ChannelEffect::gives_up:
        number = sender_->number().value;
        send(sender_->time_is_up().send);
        break;
      case ChannelEffect::begins_read:
        receiver_->begin_read();
        number = receiver_->slot().value;
        read_ = number;
        if (number > 0) tell(process, receiver_->peer());
        break;
      case ChannelEffect::ends_read:
        number = read_;
        send(receiver_->end_read().answer);
        hear_waiting();
        break;
    }
    return deployed_[id].carries_number ? static_cast<std::uint32_t>(number) : 0;
  }

  void tell(Process& process, Incarnation peer) {
    if (process.told == peer.value) return;
    process.told = peer.value;
    const std::string text = system_.net.parts().channels[0] + "\n" + std::to_string(peer.value);
    add(process, Event::Kind::peer, 0, static_cast<std::uint32_t>(text.size()), 0, text);
  }

  void fire(Process& process, TransitionId id, std::uint32_t number) {
    const net::Transition& transition = system_.net[id];
    for (const net::Arc& arc : system_.net.preset(id))
      if (!deployed_.is_hidden(arc.place)) --process.marking[arc.place.value];
    for (const net::Arc& arc : system_.net.postset(id))
      if (!deployed_.is_hidden(arc.place)) ++process.marking[arc.place.value];
    add(process, Event::Kind::firing,
        transition.subsystem.valid() ? transition.subsystem.value : system_instance, id.value, number, {});
  }

  void add(Process& process, Event::Kind kind, std::uint32_t instance, std::uint32_t subject,
           std::uint32_t version, std::string text) {
    if (kind == Event::Kind::peer) instance = static_cast<std::uint32_t>(&process - processes_.data());
    Event event{.time_ns = now_ns_, .subject = subject, .version = version};
    event.sequence = process.sequences[instance]++;
    event.origin = instance << 8 | static_cast<std::uint32_t>(kind);
    process.recording.entries.push_back({event, std::move(text)});
  }

  void send(const std::optional<Data>& data) {
    if (data) data_.push_back(*data);
  }
  void send(const std::optional<State>& state) {
    if (state) states_.push_back(*state);
  }
  void deliver() { random_() % 2 == 0 ? deliver_data() : deliver_state(); }
  /// Any that was ever sent may come, and come again.
  void deliver_data() {
    if (data_.empty()) return;
    const std::size_t newest = data_.size() - 1;
    hear(data_[random_() % 3 == 0 ? random_() % data_.size() : newest]);
  }
  void hear(const Data& data) {
    const auto effects = receiver_->hear(data);
    if (effects.later) later_ = data;
    send(effects.answer);
  }
  void hear_waiting() {
    if (later_) hear(*std::exchange(later_, std::nullopt));
  }
  void deliver_state() {
    if (states_.empty()) return;
    const State state = states_[random_() % 3 == 0 ? random_() % states_.size() : states_.size() - 1];
    const auto effects = sender_->hear(state);
    if (effects.taken) taken_by_ = state.from;
    send(effects.send);
  }
  void repeat() {
    send(sender_->repeat().send);
    send(receiver_->repeat().answer);
  }

  const Deployed& system_;
  std::mt19937& random_;
  DeployedNet deployed_;
  Ends ends_;
  std::array<Process, 2> processes_;
  std::optional<network::Sender> sender_;
  std::optional<Receiver> receiver_;
  std::vector<Data> data_;
  std::vector<State> states_;
  std::optional<Data> later_;
  Incarnation taken_by_;
  std::uint64_t read_ = 0, incarnations_ = 0;
  std::int64_t now_ns_ = 0;
  std::vector<Recording> done_;
};

template <class Receiver>
std::vector<Recording> run_of(const Deployed& system, Ends ends, std::size_t restarts, std::mt19937& random) {
  return TwoProcesses<Receiver>(system, ends, random).run(600, restarts);
}

TEST(Restarts, WhatTheProtocolDoesIsLegalWithAndWithoutRestarts) {
  std::mt19937 random(5);
  for (const Ends ends : all_ends) {
    const Deployed system = two_agents(ends);
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
      const std::vector<Recording> run = run_of<network::Receiver>(system, ends, seed % 4, random);
      const Legality judged = check_legal(run, system.net, system.processes);
      EXPECT_EQ(judged.verdict, RestartVerdict::legal) << seed << ": " << judged.why;
    }
  }
}

TEST(Restarts, WhatKilledProcessesLeaveIsNeverIllegal) {
  std::mt19937 random(7);
  for (const Ends ends : all_ends) {
    const Deployed system = two_agents(ends);
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      std::vector<Recording> run = run_of<network::Receiver>(system, ends, 2, random);
      Recording& cut = run[random() % run.size()];
      cut.entries.resize(cut.entries.size() - random() % (cut.entries.size() + 1));
      cut.truncated = true;
      const Legality judged = check_legal(run, system.net, system.processes);
      EXPECT_EQ(judged.verdict, RestartVerdict::incomplete) << seed << ": " << judged.why;
      // A recording that is not given is no fault of the others.
      run.erase(run.begin() + static_cast<std::ptrdiff_t>(random() % run.size()));
      EXPECT_NE(check_legal(run, system.net, system.processes).verdict, RestartVerdict::illegal);
    }
  }
}

struct AcknowledgesArrival : network::ReceiverRules {
  static bool acknowledges_arrival() { return true; }
};
struct ReadsTwice : network::ReceiverRules {
  static bool was_taken(network::Number, network::Number) { return false; }
};
struct ReadsForOthers : network::ReceiverRules {
  static bool is_for(const Data&, Incarnation) { return true; }
};
struct TurnsBack : network::ReceiverRules {
  static bool is_newer(Incarnation from, Incarnation peer) { return from != peer; }
};

/// How many of some runs of a protocol with that fault are found to be illegal.
template <class Rules>
std::size_t found(std::size_t restarts) {
  std::mt19937 random(11);
  std::size_t illegal = 0;
  for (const Ends ends : all_ends) {
    const Deployed system = two_agents(ends);
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const std::vector<Recording> run =
          run_of<network::BasicReceiver<Rules>>(system, ends, restarts, random);
      illegal += check_legal(run, system.net, system.processes).verdict == RestartVerdict::illegal ? 1 : 0;
    }
  }
  return illegal;
}

TEST(Restarts, AProtocolWithAFaultLeavesRecordingsThatAreIllegal) {
  EXPECT_GT(found<AcknowledgesArrival>(0), 5U);
  EXPECT_GT(found<ReadsTwice>(0), 20U);
  EXPECT_GT(found<ReadsForOthers>(3), 0U) << "an acknowledged value is read again after a restart";
  EXPECT_GT(found<TurnsBack>(3), 5U) << "reads go back to the sender before its restart";
}

}  // namespace
}  // namespace tessera::replay
