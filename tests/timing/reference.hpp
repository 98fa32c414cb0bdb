// The reference of the bounds, which another hand wrote: its random systems, its bounds, and its simulation.
#pragma once
#pragma GCC system_header  // its warnings are its own

#define TIMING_NO_MAIN
#include TESSERA_TIMING_REFERENCE

#include "timing/bounds.hpp"

namespace tessera::timing {

inline System system_of(const ::timing::Net& net) {
  System system;
  system.latency = net.latency;
  for (const ::timing::Subsystem& one : net.subsystems) {
    Subsystem& mine = system.subsystems.emplace_back();
    mine.period = one.period;
    mine.shortest = one.bcet;
    mine.longest = one.wcet;
    mine.catch_up = one.catch_up;
    mine.parallel = one.parallel;
    mine.sends.assign(one.sends.begin(), one.sends.end());
    mine.receives.assign(one.receives.begin(), one.receives.end());
    mine.processor = one.cpu;
    mine.priority = one.priority;
  }
  for (const ::timing::Channel& one : net.channels)
    system.channels.push_back({static_cast<std::uint32_t>(one.from), static_cast<std::uint32_t>(one.to),
                               one.send_blocks, one.receive_blocks, one.send_timeout, one.receive_timeout});
  return system;
}
inline Chain chain_of(const ::timing::Chain& chain) { return {chain.begin(), chain.end()}; }

}  // namespace tessera::timing
