#include "project/files/ros2_services.hpp"

#include <map>
#include <set>
#include <string>
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

class ServiceCheck {
 public:
  ServiceCheck(const spec::Model& model, diagnostics::Diagnostics& out) : model_(model), out_(out) {}

  bool run(const std::vector<spec::Driver>& drivers) {
    for (const spec::Driver& driver : drivers)
      if (driver.kind == "ros2" && is_service(driver)) add(driver);
    for (const auto& [name, sides] : services_) check(std::get<2>(name) == "client", sides);
    return good_;
  }

 private:
  /// Agent, service and role.
  using Name = std::tuple<spec::AgentId, std::string, std::string>;

  void complain(const diagnostics::Span& place, const std::string& text, const std::string& hint) {
    good_ = false;
    if (said_.insert({place, text}).second) out_.error("E322", place, text, hint);
  }

  void add(const spec::Driver& driver) {
    const std::string role = text_option(driver, "role");
    std::string ignored;
    Sides& sides = services_[{model_.instances[driver.instance].agent,
                              ros2::full_topic_name(driver.target(), ignored), role}];
    const bool effects = is_effector(model_, driver);
    const spec::Driver*& side = effects ? sides.effector : sides.receptor;
    if (side == nullptr)
      side = &driver;
    else
      complain(driver.span,
               std::string("a second ") + (effects ? "effector" : "receptor") + " of the " + role + " of '" +
                   driver.target() + "'",
               "the first is on " + out_.words(side->span) +
                   "; an agent has one client and one server of a service");
  }

  void check(bool client, const Sides& sides) {
    if (sides.effector == nullptr)
      return complain(sides.receptor->span,
                      client ? "a client without an effector that sends the requests"
                             : "a server without an effector that sends the replies",
                      "give an effector of the agent a driver with the same `ros2`, `type` and `role`");
    if (sides.receptor == nullptr) {
      if (!client)
        complain(sides.effector->span, "a server without a receptor that gets the requests",
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
             "both drivers are one " + text_option(named, "role") + " of the service");
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
