#include "project/service_units.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

constexpr const char* first_line = "# Made by Tessera; a changed copy belongs somewhere else.";

constexpr const char* unit_text = R"({first_line}
[Unit]
Description={description}
{after}
[Service]
# Started when all devices are open and the first function may run.
Type=notify
{library}ExecStart=/opt/{system}/controller run{process} --record /var/lib/{system}/{unit}.tsr --record-limit 500MB
StateDirectory={system}
{user}# A subsystem that stalls for so long ends the service (with `watchdog` in the specification).
WatchdogSec=2
TimeoutStopSec=10
# A robot that drives on by itself after a crash surprises people. With `on-failure` the process begins again
# with lost memory, and the others find it again (docs/use/fleets.md).
Restart=no
# The guardian of the controller gets SIGTERM too, ignores it, and ends with the controller.
KillMode=control-group
AmbientCapabilities=CAP_SYS_NICE CAP_IPC_LOCK
ProtectSystem=strict

[Install]
WantedBy=multi-user.target
)";

std::string filled(std::string text, const std::vector<std::pair<std::string, std::string>>& values) {
  for (const auto& [name, value] : values)
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size())
      text.replace(at, name.size(), value);
  return text;
}

/// Names of users have small letters, and no more than 31 of them.
std::string user_name(const std::string& system) {
  constexpr std::size_t longest = 31;
  std::string name = "tessera-";
  for (const char one : system) name += static_cast<char>(std::tolower(static_cast<unsigned char>(one)));
  return name.substr(0, longest);
}

/// The user of the unit, if it is not root.
std::string user_lines(const std::string& system, const ServiceOptions& options) {
  if (!options.own_user) return "";
  std::string lines =
      "# A user of its own, which all units of the system share while they run. `User=root` in place of "
      "both\n"
      "# lines if a driver needs more than groups.\n"
      "DynamicUser=yes\nUser=" +
      user_name(system) +
      "\n# Of the control sockets: `sudo env XDG_RUNTIME_DIR=/run/{system} tessera emergency-stop`.\n"
      "RuntimeDirectory={system}\nRuntimeDirectoryMode=0700\nRuntimeDirectoryPreserve=yes\n"
      "Environment=XDG_RUNTIME_DIR=/run/{system}\n";
  if (!options.groups.empty()) {
    lines += "# Who may open the devices.\nSupplementaryGroups=";
    for (const std::string& group : options.groups)
      lines += group + (&group == &options.groups.back() ? "\n" : " ");
  }
  return lines;
}

ServiceUnit unit_of(const std::string& system, const spec::Process* process, const ServiceOptions& given) {
  const std::string plain = plain_name(system);
  const std::string unit = process == nullptr ? plain : plain + "-" + plain_name(process->name);
  std::string options = process == nullptr ? "" : fmt::format(" --process \"{}\"", process->name);
  if (given.parameters) options += " --parameters /opt/{system}/parameters";
  const std::string description = process == nullptr ? system : process->name + " of " + system;
  const std::string after = process == nullptr
                                ? ""
                                : "# The other processes are found over the "
                                  "network.\nAfter=network-online.target\nWants=network-online.target\n";
  std::string library = process == nullptr ? "" : "# With libtessera_dds.so beside the controller.\n";
  if (given.own_libraries) library += "Environment=LD_LIBRARY_PATH=/opt/{system}\n";
  return {.host = process == nullptr ? "" : process->host,
          .file = unit + ".service",
          .text = filled(unit_text, {{"{first_line}", first_line},
                                     {"{description}", description},
                                     {"{after}", after},
                                     {"{process}", options},
                                     {"{library}", library},
                                     {"{user}", user_lines(plain, given)},
                                     {"{unit}", unit},
                                     {"{system}", plain}})};
}

void write_unit(const fs::path& file, const std::string& text) {
  if (std::ifstream there(file); there) {
    std::string line;
    if (!std::getline(there, line) || line != first_line)
      throw std::runtime_error(file.string() + " is there, and Tessera has not written it");
  }
  fs::create_directories(file.parent_path());
  std::ofstream stream(file);
  stream << text << std::flush;
  if (!stream) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char one : name) {
    const bool fits = std::isalnum(static_cast<unsigned char>(one)) != 0 || one == '_' || one == '-';
    if (fits || (!plain.empty() && plain.back() != '-' && one != ']')) plain += fits ? one : '-';
  }
  return plain;
}

std::vector<ServiceUnit> service_units(const spec::Model& model, const ServiceOptions& options) {
  if (!model.deployment) return {unit_of(model.system, nullptr, options)};
  std::vector<ServiceUnit> units;
  for (const spec::Process& process : model.deployment->processes)
    units.push_back(unit_of(model.system, &process, options));
  return units;
}

std::vector<std::string> write_service_units(const spec::Model& model, const std::string& folder) {
  const std::vector<ServiceUnit> units = service_units(model);
  std::set<std::string> hosts;
  for (const ServiceUnit& unit : units) hosts.insert(unit.host);
  std::vector<std::string> written;
  for (const ServiceUnit& unit : units) {
    const std::string host = unit.host.empty() ? "any" : unit.host;
    const fs::path file = (hosts.size() > 1 ? fs::path(folder) / host : fs::path(folder)) / unit.file;
    write_unit(file, unit.text);
    written.push_back(file.string());
  }
  return written;
}

}  // namespace tessera::project
