#include "ros2/dds/run_identity.hpp"

#include <sys/random.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

namespace tessera::ros2 {
namespace {

std::string text_of_file(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A process number is used again; the time of its start since boot tells the two apart.
std::string start_of(int process) {
  const std::string stat = text_of_file("/proc/" + std::to_string(process) + "/stat");
  const std::size_t name_end = stat.rfind(')');  // the name may contain any character
  if (name_end == std::string::npos) return {};
  std::istringstream rest(stat.substr(name_end + 1));
  std::string field;
  constexpr int fields_until_start = 20;
  for (int index = 0; index < fields_until_start; ++index) rest >> field;
  return field;
}

/// FNV-1a.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace

GoalPrefix goal_prefix(int process, const std::string& client) {
  const std::uint64_t hash = hash_of(text_of_file("/proc/sys/kernel/random/boot_id") + " " +
                                     std::to_string(process) + " " + start_of(process) + " " + client);
  GoalPrefix prefix{};
  std::memcpy(prefix.data(), &hash, sizeof hash);
  return prefix;
}

GoalId new_goal_id(const GoalPrefix& prefix) {
  GoalId id{};
  // Less than 256 bytes are never interrupted.
  static_cast<void>(getrandom(id.data(), id.size(), 0));
  std::ranges::copy(prefix, id.begin());
  return id;
}

bool has_prefix(const GoalId& id, const GoalPrefix& prefix) {
  return std::equal(prefix.begin(), prefix.end(), id.begin());
}

}  // namespace tessera::ros2
