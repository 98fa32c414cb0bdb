// Random systems of other shapes than those of the reference.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "reference.hpp"

namespace tessera::timing {

/// The way in which subsystems are joined.
enum class Shape : std::uint8_t {
  fan_in,
  fan_out,
  merged,
  long_chain,
  diamonds,
  feedback,
  armed_ring,
  star,
  dense,
  tight_ring,
  count
};
inline constexpr std::array shape_names{"fan in",   "fan out",    "merged", "long chain", "diamonds",
                                        "feedback", "armed ring", "star",   "dense",      "tight ring"};

class Drawing {
 public:
  Drawing(std::uint64_t seed, Shape shape, bool late)
      : random_(seed * 0xd1342543de82ef95U + 977 * static_cast<std::uint64_t>(shape) + 5), shape_(shape) {
    may_be_late_ = late;
  }

  ::timing::Case take() {
    send_ = one_of({0, 0.1, 0.3, 0.6, 0.95});
    receive_ = one_of({0, 0.2, 0.5, 0.8, 1});
    timeouts_ = one_of({0, 0, 0.3, 0.9});
    join();
    draw_times();
    if (shape_ == Shape::tight_ring) tighten();
    draw_orders();
    if (may_be_late_ && random_.chance(0.4)) net().latency = random_.in(1, random_.chance(0.7) ? 3 : 12);
    if (random_.chance(0.3)) share_processors();
    set_timeouts();
    draw_chains();
    return std::move(made_);
  }

 private:
  using Tick = ::timing::Tick;
  ::timing::Net& net() { return made_.net; }
  template <class T>
  T pick(const std::vector<T>& from) {
    return random_.of(from);
  }
  double one_of(const std::vector<double>& from) { return random_.of(from); }

  int subsystem() {
    net().subsystems.emplace_back();
    return static_cast<int>(net().subsystems.size()) - 1;
  }
  void channel(int from, int to) {
    ::timing::Channel made;
    made.from = from;
    made.to = to;
    made.send_blocks = random_.chance(send_);
    made.receive_blocks = random_.chance(receive_);
    net().channels.push_back(made);
  }
  std::vector<int> several(Tick low, Tick high) {
    std::vector<int> made;
    for (Tick k = random_.in(low, high); k > 0; --k) made.push_back(subsystem());
    return made;
  }

  void join() {
    switch (shape_) {
      case Shape::fan_in: {
        const std::vector<int> receptors = several(2, 5);
        const int control = subsystem();
        for (const int one : receptors) channel(one, control);
        for (const int one : several(1, 2)) channel(control, one);
        break;
      }
      case Shape::fan_out: {
        const int receptor = subsystem(), control = subsystem();
        channel(receptor, control);
        for (const int one : several(2, 5)) {
          channel(control, one);
          if (random_.chance(0.2)) channel(one, control);
        }
        break;
      }
      case Shape::merged: {
        const int first = subsystem(), last = subsystem();
        for (const int one : several(1, 3)) {
          channel(first, one);
          channel(one, last);
          if (random_.chance(0.5)) channel(first, one);
          if (random_.chance(0.3)) channel(one, last);
        }
        if (random_.chance(0.5)) channel(first, last);
        break;
      }
      case Shape::long_chain: {
        const std::vector<int> all = several(4, 8);
        for (std::size_t k = 1; k < all.size(); ++k) channel(all[k - 1], all[k]);
        if (random_.chance(0.2)) channel(all.back(), all[all.size() - 2]);
        break;
      }
      case Shape::diamonds: {
        int at = subsystem();
        for (Tick k = random_.in(1, 2); k > 0; --k) {
          const int left = subsystem(), right = subsystem(), next = subsystem();
          channel(at, left), channel(at, right), channel(left, next), channel(right, next);
          if (random_.chance(0.3)) channel(left, right);
          at = next;
        }
        break;
      }
      case Shape::feedback: {
        const int receptor = subsystem(), control = subsystem(), planner = subsystem(),
                  effector = subsystem();
        channel(receptor, control), channel(control, planner), channel(planner, control),
            channel(control, effector);
        if (random_.chance(0.5)) {
          const int map = subsystem();
          channel(receptor, map), channel(map, planner);
          if (random_.chance(0.3)) channel(planner, map);
        }
        if (random_.chance(0.3)) channel(effector, control);
        break;
      }
      case Shape::armed_ring: {
        const std::vector<int> ring = several(2, 4);
        for (std::size_t k = 0; k < ring.size(); ++k) channel(ring[k], ring[(k + 1) % ring.size()]);
        for (const int arm : several(1, 4)) {
          const int at = pick(ring);
          random_.chance(0.5) ? channel(arm, at) : channel(at, arm);
        }
        break;
      }
      case Shape::star: {
        const int hub = subsystem();
        for (const int one : several(2, 5)) {
          channel(hub, one);
          channel(one, hub);
        }
        break;
      }
      case Shape::dense: {
        const std::vector<int> all = several(3, 5);
        for (const int a : all)
          for (const int b : all)
            if (a != b && random_.chance(0.45)) channel(a, b);
        if (net().channels.empty()) channel(all[0], all[1]);
        break;
      }
      case Shape::tight_ring: {  // in step, with a round that just fits into the period
        send_ = 0.1;
        receive_ = 0.95;
        const std::vector<int> ring = several(2, 4);
        for (std::size_t k = 0; k < ring.size(); ++k) channel(ring[k], ring[(k + 1) % ring.size()]);
        break;
      }
      case Shape::count:
        break;
    }
  }

