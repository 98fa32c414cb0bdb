#include "watch/stuck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "system/console.hpp"

namespace tessera {
namespace {

constexpr Duration patience = std::chrono::seconds(1);

using Lack = SubsystemExecutor::Lack;

[[nodiscard]] const std::vector<PortLink>& ports_of(const Assembly& assembly, std::uint32_t instance) {
  return assembly.executors[instance]->operations().parts().ports;
}

/// Finds the largest set of subsystems that no subsystem outside the set can free.
class Search {
 public:
  explicit Search(const Assembly& assembly)
      : assembly_(assembly), lacks_(assembly.executors.size()), gives_(assembly.executors.size()) {
    for (std::uint32_t instance = 0; instance < lacks_.size(); ++instance)
      if (!assembly.control.has_ended(instance)) lacks_[instance] = assembly.executors[instance]->lacks();
  }

  std::vector<std::uint32_t> result() {
    for (bool freed = true; freed;) {
      freed = false;
      std::fill(gives_.begin(), gives_.end(), std::nullopt);
      for (std::uint32_t instance = 0; instance < lacks_.size(); ++instance)
        if (stuck(instance) && can_be_freed(instance)) {
          lacks_[instance].reset();
          freed = true;
        }
    }
    std::vector<std::uint32_t> all;
    for (std::uint32_t instance = 0; instance < lacks_.size(); ++instance)
      if (stuck(instance)) all.push_back(instance);
    return all;
  }

 private:
  [[nodiscard]] bool stuck(std::uint32_t instance) const { return lacks_[instance].has_value(); }
  [[nodiscard]] bool silent(InstanceId instance) const {
    return !instance.valid() || stuck(instance.value) || assembly_.control.has_ended(instance.value);
  }

  [[nodiscard]] bool can_be_freed(std::uint32_t instance) {
    return std::ranges::any_of(*lacks_[instance], [&](const Lack& lack) {
      const PortLink& port = ports_of(assembly_, instance)[lack.port];
      if (port.end != nullptr) return true;  // the state of another process is not known here
      return !silent(port.peer) && (lack.tokens & ~given_by(port.peer.value, port.channel)) == 0;
    });
  }

  /// The tokens that `giver` may give to `channel` from its current state.
  [[nodiscard]] std::uint16_t given_by(std::uint32_t giver, const SharedChannel* channel) {
    const std::vector<PortLink>& ports = ports_of(assembly_, giver);
    if (!gives_[giver]) {
      std::vector<bool> helped(ports.size());
      for (std::size_t port = 0; port < ports.size(); ++port) helped[port] = !silent(ports[port].peer);
      gives_[giver] = assembly_.executors[giver]->may_give(helped);
    }
    for (std::size_t port = 0; port < ports.size(); ++port)
      if (ports[port].channel == channel) return (*gives_[giver])[port];
    return 0;
  }

  const Assembly& assembly_;
  std::vector<std::optional<std::vector<Lack>>> lacks_;           // per instance; nullopt: not stuck
  std::vector<std::optional<std::vector<std::uint16_t>>> gives_;  // per instance and port; nullopt: not asked
};

}  // namespace

std::vector<std::uint32_t> stuck_for_good(const Assembly& assembly) { return Search(assembly).result(); }

std::vector<std::uint32_t> stuck_among_resting(const Assembly& assembly, const std::vector<bool>& resting) {
  std::vector<bool> stuck = resting;
  const auto can_be_freed = [&](std::uint32_t instance) {
    bool waits = false;
    for (const PortLink& port : ports_of(assembly, instance)) {
      const SharedChannel::Waiting waiting = port.channel->waiting(port.side);
      if (waiting == SharedChannel::Waiting::no) continue;
      waits = true;
      if (waiting == SharedChannel::Waiting::may_take || port.end != nullptr) return true;
      if (port.peer.valid() && !stuck[port.peer.value] && !assembly.control.has_ended(port.peer.value))
        return true;
    }
    return !waits;
  };
  for (bool freed = true; freed;) {
    freed = false;
    for (std::uint32_t instance = 0; instance < stuck.size(); ++instance)
      if (stuck[instance] && can_be_freed(instance)) {
        stuck[instance] = false;
        freed = true;
      }
  }
  std::vector<std::uint32_t> all;
  for (std::uint32_t instance = 0; instance < stuck.size(); ++instance)
    if (stuck[instance]) all.push_back(instance);
  return all;
}

std::string stuck_text(const Assembly& assembly, const std::vector<std::uint32_t>& stuck) {
  constexpr std::size_t shown = 8;
  std::string text;
  for (std::size_t at = 0; at < stuck.size() && at < shown; ++at) {
    const SubsystemExecutor& executor = *assembly.executors[stuck[at]];
    text += fmt::format("{}{} (since {:.3f} s)", at == 0 ? "stuck for good: " : "; ",
                        executor.whereabouts(assembly.system),
                        seconds(executor.waits_since().time_since_epoch()));
  }
  if (stuck.size() > shown) text += fmt::format("; and {} more", stuck.size() - shown);
  return text;
}

void StuckWatch::look(Assembly& assembly, Time now) {
  if (now < next_) return;
  next_ = now + patience;
  for (std::uint32_t instance = 0; instance < said_.size(); ++instance) {
    if (said_[instance] || assembly.control.has_ended(instance)) continue;
    if (assembly.executors[instance]->waits_since() > now - patience) continue;
    const std::vector<std::uint32_t> stuck = stuck_for_good(assembly);
    // A subsystem may wait for long and be freed in the end, so the check becomes less and less frequent.
    if (std::ranges::all_of(stuck, [&](std::uint32_t one) { return said_[one]; }))
      next_ = now + std::max(patience, now.time_since_epoch() / 4);
    return found(assembly, stuck, now, [&](std::uint32_t one) {
      Effectors& effectors = assembly.executors[one]->effectors();
      effectors.make_safe({SafeReason::Kind::stuck}, Effectors::Busy::leaves_out);
      effectors.record(assembly.recorder == nullptr ? nullptr : assembly.recorder->system_lane());
    });
  }
}

void StuckWatch::found(Assembly& assembly, const std::vector<std::uint32_t>& stuck, Time now,
                       const std::function<void(std::uint32_t)>& secure) {
  std::vector<std::uint32_t> news;
  for (const std::uint32_t instance : stuck) {
    if (!said_[instance]) news.push_back(instance);
    said_[instance] = true;
  }
  if (news.empty()) return;
  for (const std::uint32_t instance : news) secure(instance);
  const std::string text = stuck_text(assembly, news);
  if (assembly.recorder != nullptr)
    assembly.recorder->system_lane()->text(Event::Kind::log, now,
                                           static_cast<std::uint32_t>(LogLevel::warning), text);
  console::print(LogLevel::warning, now, "tessera", text);
}

}  // namespace tessera
