#include "deployed_run.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "layers/models.hpp"
#include "net/token_game.hpp"

namespace tessera::replay {
namespace {

using net::ChannelId;
using net::TransitionId;

std::string last_word(const std::string& name) { return name.substr(name.rfind('.') + 1); }

bool has_place(const net::Net& net, ChannelId channel, const std::string& name) {
  return std::ranges::any_of(net.places(), [&](const net::Place& place) {
    return place.channel == channel && last_word(place.name) == name;
  });
}

/// The values of one channel between processes.
struct Values {
  std::uint32_t written = 0, last_read = 0, reading = 0, slot = 0;
  std::set<std::uint32_t> on_the_way;
};

/// The version that a firing carries, and the text of a change of the peer before it.
struct Noted {
  std::uint32_t version = 0;
  std::string peer;
};

class Walker {
 public:
  Walker(const Deployed& system, std::mt19937& random)
      : net_(system.net),
        processes_(system.processes),
        random_(random),
        marking_(net::initial_marking(net_)) {}

  /// Fires a random enabled transition. Returns false if there is none.
  bool step(TransitionId& fired, Noted& noted) {
    std::vector<std::uint32_t> enabled;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      if (net_.transitions()[index].condition.truth != net::Condition::Truth::never &&
          net::enabled(net_, {index}, marking_) && makes_sense({index}))
        enabled.push_back(index);
    if (enabled.empty()) return false;
    fired = {enabled[random_() % enabled.size()]};
    noted = note(fired);
    net::fire(net_, fired, marking_);
    return true;
  }

 private:
  [[nodiscard]] bool is_networked(ChannelId channel) const {
    return has_place(net_, channel, "idle") || has_place(net_, channel, "sent_memory");
  }
  [[nodiscard]] bool takes(TransitionId id, const std::string& place) const {
    return touches(id, place, true);
  }
  [[nodiscard]] bool gives(TransitionId id, const std::string& place) const {
    return touches(id, place, false);
  }
  [[nodiscard]] bool touches(TransitionId id, const std::string& place, bool before) const {
    return std::ranges::any_of(before ? net_.preset(id) : net_.postset(id), [&](const net::Arc& arc) {
      return net_[arc.place].fused() && last_word(net_[arc.place].name) == place;
    });
  }
  /// A number on the way that is newer than all that was read; older: not the newest.
  [[nodiscard]] std::uint32_t arriving(const Values& values, bool older) const {
    if (values.on_the_way.empty()) return 0;
    const std::uint32_t number = older ? *values.on_the_way.begin() : *values.on_the_way.rbegin();
    const std::uint32_t newest_taken = std::max({values.last_read, values.reading, values.slot});
    return number > newest_taken && (!older || values.on_the_way.size() > 1) ? number : 0;
  }
  /// The net counts the values that arrive only roughly.
  [[nodiscard]] bool makes_sense(TransitionId id) {
    const ChannelId channel = net_.channel_of(id);
    const std::string name = last_word(net_[id].name);
    if (net_[id].subsystem.valid() || !channel.valid()) return true;
    const Values& values = values_[channel.value];
    if (name == "deliver" || name == "replace") return arriving(values, false) != 0;
    return name != "older" || arriving(values, true) != 0;
  }

  /// `timeout` uses no place of its channel, and is one of four ends.
  [[nodiscard]] std::uint32_t given_up(TransitionId id) {
    if (!net_[id].block.valid() || last_word(net_[id].name) != "timeout") return 0;
    return values_[net_.parts()[net_[id].block].channel.value].written;
  }

  Noted note(TransitionId id) {
    const ChannelId channel = net_.channel_of(id);
    if (!channel.valid()) return {given_up(id), {}};
    if (!is_networked(channel)) return {++versions_[channel.value], {}};
    Values& values = values_[channel.value];
    const std::string name = last_word(net_[id].name);
    if (!net_[id].subsystem.valid()) return move(values, name), Noted{};
    return net_.parts()[net_[id].block].sends ? note_send(id, channel, values, name)
                                              : note_receive(id, channel, values);
  }

  static void move(Values& values, const std::string& name) {
    if (name == "lost") {
      while (values.on_the_way.size() > 1) values.on_the_way.erase(values.on_the_way.begin());
    } else if (name == "older") {
      values.slot = *values.on_the_way.begin();
      values.on_the_way.erase(values.on_the_way.begin());
    } else {
      values.slot = *values.on_the_way.rbegin();
      values.on_the_way.clear();
    }
  }

  Noted note_send(TransitionId id, ChannelId channel, Values& values, const std::string& name) {
    if (takes(id, "sent_memory")) return {values.written + 1, {}};
    if (gives(id, "sent_memory")) return {++values.written, {}};
    if (name.starts_with("t2")) {
      values.on_the_way.insert(++values.written);
      return {values.written, {}};
    }
    if (name.starts_with("withdraw")) values.on_the_way.erase(values.written);
    if (name == "recall") values.slot = 0;
    return {values.written, name == "t3" ? peer_text(channel, true) : ""};
  }

  Noted note_receive(TransitionId id, ChannelId channel, Values& values) {
    if (takes(id, "received_memory")) {
      // Any value that has been written, but none older than the last.
      if (values.written > values.last_read && random_() % 2 == 0)
        values.last_read += 1 + static_cast<std::uint32_t>(random_() % (values.written - values.last_read));
      return {values.last_read, values.last_read > 0 ? peer_text(channel, false) : ""};
    }
    if (gives(id, "received_memory")) return {values.last_read, {}};
    if (takes(id, "full")) {
      values.reading = std::exchange(values.slot, 0);
      return {values.reading, peer_text(channel, false)};
    }
    if (takes(id, "empty")) return {};
    values.last_read = std::exchange(values.reading, 0);
    return {values.last_read, {}};
  }

