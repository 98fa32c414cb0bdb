#include "project/files/ros2_services.hpp"

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "project/files/ros2_messages.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::project {
namespace {

/// The drivers of one client or server.
struct Sides {
  const spec::Driver* receptor = nullptr;
  const spec::Driver* effector = nullptr;
};

/// Whether the C++ initialiser of a safe command gives the field `call` another number than 0.
bool has_a_call(std::string_view safe) {
  constexpr std::string_view name = ".call";
  int depth = 0;
  for (std::size_t at = 0; at < safe.size(); ++at) {
    if (safe[at] == '{') ++depth;
    if (safe[at] == '}') --depth;
    if (depth != 0 || !safe.substr(at).starts_with(name)) continue;
    const std::string_view rest = safe.substr(at + name.size());
    const std::size_t digit = rest.find_first_of("0123456789.");
    const bool is_it = !rest.empty() && (rest[0] == ' ' || rest[0] == '{');
    if (is_it) return digit != std::string_view::npos && rest[digit] >= '1' && rest[digit] <= '9';
  }
  return false;
}

class ServiceCheck {
 public:
  ServiceCheck(const spec::Model& model, diagnostics::Diagnostics& out) : model_(model), out_(out) {}

  bool run(const std::vector<spec::Driver>& drivers) {
    for (const spec::Driver& driver : drivers)
      if (driver.kind == "ros2" && has_role(driver)) add(driver);
    for (const auto& [name, sides] : services_) check(std::get<2>(name) == "client", sides);
    return good_;
  }

 private:
  /// Agent, service and role.
  using Name = std::tuple<spec::AgentId, std::string, std::string>;

  void complain(const diagnostics::Span& place, const std::string& text, const std::string& hint,
                const char* code = "E322") {
    good_ = false;
    if (said_.insert({place, text}).second) out_.error(code, place, text, hint);
  }

  /// The guardian process does not know the goal that would be under way.
  void check_safe_command(const spec::Driver& driver) {
    const spec::Subsystem& subsystem = model_.subsystem(driver.instance);
    if (driver.real.valid() && subsystem.safe.has(driver.real) && has_a_call(subsystem.safe[driver.real]))
      complain(driver.span, "the safe command of " + subsystem.real[driver.real].name + " orders a goal",
               "leave its `call` at 0, which cancels the goal that is under way", "E371");
  }

  void add(const spec::Driver& driver) {
    const std::string role = text_option(driver, "role");
    std::string ignored;
    Sides& sides = services_[{model_.instances[driver.instance].agent,
                              ros2::full_topic_name(driver.target(), ignored), role}];
    const bool effects = is_effector(model_, driver);
    if (effects && is_action(driver) && role == "client") check_safe_command(driver);
    const spec::Driver*& side = effects ? sides.effector : sides.receptor;
    if (side == nullptr)
      side = &driver;
    else
      complain(driver.span,
               std::string("a second ") + (effects ? "effector" : "receptor") + " of the " + role + " of '" +
                   driver.target() + "'",
               "the first is on " + out_.words(side->span) +
                   "; an agent has one client and one server of a service or action");
  }

  void check(bool client, const Sides& sides) {
    if (sides.effector == nullptr)
      return complain(sides.receptor->span,
                      is_action(*sides.receptor)
                          ? (client ? "a client without an effector that orders the goals"
                                    : "a server without an effector that says what becomes of the goals")
                          : (client ? "a client without an effector that sends the requests"
                                    : "a server without an effector that sends the replies"),
                      "give an effector of the agent a driver with the same `ros2`, `type` and `role`");
    if (sides.receptor == nullptr) {
      if (!client)
        complain(sides.effector->span,
                 is_action(*sides.effector) ? "a server without a receptor that gets the goals"
                                            : "a server without a receptor that gets the requests",
                 "give a receptor of the agent a driver with the same `ros2`, `type` and `role`");
      return;
    }
    for (const char* option : {"type", "node", "domain", "interface", "peers", "timeout"})
      compare(*sides.receptor, *sides.effector, option);
  }

  /// A time may stand at one of them.
  void compare(const spec::Driver& one, const spec::Driver& other, const std::string& option) {
    const auto first = one.options.find(option), second = other.options.find(option);
    const bool in_first = first != one.options.end(), in_second = second != other.options.end();
    if (option == "timeout" && !(in_first && in_second)) return;
    if (in_first == in_second && (!in_first || first->second == second->second)) return;
    const spec::Driver& named = in_second ? other : one;
    const spec::Driver& partner = in_second ? one : other;
    const auto place = named.option_spans.find(option);
    complain(place == named.option_spans.end() ? named.span : place->second,
             "'" + option + "' differs from that on " + out_.words(partner.span),
             "both drivers are one " + text_option(named, "role") + " of the " +
                 (is_action(named) ? "action" : "service"));
  }

  const spec::Model& model_;
  diagnostics::Diagnostics& out_;
  std::map<Name, Sides> services_;
  std::set<std::pair<diagnostics::Span, std::string>> said_;  ///< once for a fleet
  bool good_ = true;
};

}  // namespace

bool check_services(const spec::Model& model, const std::vector<spec::Driver>& drivers,
                    diagnostics::Diagnostics& out) {
  return ServiceCheck(model, out).run(drivers);
}

}  // namespace tessera::project