  void draw_times() {
    const Tick way = random_.in(0, 4);
    const Tick base = random_.in(5, 30);
    const double rated = one_of({0.3, 0.7, 1, 1}), busy = one_of({0.15, 0.4, 0.8, 1.6});
    const bool fixed = random_.chance(0.15);
    for (::timing::Subsystem& one : net().subsystems) {
      if (random_.chance(rated)) {
        if (way == 0) one.period = base;
        if (way == 1) one.period = base * random_.in(1, 4);
        if (way == 2) one.period = random_.in(5, 40);
        if (way == 3) one.period = pick<Tick>({9, 10, 15, 21, 35});
        if (way == 4) one.period = random_.chance(0.5) ? base : base + random_.in(-2, 2);
      }
      const Tick most = one.period > 0 ? one.period : base;
      one.wcet = std::max<Tick>(1, static_cast<Tick>(static_cast<double>(most) * busy *
                                                     static_cast<double>(random_.in(1, 100)) / 100));
      one.bcet = fixed || random_.chance(0.2) ? one.wcet : random_.chance(0.3) ? 1 : random_.in(1, one.wcet);
      one.catch_up = random_.chance(0.2);
      one.parallel = random_.chance(0.3);
    }
  }
  void tighten() {
    const Tick period = random_.in(5, 20);
    for (::timing::Subsystem& one : net().subsystems) {
      one.period = period;
      one.wcet = random_.chance(0.5) ? period : random_.in(1, period);
      one.bcet = random_.chance(0.5) ? 0 : random_.in(0, one.wcet);
    }
  }
  void draw_orders() {
    for (std::size_t c = 0; c < net().channels.size(); ++c) {
      net().subsystems[net().channels[c].from].sends.push_back(static_cast<int>(c));
      net().subsystems[net().channels[c].to].receives.push_back(static_cast<int>(c));
    }
    for (::timing::Subsystem& one : net().subsystems)
      for (std::vector<int>* const list : {&one.sends, &one.receives})
        for (std::size_t k = list->size(); k > 1; --k)
          std::swap((*list)[k - 1],
                    (*list)[static_cast<std::size_t>(random_.in(0, static_cast<Tick>(k) - 1))]);
  }
  void share_processors() {
    const Tick levels = random_.in(1, 4);
    for (::timing::Subsystem& one : net().subsystems) {
      if (random_.chance(0.3)) continue;
      one.cpu = static_cast<int>(random_.in(0, 1));
      one.priority = static_cast<int>(random_.in(1, levels));
      one.catch_up = false;
      one.wcet = std::max<Tick>(one.bcet = std::max<Tick>(1, one.bcet / 3), one.wcet / 3);
    }
  }
  /// Near the longest wait, so that a bound that is too small by one shows.
  void set_timeouts() {
    if (timeouts_ == 0) return;
    const Bounds without(system_of(net()));
    const Occurrences& waits = without.occurrences();
    const auto near = [&](EventId z) -> Tick {
      if (!random_.chance(timeouts_)) return 0;
      const Time wait = waits.wait(z);
      if (wait >= unbounded || random_.chance(0.3)) return random_.in(1, 60);
      if (random_.chance(0.6)) return std::max<Tick>(1, wait + random_.in(-2, 3));
      return std::max<Tick>(1, wait * random_.in(1, 15) / 10);
    };
    for (std::uint32_t c = 0; c < net().channels.size(); ++c) {
      ::timing::Channel& one = net().channels[c];
      if (one.send_blocks) one.send_timeout = near(waits.events().acked(c));
      if (one.receive_blocks) one.receive_timeout = near(waits.events().read(c));
    }
  }
  void draw_chains() {
    std::set<::timing::Chain> known;
    for (int k = 0; k < 12 && known.size() < 4; ++k) {
      ::timing::Chain chain;
      int at = k < 2 ? net().channels.front().from
                     : static_cast<int>(random_.in(0, static_cast<Tick>(net().subsystems.size()) - 1));
      std::set<int> used;
      const Tick most = k % 2 == 0 ? 7 : random_.in(1, 7);
      while (static_cast<Tick>(chain.size()) < most) {
        std::vector<int> ways;
        for (const int c : net().subsystems[at].sends)
          if (!used.contains(c)) ways.push_back(c);
        if (ways.empty()) break;
        chain.push_back(pick(ways));
        used.insert(chain.back());
        at = net().channels[chain.back()].to;
      }
      if (!chain.empty() && known.insert(chain).second) made_.chains.push_back(chain);
    }
  }

  ::timing::Random random_;
  Shape shape_;
  bool may_be_late_ = false;
  double send_ = 0, receive_ = 0, timeouts_ = 0;
  ::timing::Case made_;
};

/// may_be_late: some systems have a latency.
struct Asked {
  bool may_be_late = false;
};
inline ::timing::Case draw_shape(std::uint64_t seed, Asked asked) {
  return Drawing(seed, static_cast<Shape>(seed % static_cast<std::uint64_t>(Shape::count)), asked.may_be_late)
      .take();
}

inline constexpr Time longest_pattern = 6000;
/// The time after which everything repeats that the bounds know instant by instant, with the time until it does; at
/// most `most`.
inline Time pattern_of_all(const Bounds& bounds, Time most) {
  Time all = 1, settled = 0;
  const System& system = bounds.occurrences().system();
  for (std::uint32_t i = 0; i < system.subsystems.size() && all < most; ++i) {
    const Clocked& clocked = bounds.clocked();
    const Time one = clocked.knows(i) ? clocked.pattern(i) : system.subsystems[i].period;
    if (one > 0) all = std::lcm(all, one);
    if (clocked.knows(i)) settled = std::max(settled, clocked.settled(i));
  }
  return std::min(all + settled, most);
}

}  // namespace tessera::timing
