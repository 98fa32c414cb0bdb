#include "verify/search/walks.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace tessera::verify {
namespace {

/// A marking that changes, and the transitions that are enabled in it.
class Walker {
 public:
  explicit Walker(const explore::PtNet& net) : net_(net), position_(net.transitions(), none) { begin(); }

  void begin() {
    marking_ = net_.initial();
    for (std::uint32_t transition = 0; transition < net_.transitions(); ++transition) look_at(transition);
  }

  /// Fires one; nullopt: none is enabled.
  [[nodiscard]] std::optional<std::uint32_t> step() {
    if (enabled_.empty()) return std::nullopt;
    const std::uint32_t transition = enabled_[next_number() % enabled_.size()];
    net_.fire(transition, marking_);
    for (const explore::Touch& touch : net_.of_transition(transition))
      if (touch.effect() != 0)
        for (const explore::Touch& other : net_.of_place(touch.node)) look_at(other.node);
    return transition;
  }

  [[nodiscard]] const explore::Marking& marking() const { return marking_; }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  void look_at(std::uint32_t transition) {
    const bool enabled = net_.enabled(transition, marking_);
    std::uint32_t& at = position_[transition];
    if (enabled == (at != none)) return;
    if (enabled) {
      at = static_cast<std::uint32_t>(enabled_.size());
      enabled_.push_back(transition);
      return;
    }
    position_[enabled_.back()] = at;
    enabled_[at] = enabled_.back();
    enabled_.pop_back();
    at = none;
  }

  /// Source: Marsaglia, *Xorshift RNGs*, 2003.
  std::uint64_t next_number() {
    random_ ^= random_ << 13U;
    random_ ^= random_ >> 7U;
    random_ ^= random_ << 17U;
    return random_ >> 16U;
  }

  const explore::PtNet& net_;
  explore::Marking marking_;
  std::vector<std::uint32_t> enabled_;
  std::vector<std::uint32_t> position_;  // per transition: in enabled_
  std::uint64_t random_ = 0x2545f4914f6cdd1dULL;
};

}  // namespace

std::vector<bool> marked_on_walks(const explore::PtNet& net, const std::vector<std::uint32_t>& places,
                                  std::size_t firings, const explore::Budget& budget) {
  constexpr std::size_t between_checks = 1024;
  std::vector<std::vector<std::uint32_t>> wanted(net.places());  // per place: where it is listed
  std::vector<bool> marked(places.size(), false);
  std::size_t left = places.size();
  const auto note = [&](std::uint32_t place) {
    left -= wanted[place].size();
    for (const std::uint32_t at : wanted[place]) marked[at] = true;
    wanted[place].clear();
  };
  for (std::uint32_t at = 0; at < places.size(); ++at) wanted[places[at]].push_back(at);
  for (const std::uint32_t place : places)
    if (net.initial()[place] > 0) note(place);
  const std::size_t longest = std::max<std::size_t>(1000, std::size_t{20} * net.transitions());
  Walker walker(net);
  std::size_t length = 0;
  for (std::size_t firing = 0; firing < firings && left > 0; ++firing) {
    if (firing % between_checks == 0) budget.check();
    const std::optional<std::uint32_t> fired = ++length > longest ? std::nullopt : walker.step();
    if (!fired) {
      if (length <= 1) break;  // nothing can happen at all
      walker.begin();
      length = 0;
      continue;
    }
    for (const explore::Touch& touch : net.of_transition(*fired))
      if (touch.produces > 0) note(touch.node);
  }
  return marked;
}

}  // namespace tessera::verify
