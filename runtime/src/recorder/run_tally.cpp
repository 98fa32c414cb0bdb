#include "recorder/run_tally.hpp"

#include <algorithm>

namespace tessera {

void RunTally::note(std::uint32_t instance, Fault fault, Time time, std::string_view text) {
  // It comes from a signal handler, which must not allocate; the process ends after it.
  if (fault == Fault::crash) return;
  const std::string_view name = instance == system_instance ? name_in_fault(text) : "";
  const auto seen = std::ranges::find_if(faults_, [&](const SeenFault& one) {
    return one.fault == fault && one.instance == instance && one.name == name;
  });
  if (seen != faults_.end()) {
    ++seen->count;
    return;
  }
  faults_.push_back({.fault = fault,
                     .instance = instance,
                     .name = std::string(name),
                     .count = 1,
                     .first = time,
                     .text = std::string(text)});
}

}  // namespace tessera
