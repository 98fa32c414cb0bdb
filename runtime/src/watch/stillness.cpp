#include "watch/stillness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tessera {
namespace {

constexpr Duration between_looks_for_stillness = std::chrono::milliseconds(250);

}  // namespace

std::string why_nothing_happens(const Assembly& assembly) {
  constexpr int shown = 8;
  std::string text = "nothing can ever happen again";
  int named = 0, waiting = 0;
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance) {
    if (assembly.control.has_ended(instance)) continue;
    ++waiting;
    if (named++ < shown)
      text += (named == 1 ? ": " : "; ") + assembly.executors[instance]->whereabouts(assembly.system);
  }
  if (waiting > shown) text += fmt::format("; and {} more", waiting - shown);
  return text;
}

bool Stillness::look(Time now, const WakeWord* words, const std::function<bool(std::uint32_t)>& gone) {
  if (now < next_) return false;
  next_ = now + between_looks_for_stillness;
  bool still = true, any = false;
  for (std::uint32_t thread = 0; thread < rests_.size(); ++thread) {
    const std::uint64_t rest = gone(thread) ? 0 : words[thread].rest();
    const std::uint64_t before = std::exchange(rests_[thread], rest);
    const bool rests = rest != 0 && rest == before;
    changed_ = changed_ || rests != resting_[thread];
    resting_[thread] = rests;
    if (gone(thread)) continue;
    any = true;
    still = still && rests;
  }
  return still && any;
}

bool Stillness::rest_still(const WakeWord* words, const std::vector<std::uint32_t>& threads) const {
  return std::ranges::all_of(threads, [&](std::uint32_t one) { return words[one].rest() == rests_[one]; });
}

}  // namespace tessera
