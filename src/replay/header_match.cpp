#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "replay/source.hpp"

namespace tessera::replay {

namespace {

using Subsystem = net::Parts::Subsystem;

class HeaderMatch {
 public:
  HeaderMatch(const Recording& recording, const net::Net& net)
      : recording_(recording), net_(net), parts_(net.parts()) {}

  [[nodiscard]] std::optional<Problem> judge() const {
    if (!parts_.subsystems.empty())
      for (const auto check : {&HeaderMatch::subsystems, &HeaderMatch::behaviours, &HeaderMatch::channels,
                               &HeaderMatch::buffers, &HeaderMatch::bodies})
        if (std::optional<Problem> wrong = (this->*check)()) return wrong;
    return transitions();
  }

 private:
  using Outcome = std::optional<Problem>;
  static Outcome wrong(const char* what, const std::string& name) {
    return Problem{fmt::format("the net has no {} '{}'", what, name)};
  }
  static Outcome twice(const char* what, const std::string& name) {
    return Problem{fmt::format("the recording names the {} '{}' twice", what, name)};
  }

  [[nodiscard]] Outcome subsystems() const {
    std::unordered_set<std::string_view> known, named;
    for (const Subsystem& one : parts_.subsystems) known.insert(one.path);
    for (const std::string& instance : recording_.instances) {
      if (!known.contains(instance)) return wrong("subsystem", instance);
      if (!named.insert(instance).second) return twice("subsystem", instance);
    }
    return {};
  }

  [[nodiscard]] Outcome behaviours() const {
    std::unordered_map<std::string_view, const Subsystem*> known;
    for (const Subsystem& one : parts_.subsystems) known.emplace(one.path, &one);
    for (std::size_t index = 0; index < recording_.behaviours.size(); ++index) {
      if (index >= recording_.instances.size())
        return Problem{"the recording has behaviours of no subsystem"};
      const Subsystem& owner = *known.at(recording_.instances[index]);
      const std::unordered_set<std::string_view> its(owner.behaviours.begin(), owner.behaviours.end());
      for (const std::string& behaviour : recording_.behaviours[index])
        if (!its.contains(behaviour)) return wrong("behaviour", owner.path + '.' + behaviour);
    }
    return {};
  }

  [[nodiscard]] Outcome channels() const {
    const std::unordered_set<std::string_view> known(parts_.channels.begin(), parts_.channels.end());
    for (const auto* list : {&recording_.channels, &recording_.networked})
      for (const std::string& channel : *list)
        if (!known.contains(channel)) return wrong("channel", channel);
    return {};
  }

  [[nodiscard]] Outcome buffers() const {
    for (const Recording::Buffer& buffer : recording_.buffers)
      if (buffer.instance >= recording_.instances.size() ||
          !buffer.path.starts_with(recording_.instances[buffer.instance] + '.'))
        return Problem{
            fmt::format("the recording names the buffer '{}', which is none of its subsystem", buffer.path)};
    return {};
  }

  [[nodiscard]] Outcome bodies() const {
    if (!recording_.scene) return {};
    const std::unordered_set<std::string_view> agents(parts_.agents.begin(), parts_.agents.end());
    for (const Recording::Scene::Body& body : recording_.scene->bodies)
      if (!body.agent.empty() && !agents.contains(body.agent)) return wrong("agent", body.agent);
    return {};
  }

  [[nodiscard]] Outcome transitions() const {
    std::unordered_map<std::string_view, net::TransitionId> known;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      known.emplace(net_.transitions()[index].name, net::TransitionId{index});
    std::unordered_set<std::string_view> named;
    for (const Recording::Transition& recorded : recording_.transitions) {
      const auto found = known.find(recorded.name);
      if (found == known.end()) return wrong("transition", recorded.name);
      if (!named.insert(recorded.name).second) return twice("transition", recorded.name);
      if (parts_.subsystems.empty()) continue;
      const net::SubsystemId owner = net_[found->second].subsystem;
      const std::string whose = owner.valid() ? parts_[owner].path : std::string();
      const std::string said =
          recorded.instance < recording_.instances.size() ? recording_.instances[recorded.instance] : "";
      if (said != whose)
        return Problem{fmt::format("the recording gives the transition '{}' to {}, but it is one of {}",
                                   recorded.name, said.empty() ? "the upper layers" : said,
                                   whose.empty() ? "the upper layers" : whose)};
    }
    return {};
  }

  const Recording& recording_;
  const net::Net& net_;
  const net::Parts& parts_;
};

}  // namespace

std::optional<Problem> header_mismatch(const Recording& recording, const net::Net& net) {
  return HeaderMatch(recording, net).judge();
}

}  // namespace tessera::replay