  /// Only before the first.
  std::string peer_text(ChannelId channel, bool of_sender) {
    if (!told_.insert({channel.value, of_sender}).second) return {};
    for (const net::Parts::Block& block : net_.parts().blocks)
      if (block.channel == channel && block.sends != of_sender)
        return net_.parts()[channel] + "\n" +
               std::to_string(1 + processes_.of_agents[net_.parts()[block.subsystem].agent].value);
    throw std::logic_error("a channel without an end");
  }

  const net::Net& net_;
  const ProcessMap& processes_;
  std::mt19937& random_;
  net::Marking marking_;
  std::map<std::uint32_t, Values> values_;
  std::map<std::uint32_t, std::uint32_t> versions_;
  std::set<std::pair<std::uint32_t, bool>> told_;
};

Recording header_of(const Deployed& system) {
  Recording recording;
  recording.clock = "steady";
  recording.processes = system.processes.names;
  for (const net::Parts::Subsystem& subsystem : system.net.parts().subsystems)
    recording.instances.push_back(subsystem.path);
  for (const net::Transition& transition : system.net.transitions())
    recording.transitions.push_back(
        {transition.name, transition.subsystem.valid() ? transition.subsystem.value : system_instance});
  return recording;
}

/// The sender cannot know which of these happened; a recording names any.
TransitionId any_of_group(const net::Net& net, TransitionId id, std::mt19937& random) {
  static const std::vector<std::vector<std::string>> groups{{"t2", "t2n", "t2m"},
                                                            {"timeout", "withdraw", "withdraw_m", "recall"}};
  const std::string& name = net[id].name;
  const std::string word = last_word(name), page = name.substr(0, name.size() - word.size());
  for (const std::vector<std::string>& group : groups) {
    if (std::ranges::find(group, word) == group.end()) continue;
    const std::string wanted = page + group[random() % group.size()];
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (net.transitions()[index].name == wanted) return {index};
  }
  return id;
}

}  // namespace

Deployed each_apart(spec::Model model) {
  spec::Deployment deployment;
  ProcessMap processes;
  for (const spec::AgentId agent : model.agents.ids()) {
    const spec::ProcessId process = deployment.processes.next_id();
    deployment.processes.push_back({.name = "p" + std::to_string(process.value), .agents = {agent}});
    model.agents[agent].process = process;
    processes.names.push_back(deployment.processes.back().name);
    processes.of_agents.push_back(process);
  }
  model.deployment = std::move(deployment);
  net::Net net = test::build(model).net;
  return {std::move(model), std::move(net), std::move(processes)};
}

std::vector<Recording> deployed_run(const Deployed& system, std::size_t firings, std::mt19937& random) {
  std::vector<Recording> recordings(system.processes.names.size(), header_of(system));
  for (std::uint32_t process = 0; process < recordings.size(); ++process)
    recordings[process].process = Recording::OneProcess{
        .name = system.processes.names[process], .number = process, .incarnation = 1 + process};
  Walker walker(system, random);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> sequences;
  TransitionId fired;
  Noted noted;
  for (std::size_t step = 0; step < firings && walker.step(fired, noted); ++step) {
    const net::Transition& transition = system.net[fired];
    if (!transition.agent.valid()) continue;  // of the system, or of a medium
    const std::uint32_t process = system.processes.of_agents[transition.agent].value;
    const std::uint32_t instance =
        transition.subsystem.valid() ? transition.subsystem.value : system_instance;
    const auto add = [&](Event::Kind kind, std::uint32_t subject, std::uint32_t version, std::string text) {
      Event event{.time_ns = static_cast<std::int64_t>(step) * 1000, .subject = subject, .version = version};
      event.sequence = sequences[{process, instance}]++;
      event.origin = instance << 8 | static_cast<std::uint32_t>(kind);
      recordings[process].entries.push_back({event, std::move(text)});
    };
    if (!noted.peer.empty())
      add(Event::Kind::peer, static_cast<std::uint32_t>(noted.peer.size()), 0, noted.peer);
    const TransitionId named = any_of_group(system.net, fired, random);
    const bool has_number = system.net.channel_of(named).valid();
    add(Event::Kind::firing, named.value, has_number ? noted.version : 0, {});
  }
  return recordings;
}

Recording simulated_run(const Deployed& system, std::size_t firings, std::mt19937& random) {
  Recording recording = header_of(system);
  recording.clock = "simulated";
  Walker walker(system, random);
  std::map<std::uint32_t, std::uint32_t> sequences;
  TransitionId fired;
  Noted noted;
  for (std::size_t step = 0; step < firings && walker.step(fired, noted); ++step) {
    const net::Transition& transition = system.net[fired];
    if (is_of_medium(transition.role)) continue;
    const TransitionId named = any_of_group(system.net, fired, random);
    Event event{.time_ns = static_cast<std::int64_t>(step) * 1000, .subject = named.value};
    event.version = system.net.channel_of(named).valid() ? noted.version : 0;
    const std::uint32_t instance =
        transition.subsystem.valid() ? transition.subsystem.value : system_instance;
    event.sequence = sequences[instance]++;
    event.origin = instance << 8 | static_cast<std::uint32_t>(Event::Kind::firing);
    recording.entries.push_back({event, {}});
  }
  return recording;
}

}  // namespace tessera::replay
