#include "drawing/picture.hpp"

namespace tessera::drawing {
namespace {

class PathLabels : public Labels {
 public:
  explicit PathLabels(const net::HierarchicalNet& net) : net_(net) {}

  [[nodiscard]] Label page(net::PageId page) const override {
    return page.value == 0 ? Label("system") : Label(net_.pages[page.value].name);
  }

  [[nodiscard]] Label node(net::PageId page, std::uint32_t node) const override {
    return Label(net_.pages[page.value].nodes[node].name);
  }

  [[nodiscard]] Label fused(net::FusionId set) const override { return Label(net_.fusions[set.value].name); }

  [[nodiscard]] std::vector<Label> operation(net::PageId page,
                                             const net::Operation& operation) const override {
    using Kind = net::Operation::Kind;
    switch (operation.kind) {
      case Kind::none:
        return {};
      case Kind::transition_function:
        return {Label(net_.pages[page.value].name + "()")};
      case Kind::next_iteration:
        return {Label("i := i + 1")};
      case Kind::write:
        return {Label("write")};
      case Kind::read:
        return {Label("read")};
    }
    return {};
  }

  [[nodiscard]] Label transition(net::PageId page, std::uint32_t transition) const override {
    return Label(net_.pages[page.value].transitions[transition].name);
  }

  [[nodiscard]] std::vector<Label> condition(net::PageId, const net::Condition& condition) const override {
    std::vector<Label> lines;
    for (std::string& line : wrapped(condition.text, 26, 3)) lines.emplace_back(std::move(line));
    return lines;
  }

 private:
  const net::HierarchicalNet& net_;
};

}  // namespace

std::unique_ptr<Labels> path_labels(const net::HierarchicalNet& net) {
  return std::make_unique<PathLabels>(net);
}

}  // namespace tessera::drawing
