#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "net/net.hpp"

namespace tessera::server {

/// Where the tokens of a net are while a recorded run goes on.
class MarkingTracker {
 public:
  /// The initial marking. net: must outlive it.
  explicit MarkingTracker(const net::Net& net);
  void fire(std::uint32_t transition);
  /// One in each of these places, and no others.
  void set(std::span<const std::uint32_t> places);
  /// Places that hold one.
  [[nodiscard]] std::vector<std::uint32_t> marked() const;

 private:
  const net::Net& net_;
  std::vector<std::int32_t> tokens_;  ///< may be below 0 for a moment: threads write when they come to it
};

}  // namespace tessera::server
