#include "firing_oracle.hpp"

#include <deque>
#include <map>

#include "nets/flat_net.hpp"

namespace tessera::testing {
namespace {

class Play {
 public:
  Play(const Recording& recording, const System& system) : recording_(recording), net_(net_of(system)) {
    for (const FlatNet::FlatPlace& place : net_.places) marking_.push_back(place.tokens);
    for (const FlatNet::FlatTransition& transition : net_.transitions)
      channels_.push_back(channel_of(transition, system));
  }

  std::string complaint() {
    if (recording_.transitions.size() != net_.transitions.size()) return "other transitions";
    for (std::size_t index = 0; index < net_.transitions.size(); ++index)
      if (recording_.transitions[index].name != net_.transitions[index].name)
        return "other names of transitions";
    return recording_.clock == "simulated" ? play_as_written() : play_merged();
  }

 private:
  /// The channel a transition touches, by name; "": none.
  [[nodiscard]] std::string channel_of(const FlatNet::FlatTransition& transition,
                                       const System& system) const {
    for (const auto* ends : {&transition.inputs, &transition.outputs})
      for (const std::uint32_t place : *ends)
        for (const Channel& channel : system.channels)
          if (net_.places[place].name.starts_with(std::string(channel.name) + '.'))
            return std::string(channel.name);
    return "";
  }

  [[nodiscard]] bool may_fire(const Event& event) {
    const std::string& channel = channels_[event.subject];
    if ((event.version != 0) != !channel.empty()) return false;
    if (!channel.empty() && event.version != versions_[channel] + 1) return false;
    for (const std::uint32_t place : net_.transitions[event.subject].inputs)
      if (marking_[place] != 1) return false;
    return true;
  }

  [[nodiscard]] std::string fire(const Event& event) {
    const FlatNet::FlatTransition& transition = net_.transitions[event.subject];
    if (!channels_[event.subject].empty()) versions_[channels_[event.subject]] = event.version;
    for (const std::uint32_t place : transition.inputs) --marking_[place];
    for (const std::uint32_t place : transition.outputs)
      if (++marking_[place] > 1) return "two tokens in " + net_.places[place].name;
    return "";
  }

  std::string play_as_written() {
    std::int64_t last = 0;
    for (const Recording::Entry& entry : recording_.entries) {
      if (entry.event.kind() != Event::Kind::firing) continue;
      if (!may_fire(entry.event)) return net_.transitions[entry.event.subject].name + " was not enabled";
      if (entry.event.time_ns < last) return "time goes back";
      last = entry.event.time_ns;
      if (std::string wrong = fire(entry.event); !wrong.empty()) return wrong;
    }
    return "";
  }

  std::string play_merged() {
    std::map<std::uint32_t, std::deque<Event>> lanes;
    for (const Recording::Entry& entry : recording_.entries)
      if (entry.event.kind() == Event::Kind::firing) lanes[entry.event.instance()].push_back(entry.event);
    for (bool progress = true; progress;) {
      progress = false;
      for (auto& [instance, lane] : lanes) {
        while (!lane.empty() && may_fire(lane.front())) {
          if (std::string wrong = fire(lane.front()); !wrong.empty()) return wrong;
          lane.pop_front();
          progress = true;
        }
      }
    }
    for (const auto& [instance, lane] : lanes)
      if (!lane.empty()) return net_.transitions[lane.front().subject].name + " was never enabled";
    return "";
  }

  const Recording& recording_;
  FlatNet net_;
  std::vector<std::uint32_t> marking_;
  std::vector<std::string> channels_;
  std::map<std::string, std::uint32_t> versions_;
};

}  // namespace

std::string complaint_about(const Recording& recording, const System& system) {
  return Play(recording, system).complaint();
}

}  // namespace tessera::testing
