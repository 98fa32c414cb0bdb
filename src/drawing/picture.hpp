#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drawing/drawing.hpp"
#include "drawing/label.hpp"

namespace tessera::drawing {

inline constexpr std::uint32_t no_frame = UINT32_MAX;

/// A place or page.
struct Circle {
  Label name;
  std::vector<Label> details;  ///< the operation
  std::string path;            ///< told when the pointer rests on it
  std::uint32_t tokens = 0;
  bool page = false, fused = false;
  std::uint32_t frame = no_frame;
};

/// When a transition can fire, as far as it is known before run time.
enum class Fires : std::uint8_t {
  by_condition,
  after_failure,  ///< only if user code throws, a device fails or the watchdog strikes
  never
};

/// A transition.
struct Bar {
  Label name;
  std::vector<Label> details;  ///< the condition, in square brackets
  std::string path;
  Fires fires = Fires::by_condition;
  std::uint32_t frame = no_frame;
};

struct Arrow {
  std::uint32_t circle = 0, bar = 0;
  bool to_bar = false;
  /// The arc is no step of the way from top to bottom: it gives back to a fused place that is also taken
  /// from, or it returns to a place drawn before all those that its bar takes from.
  bool back = false;
};

/// The rectangle around the net of a page.
struct Frame {
  Label name;
  net::Layer layer = net::Layer::system;
  std::uint32_t parent = no_frame;  ///< an earlier frame
};

/// What is drawn, before anything has a position.
struct Picture {
  Label title;
  net::Layer layer = net::Layer::system;
  std::vector<Circle> circles;
  std::vector<Bar> bars;
  std::vector<Arrow> arrows;
  std::vector<Frame> frames;
};

/// What stands beside nodes, in one of the notations.
class Labels {
 public:
  virtual ~Labels() = default;
  [[nodiscard]] virtual Label page(net::PageId page) const = 0;
  [[nodiscard]] virtual Label node(net::PageId page, std::uint32_t node) const = 0;
  /// A fused place that stands for its members in several nets.
  [[nodiscard]] virtual Label fused(net::FusionId set) const = 0;
  [[nodiscard]] virtual std::vector<Label> operation(net::PageId page,
                                                     const net::Operation& operation) const = 0;
  [[nodiscard]] virtual Label transition(net::PageId page, std::uint32_t transition) const = 0;
  /// Without brackets; empty: nothing to say.
  [[nodiscard]] virtual std::vector<Label> condition(net::PageId page,
                                                     const net::Condition& condition) const = 0;
};

[[nodiscard]] std::unique_ptr<Labels> path_labels(const net::HierarchicalNet& net);

[[nodiscard]] Picture picture_of(const net::HierarchicalNet& net, net::PageId page, const Options& options);

}  // namespace tessera::drawing
