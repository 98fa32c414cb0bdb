#include "drawing/picture.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <unordered_map>
#include <utility>

#include "drawing/paper_labels.hpp"

namespace tessera::drawing {
namespace {

class Sketch {
 public:
  Sketch(const net::HierarchicalNet& net, const Labels& labels)
      : net_(net), labels_(labels), nodes_(net.pages.size()) {}

  Picture result(net::PageId root, unsigned levels) {
    picture_.title = Label(root.value == 0 ? "multi-agent system" : net_.path(root));
    picture_.layer = net_.pages[root.value].layer;
    add_nodes(root, levels, {});
    for (const net::PageId page : drawn_) add_transitions(page);
    mark_back();
    return std::move(picture_);
  }

 private:
  struct Drawn {
    std::uint32_t circle = 0;
    bool opened = false;  ///< the page is replaced by its net, and there is no circle
  };

  void add_nodes(net::PageId id, unsigned levels, FrameId frame) {
    drawn_.push_back(id);
    frame_of_[id.value] = frame;
    const net::Page& page = net_.pages[id.value];
    for (std::uint32_t node = 0; node < page.nodes.size(); ++node) {
      const net::Node& drawn = page.nodes[node];
      if (drawn.page.valid() && levels > 0) {
        nodes_[id.value].push_back({0, true});
        picture_.frames.push_back({labels_.page(drawn.page), net_.pages[drawn.page.value].layer, frame});
        add_nodes(drawn.page, levels - 1, {static_cast<std::uint32_t>(picture_.frames.size() - 1)});
      } else {
        nodes_[id.value].push_back(
            {drawn.fusion.valid() ? fused(id, node, frame) : circle(id, node, frame), false});
      }
    }
  }

  std::uint32_t circle(net::PageId id, std::uint32_t node, FrameId frame) {
    const net::Node& drawn = net_.pages[id.value].nodes[node];
    const std::string above = net_.path(id);
    Circle made;
    made.name = drawn.page.valid() ? labels_.page(drawn.page) : labels_.node(id, node);
    made.details = labels_.operation(id, drawn.operation);
    made.path = drawn.fusion.valid() ? net_.fusions[drawn.fusion.value].name
                                     : (above.empty() ? drawn.name : above + "." + drawn.name);
    made.tokens = drawn.tokens;
    made.page = drawn.page.valid();
    made.fused = drawn.fusion.valid();
    made.frame = frame;
    picture_.circles.push_back(std::move(made));
    return static_cast<std::uint32_t>(picture_.circles.size() - 1);
  }

  /// Draws the members of one set in one picture as one circle, outside the frames that
  /// do not contain all of them.
  std::uint32_t fused(net::PageId id, std::uint32_t node, FrameId frame) {
    const net::FusionId set = net_.pages[id.value].nodes[node].fusion;
    const auto known = fused_.find(set.value);
    if (known == fused_.end()) return fused_[set.value] = circle(id, node, frame);
    Circle& met = picture_.circles[known->second];
    met.frame = common(met.frame, frame);
    met.name = labels_.fused(set);
    if (const auto& operation = net_.pages[id.value].nodes[node].operation; met.details.empty())
      met.details = labels_.operation(id, operation);
    return known->second;
  }

  [[nodiscard]] FrameId common(FrameId a, FrameId b) const {
    // A frame comes after those that contain it, so the later one of two different
    // frames is never the common one.
    while (a != b) {
      if (!a.valid() || !b.valid()) return {};
      FrameId& later = a > b ? a : b;
      later = picture_.frames[later.value].parent;
    }
    return a;
  }

  void add_transitions(net::PageId id) {
    const net::Page& page = net_.pages[id.value];
    const std::string above = net_.path(id);
    for (std::uint32_t index = 0; index < page.transitions.size(); ++index) {
      const net::PageTransition& drawn = page.transitions[index];
      Bar made;
      made.name = labels_.transition(id, index);
      made.details = in_brackets(labels_.condition(id, drawn.condition));
      made.path = above.empty() ? drawn.name : above + "." + drawn.name;
      made.fires = fires(drawn.condition);
      made.frame = frame_of_[id.value];
      const auto bar = static_cast<std::uint32_t>(picture_.bars.size());
      picture_.bars.push_back(std::move(made));
      for (const std::uint32_t end : drawn.inputs)
        picture_.arrows.push_back({resolve(id, end, &net::Page::output), bar, true, false});
      for (const std::uint32_t end : drawn.outputs)
        picture_.arrows.push_back({resolve(id, end, &net::Page::input), bar, false, false});
    }
  }

  static Fires fires(const net::Condition& condition) {
    if (condition.known(true).truth == net::Condition::Truth::never) return Fires::never;
    return condition.truth == net::Condition::Truth::never ? Fires::after_failure : Fires::by_condition;
  }

  static std::vector<Label> in_brackets(std::vector<Label> lines) {
    if (lines.empty()) return lines;
    lines.front() = Label("[").add(lines.front());
    lines.back().add("]");
    return lines;
  }

  [[nodiscard]] std::uint32_t resolve(net::PageId page, std::uint32_t node,
                                      std::uint32_t net::Page::*port) const {
    while (nodes_[page.value][node].opened) {
      page = net_.pages[page.value].nodes[node].page;
      node = net_.pages[page.value].*port;
    }
    return nodes_[page.value][node].circle;
  }

  void mark_back() {
    std::vector<bool> taken(picture_.circles.size(), false);
    std::vector<std::optional<std::uint32_t>> first_input(picture_.bars.size());
    for (const Arrow& arrow : picture_.arrows) {
      if (!arrow.to_bar) continue;
      taken[arrow.circle] = true;
      if (!picture_.circles[arrow.circle].fused)
        first_input[arrow.bar] = std::min(first_input[arrow.bar].value_or(arrow.circle), arrow.circle);
    }
    for (Arrow& arrow : picture_.arrows) {
      if (arrow.to_bar) continue;
      const bool fused = picture_.circles[arrow.circle].fused;
      const std::optional<std::uint32_t> from = first_input[arrow.bar];
      arrow.back = fused ? taken[arrow.circle] : from && arrow.circle <= *from;
    }
  }

  const net::HierarchicalNet& net_;
  const Labels& labels_;
  Picture picture_;
  std::vector<std::vector<Drawn>> nodes_;                   // per page of the net, once it is drawn
  std::vector<net::PageId> drawn_;                          // in the order of the pages
  std::unordered_map<std::uint32_t, FrameId> frame_of_;     // per drawn page
  std::unordered_map<std::uint32_t, std::uint32_t> fused_;  // circle per fusion set
};

}  // namespace

Picture picture_of(const net::HierarchicalNet& net, net::PageId page, const Options& options) {
  assert(page.value < net.pages.size());
  assert(options.notation == Notation::paths || options.model != nullptr);
  const auto labels =
      options.notation == Notation::paper ? paper_labels(net, *options.model) : path_labels(net);
  Picture picture = Sketch(net, *labels).result(page, options.levels);
  if (options.notation == Notation::paper && page.value != 0)
    picture.title = labels->page(page).add("   " + net.path(page));
  return picture;
}

}  // namespace tessera::drawing
