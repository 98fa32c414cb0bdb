#include "cli/world_drivers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace tessera::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Turns a name of the world into a name of a buffer: letters, digits, single underscores.
std::string buffer_name(const std::string& name, std::set<std::string>& taken) {
  std::string made;
  for (const char c : name) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (good || (!made.empty() && made.back() != '_')) made += good ? c : '_';
  }
  while (made.ends_with('_')) made.pop_back();
  if (made.empty() || std::isdigit(static_cast<unsigned char>(made[0])) != 0) made = "n" + made;
  std::string unique = made;
  for (int number = 2; !taken.insert(unique).second; ++number) unique = made + std::to_string(number);
  return unique;
}

/// Adds quotes where YAML would read the text in another way.
std::string yaml_text(const std::string& text) {
  const bool plain = !text.empty() && std::ranges::all_of(text, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/' || c == '-' || c == '.';
  }) && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
  return plain ? text : Json(text).dump();
}

/// "robot" for "robot[3]".
std::string fleet_of(const std::string& agent) { return agent.substr(0, agent.find('[')); }

/// One real buffer with its driver.
struct Line {
  std::string kind, target, type, options;
  bool operator==(const Line&) const = default;
};

/// A subsystem and the list of the world that its buffers come from.
struct Source {
  const char *subsystem, *list, *kind;
};
constexpr std::array sources = std::to_array<Source>({{"sensors", "sensors", "sensor"},
                                                      {"cameras", "cameras", "camera"},
                                                      {"joints", "joints", "joint_position"},
                                                      {"motors", "actuators", "actuator"}});

/// The buffers of one agent in one subsystem, in the order of the world.
using Lines = std::vector<Line>;

class DriversSection {
 public:
  DriversSection(const Json& contents, const std::vector<WorldAgent>& agents)
      : contents_(contents), agents_(agents) {
    for (const WorldAgent& agent : agents)
      if (agent.in_fleet) ++members_[fleet_of(agent.path)];
    for (const Source& source : sources) add(source);
  }

  [[nodiscard]] std::string text() const {
    return drivers_.empty() ? ""
                            : "simulation:\n  drivers:\n" + drivers_ +
                                  "# Real buffers of the subsystems that they serve:\n" + buffers_;
  }

 private:
  void add(const Source& source) {
    std::vector<std::pair<std::string, Lines>> of_agents;
    for (const Json& entry : contents_[source.list]) {
      if (text_in(entry, "kind").empty()) continue;
      const auto [agent, target] = placed(text_in(entry, "name"));
      if (agent.empty()) continue;
      auto found = std::ranges::find(of_agents, agent, &std::pair<std::string, Lines>::first);
      if (found == of_agents.end()) found = of_agents.insert(found, {agent, {}});
      std::string options;
      if (entry.contains("picture"))
        options = fmt::format(", width: {}, height: {}", entry["picture"][0].get<int>(),
                              entry["picture"][1].get<int>());
      found->second.push_back({source.kind, target, text_in(entry, "type"), options});
    }
    std::set<std::string> done;
    for (const auto& [agent, lines] : of_agents) {
      const std::string fleet = fleet_of(agent);
      const bool all = is_same_for_the_fleet(fleet, lines, of_agents);
      if (!all || done.insert(fleet).second) put(all ? fleet + "[*]" : agent, source, lines);
    }
  }

  /// The agent that owns an element, and the name by which its driver finds it. No agent: the element belongs
  /// to an object without an agent.
  [[nodiscard]] std::pair<std::string, std::string> placed(const std::string& name) const {
    if (agents_.empty()) return {"robot", name};
    const bool is_path = name.starts_with('/');  // in CoppeliaSim; such objects belong to no agent
    const std::size_t begin = is_path ? 1 : 0, slash = name.find('/', begin);
    if (slash == std::string::npos) return {agents_.front().path, name};
    const std::string instance = name.substr(begin, slash - begin);
    const bool is_agent = std::ranges::find(agents_, instance, &WorldAgent::path) != agents_.end();
    if (is_path && !is_agent) return {agents_.front().path, name};
    return {is_agent ? instance : "", name.substr(slash + 1)};
  }

  [[nodiscard]] bool is_same_for_the_fleet(
      const std::string& fleet, const Lines& lines,
      const std::vector<std::pair<std::string, Lines>>& of_agents) const {
    const auto members = members_.find(fleet);
    if (members == members_.end()) return false;
    const auto same = std::ranges::count_if(
        of_agents, [&](const auto& one) { return fleet_of(one.first) == fleet && one.second == lines; });
    return same == members->second;
  }

  void put(const std::string& agent, const Source& source, const Lines& lines) {
    std::set<std::string> taken;
    buffers_ += fmt::format("#   {}.{}, real:\n", agent, source.subsystem);
    for (const Line& line : lines) {
      const std::string buffer = buffer_name(line.target, taken);
      buffers_ += fmt::format("#     {}: {}\n", buffer, line.type);
      drivers_ += fmt::format("    {}.{}.{}: {{ {}: {}{} }}  # {}\n", agent, source.subsystem, buffer,
                              line.kind, yaml_text(line.target), line.options, line.type);
    }
  }

  const Json& contents_;
  const std::vector<WorldAgent>& agents_;
  std::map<std::string, std::ptrdiff_t> members_;  // of each fleet
  std::string drivers_, buffers_;
};

}  // namespace

std::string drivers_section(const Json& contents, const std::vector<WorldAgent>& agents) {
  return DriversSection(contents, agents).text();
}

}  // namespace tessera::cli
