#include "sim/devices/device_error.hpp"

#include <algorithm>

#include "tessera/nearest.hpp"

namespace tessera::sim {

std::string short_list(const std::vector<std::string>& names) {
  constexpr std::size_t shown = 12;
  std::string list;
  for (std::size_t at = 0; at < std::min(shown, names.size()); ++at)
    list += (at == 0 ? "" : ", ") + names[at];
  return names.size() <= shown ? list : list + " and " + std::to_string(names.size() - shown) + " more";
}

DriverProblem unknown_name(const std::string& what, const std::string& name,
                           const std::vector<std::string>& known) {
  const std::string text = "the world has no " + what + " '" + name + "'";
  if (known.empty()) return {text, "it has no " + what + " with a name at all", name};
  const std::string near = did_you_mean(name, known).text;
  return {text, near + (near.empty() ? "" : " ") + "the world has: " + short_list(known), name};
}

}  // namespace tessera::sim
