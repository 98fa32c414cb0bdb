#include "spec/devices/writers.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "diagnostics/utf8.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* loopback = "lo";

class WriterCheck {
 public:
  WriterCheck(const Model& model, Diagnostics& out) : model_(model), out_(out) {}

  void run() {
    for (const Driver& driver : model_.drivers) {
      if (model_.subsystem(driver.instance).kind != SubsystemKind::effector || driver.targets.empty())
        continue;
      if (driver.kind == "ros2") judge_topic(driver);
      if (driver.kind == "cpp") judge_port(driver);
    }
  }

 private:
  void judge_topic(const Driver& driver) {
    const std::string role = text_of(driver, "role");
    if (role == "client") return;  // a service may have many
    std::string error;
    const std::string topic = ros2::full_topic_name(driver.target(), error);
    if (topic.empty()) return;                           // which is said elsewhere
    const std::string frame = text_of(driver, "frame");  // of a transform: many may publish the topic
    const Driver* const first = first_of(role + topic + " " + frame + " " + network_of(driver), driver);
    if (first == nullptr) return;
    const Span& place = driver.targets.front().span;
    const std::string both = model_.driver_path(*first) + " and " + model_.driver_path(driver);
    const std::string name = in_quotes(driver.target());
    if (!role.empty()) {
      if (is_new(*first, driver)) complain_of_servers(place, name + ": " + both, *first, driver);
      return;
    }
    if (!is_new(*first, driver)) return;
    if (!frame.empty())
      out_.warning(
          "W338", place, "two effectors broadcast the frame " + in_quotes(frame) + ": " + both,
          "others take both in turn; " +
              (one_fleet(*first, driver) ? std::string("{i} is the number of the agent: robot{i}/") + frame
                                         : "let one subsystem do it for both"));
    else
      out_.warning("W338", place, "two effectors publish " + name + ": " + both,
                   "whoever subscribes obeys both in turn; " + remedy(*first, driver, "topic"));
  }

  void complain_of_servers(const Span& place, const std::string& which, const Driver& first,
                           const Driver& second) {
    const bool action = ros2::is_action_type(text_of(second, "type"));
    const char* const what = action ? "action" : "service";
    out_.error("E319", place, std::string("two servers of the ") + what + " " + which,
               std::string("both would execute every ") + (action ? "goal" : "request") + "; " +
                   remedy(first, second, what));
  }

  void judge_port(const Driver& driver) {
    static constexpr std::array names{"port", "device"};
    const auto* const port =
        std::ranges::find_if(names, [&](const char* name) { return !text_of(driver, name).empty(); });
    if (port == names.end()) return;
    std::string key = driver.target() + " " + process_of(driver);
    for (const auto& [name, option] : driver.options) key += "\n" + name + "=" + identity_of(option);
    const Driver* const first = first_of(key, driver);
    if (first == nullptr || !is_new(*first, driver)) return;
    const auto place = driver.option_spans.find(*port);
    out_.warning("W339", place == driver.option_spans.end() ? driver.span : place->second,
                 model_.driver_path(*first) + " and " + model_.driver_path(driver) + " have the same " +
                     *port + " " + in_quotes(text_of(driver, *port)) + " and the same other options",
                 std::string("a device has one writer; ") +
                     (one_fleet(*first, driver) ? "{i} in a text is the number of the agent"
                                                : "give each its own, or an option that tells them apart"));
  }

  /// The driver that has the same sink, if there is one before this.
  const Driver* first_of(const std::string& sink, const Driver& driver) {
    const auto [first, added] = first_.emplace(sink, &driver);
    return added ? nullptr : first->second;
  }

  /// One message for two entries of the file, or for one entry of a fleet.
  bool is_new(const Driver& first, const Driver& second) {
    return said_.insert({first.span, second.span}).second;
  }

  [[nodiscard]] bool one_fleet(const Driver& first, const Driver& second) const {
    const FleetId fleet = model_.agents[model_.instances[first.instance].agent].fleet;
    return fleet.valid() && fleet == model_.agents[model_.instances[second.instance].agent].fleet;
  }

  [[nodiscard]] std::string remedy(const Driver& first, const Driver& second, const char* what) const {
    return one_fleet(first, second)
               ? std::string("{i} is the number of the agent: /robot{i}/NAME is a ") + what + " of each"
               : std::string("give each a ") + what + " of its own, or let one subsystem do it for both";
  }

  static std::string text_of(const Driver& driver, const std::string& name) {
    const auto found = driver.options.find(name);
    const auto* const text =
        found == driver.options.end() ? nullptr : std::get_if<std::string>(&found->second.value);
    return text == nullptr ? "" : *text;
  }

  static std::string identity_of(const DriverOption& option) {
    if (const auto* const text = std::get_if<std::string>(&option.value)) return *text;
    if (const auto* const number = std::get_if<double>(&option.value))
      return std::to_string(*number) + option.unit;
    return std::get<bool>(option.value) ? "true" : "false";
  }

  [[nodiscard]] const Process* deployed(const Driver& driver) const {
    if (!model_.deployment) return nullptr;
    const ProcessId process = model_.agents[model_.instances[driver.instance].agent].process;
    return model_.deployment->processes.has(process) ? &model_.deployment->processes[process] : nullptr;
  }

  [[nodiscard]] std::string process_of(const Driver& driver) const {
    const Process* const process = deployed(driver);
    return process == nullptr ? "" : process->name;
  }

  /// The domain and the interface. Each machine has a loopback of its own.
  [[nodiscard]] std::string network_of(const Driver& driver) const {
    const auto domain = driver.options.find("domain");
    std::string network = domain == driver.options.end() ? "0.000000" : identity_of(domain->second);
    const std::string interface = text_of(driver, "interface");
    if (!interface.empty() && interface != loopback) return network + " " + interface;
    const Process* const process = deployed(driver);
    return network + " " + loopback + (process == nullptr ? "" : " of " + process->host);
  }

  const Model& model_;
  Diagnostics& out_;
  std::map<std::string, const Driver*> first_;  ///< by sink
  std::set<std::pair<Span, Span>> said_;
};

}  // namespace

void check_writers(const Model& model, Diagnostics& out) { WriterCheck(model, out).run(); }

}  // namespace tessera::spec
