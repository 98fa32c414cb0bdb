#include "links/incarnation.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>

namespace tessera {

network::Incarnation new_incarnation(const std::string& recording, const std::string& process) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  network::Incarnation made{static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000U +
                            static_cast<std::uint64_t>(now.tv_nsec)};
  if (recording.empty()) return made;
  const std::filesystem::path file =
      std::filesystem::path(recording).parent_path() / ("incarnation." + process);
  std::uint64_t last = 0;
  std::ifstream(file) >> last;
  made.value = std::max(made.value, last + 1);
  std::ofstream(file) << made.value << '\n';  // if it cannot be stored, the clock has to suffice
  return made;
}

}  // namespace tessera
