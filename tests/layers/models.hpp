#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "spec/model/model.hpp"

/// Models built by hand, so that the layers are tested without the parser.
namespace tessera::test {

inline constexpr auto N = spec::Mode::non_blocking, B = spec::Mode::blocking;

spec::Behaviour behaviour(std::string name);
/// A behaviour with one unconditional successor, `none` for `end`.
spec::Behaviour behaviour(std::string name, spec::BehaviourId next);

spec::Subsystem subsystem(spec::SubsystemKind kind, std::string name, const std::vector<std::string>& inputs,
                          const std::vector<std::string>& outputs, std::vector<spec::Behaviour> behaviours);

/// A model of agents "a0", "a1", ... (or with the given path), each made of its own definition.
class ModelBuilder {
 public:
  /// Returns the instance of the agent's first subsystem.
  spec::InstanceId agent(std::string path, std::vector<spec::Subsystem> subsystems);
  /// Another agent of the same definition as the last one.
  spec::InstanceId again(std::string path);
  spec::Channel& channel(spec::ChannelEnd from, spec::ChannelEnd to);
  [[nodiscard]] spec::Model result() const { return model_; }

 private:
  spec::InstanceId enlist(std::string path);
  spec::Model model_;
};

/// The paper's example, as in docs/reference/specification.md.
spec::Model line_follower();
/// `count` line followers of one template.
spec::Model fleet(std::uint32_t count);

struct Modes {
  spec::Mode send = spec::Mode::non_blocking, receive = spec::Mode::non_blocking;
  bool send_timeout = false, receive_timeout = false;
};
/// A control subsystem and an effector, one behaviour each, and a channel y1 -> x1,
/// y2 -> x2, ... per element.
spec::Model pair(const std::vector<Modes>& channels, spec::Transfer transfer = spec::Transfer::sequential);

/// A valid model: up to three agents with up to three subsystems, behaviours, buffers
/// and channels of all modes.
spec::Model random_model(std::uint32_t seed);

struct Built {
  net::HierarchicalNet pages;
  net::Net net;
};
/// Layers and flattening; throws std::runtime_error with the diagnostics if the model is refused.
Built build(const spec::Model& model);

/// The transitions of a page as "t1: in + y1.empty -> y1.2", in order; conditions are appended in brackets.
std::vector<std::string> transitions_of(const net::HierarchicalNet& net, const std::string& path);
/// The nodes of a page that are neither pages nor fused, in order.
std::vector<std::string> places_of(const net::HierarchicalNet& net, const std::string& path);

}  // namespace tessera::test
