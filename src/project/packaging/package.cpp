#include "project/packaging/package.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <stdexcept>

#include "project/files/files.hpp"
#include "project/packaging/debian_packages.hpp"
#include "project/packaging/scratch_folder.hpp"
#include "project/process/process.hpp"
#include "project/service_units.hpp"
#include "tessera/nearest.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

constexpr const char* carrier_library_name = "libtessera_dds.so";
constexpr const char* ros2_drivers_name = "libtessera_ros2.so";
/// The former loads it when the other side of a service runs rmw_fastrtps_cpp, and every node serves parameters. An
/// installation may lack it.
constexpr const char* fast_services_name = "libtessera_ros2_fast.so";

/// One host and what runs there.
struct HostPlan {
  std::string host;
  std::vector<std::string> processes;
};

std::vector<HostPlan> plans_of(const spec::Model& model) {
  if (!model.deployment) return {{}};
  std::vector<HostPlan> plans;
  for (const spec::Process& process : model.deployment->processes) {
    auto plan = std::ranges::find(plans, process.host, &HostPlan::host);
    if (plan == plans.end()) plan = plans.insert(plans.end(), {process.host, {}});
    plan->processes.push_back(process.name);
  }
  return plans;
}

/// Seconds since 1970 that all files get.
std::int64_t epoch() {
  constexpr std::int64_t year_2000 = 946684800;
  const char* const given = std::getenv("SOURCE_DATE_EPOCH");
  if (given == nullptr) return year_2000;
  const std::string_view text(given);
  std::int64_t read = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), read);
  if (problem != std::errc{} || end != text.data() + text.size() || read < 0)
    throw std::runtime_error(fmt::format("SOURCE_DATE_EPOCH is '{}', which is no number of seconds", text));
  return read;
}

void run_tool(const Command& command) {
  const Exit done = capture(command);
  if (done.code != 0)
    throw std::runtime_error(fmt::format("`{}` failed:\n{}", shell_line(command), done.text));
}

/// Names of Debian's packages have small letters, digits and hyphens only.
std::string debian_name(const std::string& name) {
  std::string made = "tessera-";
  for (const char one : plain_name(name)) {
    const auto byte = static_cast<unsigned char>(one);
    made += std::isalnum(byte) != 0 ? static_cast<char>(std::tolower(byte)) : '-';
  }
  return made;
}

/// The package of one host, from its files on.
class Packing {
 public:
  Packing(const Controller& controller, const PackageOptions& options, HostPlan plan, bool is_only,
          std::string architecture)
      : controller_(controller),
        model_(controller.specification.model),
        options_(options),
        plan_(std::move(plan)),
        system_(plain_name(model_.system)),
        architecture_(std::move(architecture)),
        name_(debian_name(is_only ? model_.system
                                  : model_.system + "-" + (plan_.host.empty() ? "any" : plan_.host))) {}

  Package make() {
    const bool is_debian = options_.format == PackageOptions::Format::debian;
    const ScratchFolder scratch;
    const fs::path root = scratch.path() / "root";
    const fs::path own = is_debian ? root / "opt" / system_ : root / system_;
    put_programs(own);
    if (!options_.parameters.empty()) write_file(own / "parameters", parameter_text());
    const fs::path units = is_debian ? root / "usr/lib/systemd/system" : own / "systemd";
    for (const ServiceUnit& unit : units_here()) {
      write_file(units / unit.file, unit.text);
      unit_files_.push_back(unit.file);
    }
    write_file(own / "README", readme(is_debian));
    if (is_debian) put_control(root);
    settle(root);
    const std::string file =
        fmt::format("{}_{}_{}.{}", name_, options_.version, architecture_, is_debian ? "deb" : "tar.gz");
    fs::create_directories(options_.folder);
    const ScratchFolder beside(options_.folder);  // so that the package appears as a whole
    const fs::path made = beside.path() / file;
    is_debian ? build_debian(root, made) : build_archive(root, made);
    fs::rename(made, options_.folder / file);
    return {options_.folder / file, plan_.host, plan_.processes, needs_.packages};
  }

