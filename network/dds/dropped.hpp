#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "network/carrier.hpp"
#include "network/dds/presence.hpp"

namespace tessera::dds {

/// Counts dropped messages, and reports them once a second at most, so that an attacker or a mistake cannot
/// fill the disk with complaints.
class Dropped {
 public:
  /// verb: "dropped" or "could not send".
  explicit Dropped(const char* verb) : verb_(verb) {}
  /// describe: gives the text for this message. It is called only for the first message since the last
  /// complaint.
  template <class Describe>
  void add(Describe describe) {
    if (count_++ == 0) first_ = describe();
  }
  /// Complains if a message was dropped and the last complaint is at least a second old.
  void tell(Clock::time_point now, network::Carrier::Listener& listener) {
    if (count_ == 0 || now < next_) return;
    next_ = now + std::chrono::seconds(1);
    const std::uint64_t count = count_;
    count_ = 0;
    if (count == 1) return listener.complaint(std::string(verb_) + " " + first_);
    listener.complaint(std::string(verb_) + " " + std::to_string(count) + " messages; the first: " + first_);
  }

 private:
  const char* verb_;
  std::uint64_t count_ = 0;
  std::string first_;
  Clock::time_point next_ = Clock::time_point::min();
};

}  // namespace tessera::dds
