#include <algorithm>

#include "drawing/drawing.hpp"

namespace tessera::drawing {
namespace {

std::string counted(std::size_t number, const char* noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

class TreePen {
 public:
  TreePen(const net::HierarchicalNet& net, const TreeOptions& options) : net_(net), options_(options) {}

  std::string result() {
    if (!net_.pages.empty()) add(net::PageId{0}, "", "", options_.levels);
    return std::move(text_);
  }

 private:
  void add(net::PageId id, const std::string& branch, const std::string& indent, unsigned levels) {
    const net::Page& page = net_.pages[id.value];
    text_ += dim(branch) + (page.parent.valid() ? page.name : "system") + "  " + dim(size_of(page)) + "\n";
    if (levels == 0) return;
    std::vector<net::PageId> below;
    for (const net::Node& node : page.nodes)
      if (node.page.valid()) below.push_back(node.page);
    for (const net::PageId child : below) {
      const bool last = child == below.back();
      add(child, indent + (last ? "\u2514\u2500 " : "\u251c\u2500 "), indent + (last ? "   " : "\u2502  "),
          levels - 1);
    }
  }

  [[nodiscard]] static std::string size_of(const net::Page& page) {
    const auto fused =
        std::ranges::count_if(page.nodes, [](const net::Node& node) { return node.fusion.valid(); });
    const auto pages =
        std::ranges::count_if(page.nodes, [](const net::Node& node) { return node.page.valid(); });
    std::string text = counted(page.nodes.size() - static_cast<std::size_t>(fused + pages), "place");
    if (fused > 0) text += " + " + std::to_string(fused) + " fused";
    return text + ", " + counted(page.transitions.size(), "transition");
  }

  [[nodiscard]] std::string dim(const std::string& text) const {
    return options_.colour && !text.empty() ? "\033[2m" + text + "\033[0m" : text;
  }

  const net::HierarchicalNet& net_;
  const TreeOptions& options_;
  std::string text_;
};

}  // namespace

std::string tree(const net::HierarchicalNet& net, const TreeOptions& options) {
  return TreePen(net, options).result();
}

}  // namespace tessera::drawing
