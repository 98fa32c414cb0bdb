#include "sim/unknown_name.hpp"

#include "tessera/nearest.hpp"

namespace tessera::sim {

std::string unknown_name(std::string_view what, std::string_view name,
                         const std::vector<std::string>& known) {
  const std::string text = "no " + std::string(what) + " '" + std::string(name) + "'";
  if (known.empty()) return text + "; there is none at all";
  std::string list = known.size() == 1 ? "there is " : "there are ";
  for (const std::string& k : known) list += (&k == &known.front() ? "" : ", ") + k;
  return with_hint(text + "; " + list, did_you_mean(name, known));
}

}  // namespace tessera::sim
