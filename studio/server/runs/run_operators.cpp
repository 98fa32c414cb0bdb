#include "server/runs/run_operators.hpp"

#include <chrono>

namespace tessera::server {

using nlohmann::json;

namespace {

/// The life of an input whose page does not tell it.
constexpr double usual_life_s = 0.5;

}  // namespace

bool RunOperators::is_late(const Input& input, double now_s) {
  return input.after_s && input.within_s && now_s - *input.after_s > *input.within_s;
}

void RunOperators::gave(const Input& input, double now_s) {
  const std::lock_guard lock(mutex_);
  given_.insert_or_assign(input.path, Given{input.who, now_s + input.within_s.value_or(usual_life_s)});
}

void RunOperators::let_go(const std::string& path, const std::string& who) {
  const std::lock_guard lock(mutex_);
  const auto found = given_.find(path);
  if (found != given_.end() && found->second.who == who) given_.erase(found);
}

json RunOperators::shown(double now_s) const {
  json all = json::array();
  const std::lock_guard lock(mutex_);
  for (const auto& [path, given] : given_)
    if (now_s < given.until_s) all.push_back({{"path", path}, {"operator", given.who}});
  return {{"stamp", now_s}, {"operators", std::move(all)}};
}

double stamp_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace tessera::server
