#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace features {

/// A behaviour that follows an errand, as it began: what the courier knew of it then.
struct EndOfErrand {
  std::string behaviour;
  std::uint32_t call = 0;
  std::string state;
  bool cancels = false;
};
inline std::vector<EndOfErrand> ends_of_errands;
inline std::vector<std::uint32_t> served_errands;

}  // namespace features
