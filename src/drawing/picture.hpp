#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drawing/drawing.hpp"
#include "drawing/label.hpp"

namespace tessera::drawing {

using FrameId = net::Id<struct FrameTag>;  ///< into Picture::frames

/// A place or page.
struct Circle {
  Label name;
  std::vector<Label> details;  ///< the operation
  std::string path;            ///< shown when the pointer rests on the circle
  std::uint32_t tokens = 0;
  bool page = false, fused = false;
  FrameId frame{};
};

/// When a transition can fire, as far as this is known before run time.
enum class Fires : std::uint8_t {
  by_condition,
  after_failure,  ///< only if user code throws, a device fails or the watchdog expires
  never
};

/// A transition.
struct Bar {
  Label name;
  std::vector<Label> details;  ///< the condition, in square brackets
  std::string path;
  Fires fires = Fires::by_condition;
  FrameId frame{};
};

struct Arrow {
  std::uint32_t circle = 0, bar = 0;
  bool to_bar = false;
  /// The arc is not part of the way from top to bottom: it returns a token to a fused place from which the
  /// transition also takes, or it leads to a place drawn before all input places of its bar.
  bool back = false;
};

/// The rectangle around the net of a page.
struct Frame {
  Label name;
  net::Layer layer = net::Layer::system;
  FrameId parent{};  ///< an earlier frame
};

/// The elements of a drawing, before they have positions.
struct Picture {
  Label title;
  net::Layer layer = net::Layer::system;
  std::vector<Circle> circles;
  std::vector<Bar> bars;
  std::vector<Arrow> arrows;
  std::vector<Frame> frames;
};

/// The labels of nodes in one of the notations.
class Labels {
 public:
  virtual ~Labels() = default;
  [[nodiscard]] virtual Label page(net::PageId page) const = 0;
  [[nodiscard]] virtual Label node(net::PageId page, std::uint32_t node) const = 0;
  /// The label of a fused place, which represents its members in several nets.
  [[nodiscard]] virtual Label fused(net::FusionId set) const = 0;
  [[nodiscard]] virtual std::vector<Label> operation(net::PageId page,
                                                     const net::Operation& operation) const = 0;
  [[nodiscard]] virtual Label transition(net::PageId page, std::uint32_t transition) const = 0;
  /// The condition without brackets; empty: none.
  [[nodiscard]] virtual std::vector<Label> condition(net::PageId page,
                                                     const net::Condition& condition) const = 0;
};

[[nodiscard]] std::unique_ptr<Labels> path_labels(const net::HierarchicalNet& net);

[[nodiscard]] Picture picture_of(const net::HierarchicalNet& net, net::PageId page, const Options& options);

}  // namespace tessera::drawing