 private:
  void put_programs(const fs::path& own) {
    fs::create_directories(own);
    copy_whole(controller_.program, own / "controller");
    std::vector<fs::path> files{own / "controller"};
    const auto add = [&](const char* library) {
      const fs::path from = options_.libraries / library;
      if (!fs::exists(from))
        throw std::runtime_error(fmt::format("this installation has no {}", from.string()));
      copy_whole(from, own / library);
      files.push_back(own / library);
    };
    if (model_.deployment) add(carrier_library_name);
    if (std::ranges::find(model_.drivers, "ros2", &spec::Driver::kind) != model_.drivers.end()) {
      add(ros2_drivers_name);
      if (fs::exists(options_.libraries / fast_services_name)) add(fast_services_name);
    }
    needs_ = libraries_of(files, options_.architecture.empty());
    for (const fs::path& library : needs_.foreign)
      copy_whole(fs::canonical(library), own / library.filename());
  }

  [[nodiscard]] std::vector<ServiceUnit> units_here() const {
    std::vector<ServiceUnit> units = service_units(model_, {.own_user = true,
                                                            .groups = options_.groups,
                                                            .parameters = !options_.parameters.empty(),
                                                            .own_libraries = !needs_.foreign.empty()});
    std::erase_if(units, [&](const ServiceUnit& unit) { return unit.host != plan_.host; });
    return units;
  }

  [[nodiscard]] std::string parameter_text() const {
    std::string text =
        "# Values in place of those of the specification: path = value. Read at the start of a unit.\n";
    for (const std::string& value : options_.parameters) {
      const std::size_t equals = value.find('=');
      text += value.substr(0, equals) + " = " + value.substr(equals + 1) + "\n";
    }
    return text;
  }

  [[nodiscard]] std::string readme(bool is_debian) const {
    const std::string units = fmt::format("{}", fmt::join(unit_files_, " "));
    const std::string start = fmt::format(
        "Start: `systemctl start {0}`; at every start of the machine: `systemctl enable {0}`.\n", units);
    if (is_debian)
      return fmt::format(
          "{} in /opt/{}. Installing it starts nothing: a robot moves when a person says so.\n{}"
          "Recordings are in /var/lib/{}. Stop: `systemctl stop {}`.\n",
          model_.system, system_, start, system_, units);
    return fmt::format(
        "Unpack as /opt/{0} (`tar -C /opt -xf ...`), and copy {0}/systemd/* to /etc/systemd/system.\n"
        "Install these packages of Debian: {1}.\n{2}",
        system_, fmt::join(needs_.packages, ", "), start);
  }

  /// The control file for dpkg.
  void put_control(const fs::path& root) const {
    const fs::path control = root / "DEBIAN";
    const std::string runs =
        plan_.processes.empty() ? "" : fmt::format(" Processes: {}.\n", fmt::join(plan_.processes, ", "));
    write_file(
        control / "control",
        fmt::format("Package: {}\nVersion: {}\nArchitecture: {}\nMaintainer: nobody <nobody@localhost>\n"
                    "Section: misc\nPriority: optional\nDepends: {}\n"
                    "Description: controller of {}, net {}\n{}"
                    " Made by Tessera. Nothing starts when it is installed; see /opt/{}/README.\n",
                    name_, options_.version, architecture_, fmt::join(needs_.packages, ", "), model_.system,
                    controller_.report.net_hash.substr(0, 12), runs, system_));
    if (!options_.parameters.empty())
      write_file(control / "conffiles", fmt::format("/opt/{}/parameters\n", system_));
    write_file(control / "prerm", fmt::format(R"(#!/bin/sh
# Nobody could stop a robot whose unit is gone. An upgrade leaves it running: the next start is the new one.
set -e
if [ "$1" = remove ] && [ -d /run/systemd/system ]; then systemctl disable --now {}; fi
)",
                                              fmt::join(unit_files_, " ")));
  }

  /// The same modes and times for every user and time of packaging.
  static void settle(const fs::path& root) {
    const auto time = fs::file_time_type(std::chrono::duration_cast<fs::file_time_type::duration>(
        fs::file_time_type::clock::from_sys(std::chrono::sys_seconds(std::chrono::seconds(epoch())))
            .time_since_epoch()));
    std::vector<fs::path> all{root};
    for (const auto& entry : fs::recursive_directory_iterator(root)) all.push_back(entry.path());
    for (const fs::path& path : all) {
      const bool runs =
          fs::is_directory(path) || path.filename() == "controller" || path.filename() == "prerm";
      fs::permissions(path, static_cast<fs::perms>(runs ? 0755 : 0644));
    }
    for (const fs::path& path : all) fs::last_write_time(path, time);
  }

  void build_archive(const fs::path& root, const fs::path& file) const {
    run_tool({"tar", "--create", "--file", file.string(), "--use-compress-program", "gzip -n9",
              "--format=gnu", "--sort=name", "--owner=0", "--group=0", "--numeric-owner",
              fmt::format("--mtime=@{}", epoch()), "--directory", root.string(), system_});
  }

  static void build_debian(const fs::path& root, const fs::path& file) {
    run_tool({"env", fmt::format("SOURCE_DATE_EPOCH={}", epoch()), "dpkg-deb", "--root-owner-group", "-Zgzip",
              "--build", root.string(), file.string()});
  }

  const Controller& controller_;
  const spec::Model& model_;
  const PackageOptions& options_;
  const HostPlan plan_;
  const std::string system_, architecture_, name_;
  LibraryNeeds needs_;
  std::vector<std::string> unit_files_;
};

