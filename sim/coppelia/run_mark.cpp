#include "sim/coppelia/run_mark.hpp"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

namespace tessera::coppelia {
namespace {

using nlohmann::json;

/// Empty: the kernel does not say.
std::string this_machine() {
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  std::error_code problem;
  const auto processes = std::filesystem::read_symlink("/proc/self/ns/pid", problem);
  return boot.empty() || problem ? std::string() : boot + " " + processes.string();
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// The start of a process, in ticks since boot. Empty: there is no such process, or it has ended and only
/// waits to be collected.
std::string beginning_of(std::int64_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text, '\0');
  const std::size_t name_end = text.rfind(')');  // a name may hold spaces and brackets
  if (name_end == std::string::npos) return {};
  std::istringstream fields(text.substr(name_end + 1));
  std::string state, field;
  fields >> state;
  constexpr int fields_between = 18;
  for (int skipped = 0; skipped < fields_between; ++skipped) fields >> field;
  fields >> field;
  return fields && state != "Z" && state != "X" ? field : std::string();
}

}  // namespace

RunMark mark_of_this_process(bool has_loaded) {
  const std::int64_t process = getpid();
  return {this_machine(), host_name(), process, beginning_of(process), has_loaded};
}

Owner owner_of(const RunMark& mark) {
  if (mark.machine.empty() || mark.began.empty() || mark.machine != this_machine())
    return Owner::on_another_machine;
  return beginning_of(mark.process) == mark.began ? Owner::lives : Owner::has_gone;
}

std::string text_of(const RunMark& mark) {
  return json{{"machine", mark.machine},
              {"host", mark.host},
              {"process", mark.process},
              {"began", mark.began},
              {"has_loaded", mark.has_loaded}}
      .dump(-1, ' ', /*ensure_ascii=*/true, json::error_handler_t::replace);
}

std::optional<RunMark> mark_of(const std::string& text) try {
  const json map = json::parse(text);
  return RunMark{map.at("machine").get<std::string>(), map.at("host").get<std::string>(),
                 map.at("process").get<std::int64_t>(), map.at("began").get<std::string>(),
                 map.at("has_loaded").get<bool>()};
} catch (const json::exception&) {
  return std::nullopt;
}

}  // namespace tessera::coppelia
