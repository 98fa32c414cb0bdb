#pragma once

#include <string>
#include <vector>

#include "layers/wiring.hpp"
#include "net/net.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// What the five layers draw into, together.
struct Draft {
  explicit Draft(const spec::Model& specification);

  const spec::Model& model;
  Wiring wiring;
  net::HierarchicalNet net;
  /// Per channel the fusion sets of the shared places of its model; none for channels that no behaviour uses.
  std::vector<std::vector<net::FusionId>> memory;
};

/// One page while it is drawn. Its id exists from the start, so that pages below it can name it as their
/// parent.
class Sheet {
 public:
  Sheet(Draft& draft, net::PageId parent, net::Layer layer, std::string name, std::uint32_t subsystem,
        net::Span span);

  /// Each returns the index of the new node.
  std::uint32_t place(std::string name, net::Operation operation = {}, std::uint32_t tokens = 0);
  std::uint32_t page(net::PageId page);
  std::uint32_t fused(std::string name, net::FusionId set);

  void transition(std::string name, std::vector<std::uint32_t> inputs, std::vector<std::uint32_t> outputs,
                  net::Condition condition = {});
  void transition(std::string name, std::vector<std::uint32_t> inputs, std::vector<std::uint32_t> outputs,
                  net::Condition condition, net::Span span);

  [[nodiscard]] net::PageId id() const { return id_; }
  /// Puts the page into the net. The sheet is spent.
  net::PageId finish(std::uint32_t input, std::uint32_t output);

 private:
  Draft& draft_;
  net::PageId id_;
  net::Page page_;
};

/// One function per layer of the paper: draws the page and all pages below it.
net::PageId draw_system(Draft& draft);
net::PageId draw_agent(Draft& draft, net::PageId parent, spec::Index agent);
net::PageId draw_subsystem(Draft& draft, net::PageId parent, spec::Index instance);
net::PageId draw_behaviour(Draft& draft, net::PageId parent, spec::Index instance, spec::Index behaviour);
net::PageId draw_communication(Draft& draft, net::PageId parent, spec::Index instance,
                               const spec::Behaviour& behaviour, Direction direction);

}  // namespace tessera::layers
