#include "layers/drawn_net.hpp"

#include <utility>

namespace tessera::test {
namespace {

class Drawing {
 public:
  explicit Drawing(const net::HierarchicalNet& net) : net_(net) {}

  DrawnNet result() {
    for (const net::FusionSet& set : net_.fusions) add_counter(set.name, set.tokens);
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page) add_nodes(page);
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page)
      for (const net::PageTransition& transition : net_.pages[page].transitions)
        made_.game.transitions.push_back({arcs(page, transition.inputs, &net::Page::output),
                                          arcs(page, transition.outputs, &net::Page::input)});
    return std::move(made_);
  }

 private:
  void add_counter(std::string name, std::uint32_t tokens) {
    made_.game.initial.push_back(tokens);
    made_.names.push_back(std::move(name));
  }

  /// One counter per node; those of pages and members of fusion sets stay empty.
  void add_nodes(std::uint32_t page) {
    first_.push_back(static_cast<std::uint32_t>(made_.names.size()));
    const std::string path = net_.path(net::PageId{page});
    for (const net::Node& node : net_.pages[page].nodes) {
      const bool counts = !node.fusion.valid() && !node.page.valid();
      add_counter((path.empty() ? "" : path + ".") + node.name, counts ? node.tokens : 0);
    }
  }

  [[nodiscard]] std::uint32_t counter(std::uint32_t page, std::uint32_t at,
                                      std::uint32_t net::Page::*port) const {
    const net::Node& node = net_.pages[page].nodes[at];
    if (node.fusion.valid()) return node.fusion.value;
    if (!node.page.valid()) return first_[page] + at;
    return counter(node.page.value, net_.pages[node.page.value].*port, port);
  }

  [[nodiscard]] std::vector<oracle::Arc> arcs(std::uint32_t page, const std::vector<std::uint32_t>& nodes,
                                              std::uint32_t net::Page::*port) const {
    std::vector<oracle::Arc> all;
    for (const std::uint32_t node : nodes) all.push_back({counter(page, node, port)});
    return all;
  }

  const net::HierarchicalNet& net_;
  std::vector<std::uint32_t> first_;  // per page: the counter of its first node
  DrawnNet made_;
};

}  // namespace

DrawnNet drawn_net(const net::HierarchicalNet& net) { return Drawing(net).result(); }

}  // namespace tessera::test