/// Without an interface, a process hears its own machine only: no package of another one would find it.
void warn_of_loopback(const spec::Model& model, Listener& listener) {
  if (!model.deployment || plans_of(model).size() < 2) return;
  std::vector<std::string> names;
  for (const spec::Process& process : model.deployment->processes)
    if (process.interface.empty()) names.push_back(process.name);
  if (!names.empty())
    listener.warn(fmt::format("no `interface` is given for {}: without, a process hears its own machine only",
                              fmt::join(names, ", ")));
}

std::optional<Problem> wrong_with_version(const std::string& version) {
  const bool fits =
      !version.empty() && std::isdigit(static_cast<unsigned char>(version.front())) != 0 &&
      std::ranges::all_of(version, [](char one) {
        return std::isalnum(static_cast<unsigned char>(one)) != 0 || one == '.' || one == '+' || one == '~';
      });
  if (fits) return std::nullopt;
  return Problem{fmt::format(
      "'{}' is no version: it begins with a digit and has letters, digits, '.', '+' and '~'", version)};
}

}  // namespace

std::optional<Problem> wrong_with(const PackageOptions& options, const spec::Model& model) {
  if (auto wrong = wrong_with_version(options.version)) return wrong;
  for (const std::string& group : options.groups)
    if (group.empty() || !std::ranges::all_of(group, [](char one) {
          return std::isalnum(static_cast<unsigned char>(one)) != 0 || one == '-' || one == '_';
        }))
      return Problem{fmt::format("'{}' is no name of a group", group)};
  if (options.host.empty()) return std::nullopt;
  std::vector<std::string> hosts;
  for (const HostPlan& plan : plans_of(model))
    if (!plan.host.empty()) hosts.push_back(plan.host);
  if (std::ranges::find(hosts, options.host) != hosts.end()) return std::nullopt;
  if (hosts.empty()) return Problem{"--host: `deploy` of the specification names no host"};
  return Problem{with_hint(
      fmt::format("no process has the host '{}'; there are {}", options.host, fmt::join(hosts, ", ")),
      did_you_mean(options.host, hosts))};
}

std::vector<Package> make_packages(const Controller& controller, const PackageOptions& options,
                                   Listener& listener) {
  const std::string architecture =
      options.architecture.empty() ? architecture_of_this_machine() : options.architecture;
  const std::vector<HostPlan> plans = plans_of(controller.specification.model);
  std::vector<Package> made;
  warn_of_loopback(controller.specification.model, listener);
  Step step(listener, "packing");
  for (const HostPlan& plan : plans) {
    if (!options.host.empty() && plan.host != options.host) continue;
    step.progress(plan.host);
    made.push_back(Packing(controller, options, plan, plans.size() == 1, architecture).make());
  }
  return made;
}

}  // namespace tessera::project
