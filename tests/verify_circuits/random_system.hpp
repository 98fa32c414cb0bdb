#pragma once

#include <cstdint>

#include "spec/model/model.hpp"

namespace tessera::test {

/// A small system: two to four subsystems and up to six channels of all modes, with and without timeouts.
/// Most subsystems repeat one sequence of communications, in one behaviour or in several; some have a
/// start-up, some may end, some transfer in parallel, some receive first, and a few have behaviours that do
/// not fold. The same seed gives the same system.
[[nodiscard]] spec::Model random_system(std::uint64_t seed);
/// The same, but most subsystems have behaviours that use different channels.
[[nodiscard]] spec::Model random_differing_system(std::uint64_t seed);
/// The same as random_system, but half of the channels are of a communication model of the author's.
[[nodiscard]] spec::Model random_system_of_own_models(std::uint64_t seed);

/// For systems built by hand.
class SystemBuilder {
 public:
  struct Ends {
    bool send_blocks = false, receive_blocks = false, send_timeout = false, receive_timeout = false;
  };

  /// Subsystems come each in an agent of its own, or with the one before. Returns the instance.
  spec::InstanceId subsystem(bool own_agent = true);
  /// Returns the channel.
  spec::ChannelId channel(spec::InstanceId from, spec::InstanceId to, Ends ends);
  /// Models that channels may be of.
  void add_models(const std::vector<spec::CommunicationModel>& models);
  void be_of_model(spec::ChannelId channel, spec::CommunicationModelId model);
  /// A behaviour that sends and receives on the given channels, in this order. Returns it.
  spec::BehaviourId behaviour(spec::InstanceId instance, const std::vector<spec::ChannelId>& sends,
                              const std::vector<spec::ChannelId>& receives,
                              spec::Transfer transfer = spec::Transfer::sequential);
  /// How a behaviour ends: always after one round, or whenever it likes; and what may follow (none: `end`).
  void leave(spec::InstanceId instance, spec::BehaviourId behaviour, bool always,
             const std::vector<spec::BehaviourId>& next);
  void may_fail(spec::InstanceId instance, spec::BehaviourId behaviour);
  /// Its iterations receive before they calculate and send.
  void receive_first(spec::InstanceId instance);

  [[nodiscard]] spec::Model result() const { return model_; }

 private:
  spec::Subsystem& at(spec::InstanceId instance);
  spec::Model model_;
};

}  // namespace tessera::test
