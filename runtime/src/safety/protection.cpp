#include "safety/protection.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "safety/guardian_shared.hpp"

namespace tessera {

std::vector<std::string> unprotected_devices(const Assembly& assembly) {
  std::vector<std::string> paths = effectors_without_guardian(assembly.system, assembly.options);
  for (const auto& executor : assembly.executors)
    for (const std::string& beating : executor->operations().devices().with_heartbeat())
      std::erase(paths, beating);
  return paths;
}

std::string listed_devices(const std::vector<std::string>& names) {
  constexpr std::size_t shown = 16;
  const std::vector<std::string> first(names.begin(), names.begin() + std::min(names.size(), shown));
  std::string text = fmt::format("{}", fmt::join(first, ", "));
  if (names.size() > shown) text += fmt::format(", and {} more", names.size() - shown);
  return text;
}

DeathNote::DeathNote(std::string file, const std::vector<std::string>& unprotected) : file_(std::move(file)) {
  if (file_.empty()) return;
  std::ofstream stream(file_);
  stream << "\n\n";
  for (const std::string& device : unprotected) stream << device << "\n";
}

DeathNote::~DeathNote() {
  if (!file_.empty()) unlink(file_.c_str());
}

}  // namespace tessera
