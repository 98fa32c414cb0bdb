#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>

namespace ring {

/// One line of what happens, with the time of day, which all machines of the test share: "@ MS WHAT A B C".
inline void say(const char* what, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0) {
  const auto now = std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  dprintf(STDERR_FILENO, "@ %lld %s %llu %llu %llu\n", static_cast<long long>(now.count()), what,
          static_cast<unsigned long long>(a), static_cast<unsigned long long>(b),
          static_cast<unsigned long long>(c));
}

}  // namespace ring
