#include "project/deployed_run.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "project/files/file_names.hpp"
#include "project/files/installation.hpp"
#include "tessera/nearest.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

std::string machine_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "localhost";
  return name.data();
}

std::vector<std::string> names_between_commas(const std::string& list) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t comma = std::min(list.find(',', from), list.size());
    const std::size_t first = list.find_first_not_of(" \t", from);
    if (first < comma)
      names.push_back(list.substr(first, list.find_last_not_of(" \t", comma - 1) + 1 - first));
    from = comma + 1;
  }
  return names;
}

bool is_this_machine(const std::string& host, const std::string& machine) {
  const auto first_part = [](const std::string& name) { return name.substr(0, name.find('.')); };
  if (host.empty() || host == "localhost" || host == "127.0.0.1" || host == "::1" || host == machine)
    return true;
  // "cart" and "cart.local" are one machine; "cart.lab" and "cart.local" may be two.
  const bool one_is_short = host.find('.') == std::string::npos || machine.find('.') == std::string::npos;
  return one_is_short && first_part(host) == first_part(machine);
}

namespace {

/// "cart[*]" means all processes "cart[0]", "cart[1]", ...
bool is_meant(const std::string& process, const std::string& name) {
  if (!name.ends_with("[*]")) return process == name;
  const std::string fleet = name.substr(0, name.size() - 2);
  return process.starts_with(fleet) && process.ends_with(']');
}

std::string unknown_process(const spec::Deployment& deployment, const std::string& name) {
  std::vector<std::string> names;
  for (const spec::Process& process : deployment.processes) names.push_back(process.name);
  return with_hint("the deployment has no process '" + name + "'", did_you_mean(name, names));
}

}  // namespace

Placement placement_of(const spec::Deployment& deployment, const std::vector<std::string>& only,
                       const std::string& machine) {
  for (const std::string& name : only)
    if (std::ranges::none_of(deployment.processes,
                             [&](const spec::Process& process) { return is_meant(process.name, name); }))
      throw std::runtime_error(unknown_process(deployment, name));
  Placement placement;
  for (std::uint32_t number = 0; number < deployment.processes.size(); ++number) {
    const spec::Process& process = deployment.processes[number];
    const bool named =
        std::ranges::any_of(only, [&](const std::string& name) { return is_meant(process.name, name); });
    const bool local = is_this_machine(process.host, machine);
    if (only.empty() ? local : named)
      placement.here.push_back(number);
    else
      placement.elsewhere.push_back(number);
  }
  return placement;
}

ProcessFiles process_files(const fs::path& folder, const std::string& process, unsigned start) {
  const std::string name = "process-" + process + (start > 1 ? fmt::format("@{}", start) : "");
  return {folder / (name + ".tsr"), folder / (name + ".json"), folder / (name + ".txt")};
}

void add_process(Command& command, const std::string& process, const NetworkOptions& network) {
  command.insert(command.end(),
                 {"--process", process, "--carrier-library", Installation::find().carrier_library.string()});
  for (const auto& [option, value] :
       {std::pair("--domain", &network.domain), std::pair("--interface", &network.interface),
        std::pair("--peers", &network.peers)})
    if (!value->empty()) command.insert(command.end(), {option, *value});
}

Command process_command(const Controller& controller, const LaunchOptions& options,
                        const NetworkOptions& network, const std::string& process,
                        const ProcessFiles& files) {
  LaunchOptions own = options;
  own.record = files.recording.string();
  Command command = controller_command(controller, own, "run", /*simulated=*/false);
  const auto summary = std::ranges::find(command, "--summary");
  *std::next(summary) = files.summary.string();
  add_process(command, process, network);
  return with_death_note(std::move(command), files.note);
}

std::string command_elsewhere(const LaunchOptions& options, const std::string& host) {
  Command line{"tessera", "run", options.spec, "--deploy"};
  if (!options.duration.empty()) line.insert(line.end(), {"--for", options.duration});
  for (const std::string& value : options.set) line.insert(line.end(), {"--set", value});
  return fmt::format("{}: {}", host, shell_line(line));
}

DeploymentFile::DeploymentFile(fs::path file, const Controller& controller)
    : file_(std::move(file)),
      deployment_(*controller.specification.model.deployment),
      system_(controller.specification.model.system),
      net_hash_(controller.report.net_hash) {
  write();
}

void DeploymentFile::started(std::uint32_t process, unsigned start, pid_t pid) {
  all_.push_back({.process = process, .start = start, .pid = pid, .code = {}, .how = {}});
  write();
}

void DeploymentFile::ended(std::uint32_t process, const ProcessEnd& end, const std::string& how) {
  for (Started& one : all_)
    if (one.process == process && one.start == end.start) {
      one.code = end.exit.code;
      one.how = how;
    }
  write();
}

/// Written anew, beside, and put in its place, so that a reader never sees half of it.
void DeploymentFile::write() const {
  using nlohmann::json;
  json processes = json::array();
  for (std::uint32_t number = 0; number < deployment_.processes.size(); ++number) {
    const spec::Process& process = deployment_.processes[number];
    json starts = json::array();
    for (const Started& one : all_) {
      if (one.process != number) continue;
      const ProcessFiles files = process_files({}, process.name, one.start);
      json start{
          {"pid", one.pid}, {"recording", files.recording.string()}, {"summary", files.summary.string()}};
      if (one.code) start["exit_code"] = *one.code;
      if (one.code) start["ended"] = one.how;
      starts.push_back(std::move(start));
    }
    processes.push_back({{"name", process.name}, {"host", process.host}, {"starts", std::move(starts)}});
  }
  const json all{{"system", system_}, {"net_hash", net_hash_}, {"processes", std::move(processes)}};
  const fs::path beside = file_.string() + ".new";
  std::ofstream stream(beside);
  stream << all.dump(2) << '\n';
  stream.close();
  // A full disk must not stop the processes. The file that is there is older, but whole.
  std::error_code ignored;
  if (stream)
    fs::rename(beside, file_, ignored);
  else
    fs::remove(beside, ignored);
}

}  // namespace tessera::project
