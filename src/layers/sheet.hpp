#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "layers/known_facts.hpp"
#include "layers/wiring.hpp"
#include "net/net.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// The net that the functions of the five layers draw together.
struct Draft {
  explicit Draft(const spec::Model& specification);

  const spec::Model& model;
  Wiring wiring;
  net::HierarchicalNet net;
  /// The fusion sets of the shared places of its model. None if no behaviour
  /// uses the channel.
  Numbered<spec::ChannelId, std::vector<net::FusionId>> memory;
  Numbered<net::SubsystemId, KnownFacts> facts;
};

/// One page while it is drawn. Its id exists from the start, so that pages below it can name it
/// as their parent.
class Sheet {
 public:
  Sheet(Draft& draft, net::PageId parent, net::Layer layer, std::string name, net::SubsystemId subsystem,
        net::Span span);

  /// Each returns the index of the new node.
  std::uint32_t place(std::string_view name, net::Operation operation = {}, PlaceRole role = PlaceRole::none);
  std::uint32_t input(net::Operation operation = {}, std::uint32_t tokens = 0);
  std::uint32_t output();
  std::uint32_t page(net::PageId page);
  std::uint32_t fused(std::string_view name, net::FusionId set);
  /// The member of that fusion set on this page, which is drawn when it is first asked for.
  std::uint32_t member(std::string_view name, net::FusionId set);

  /// Returns the new transition, so that more of it can be set. Valid until the next one.
  net::PageTransition& transition(std::string_view name, std::vector<std::uint32_t> inputs,
                                  std::vector<std::uint32_t> outputs, net::Condition condition = {});

  /// Elements drawn from here on belong to this block.
  void in_block(net::BlockId block) { block_ = block; }

  [[nodiscard]] net::PageId id() const { return id_; }
  [[nodiscard]] net::Page& drawn() { return page_; }
  /// Puts the page into the net. The sheet must not be used afterwards.
  net::PageId finish(std::uint32_t input, std::uint32_t output);

 private:
  Draft& draft_;
  net::PageId id_;
  net::Page page_;
  net::BlockId block_;
  std::map<std::uint32_t, std::uint32_t> fused_;  ///< the first node of each fusion set
};

/// One function per layer of the paper: draws the page and all pages below it.
net::PageId draw_system(Draft& draft);
net::PageId draw_agent(Draft& draft, net::PageId parent, net::AgentId agent);
net::PageId draw_subsystem(Draft& draft, net::PageId parent, net::SubsystemId subsystem);
net::PageId draw_group(Draft& draft, net::PageId parent, net::SubsystemId subsystem, net::BehaviourId group);
net::PageId draw_behaviour(Draft& draft, net::PageId parent, net::SubsystemId subsystem,
                           net::BehaviourId behaviour);
net::PageId draw_communication(Draft& draft, net::PageId parent, net::SubsystemId subsystem,
                               net::BehaviourId behaviour, Direction direction);

}  // namespace tessera::layers
