// Measures the cost of many processes of one deployment that know each other: bench_dds_fleet PROCESSES
// star|all. Each is a process with a carrier on loopback and no work. star: one process has a channel to and
// from each of the others. all: each has a channel with each. docs/use/scale.md has figures.

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "network/dds/carrier.hpp"

using namespace std::chrono_literals;

namespace tessera::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto rest = 10s;
constexpr std::size_t most_processes = 80;

/// Stored in memory that all processes share.
struct Shared {
  std::array<std::atomic<std::int64_t>, most_processes> opened_ns, met_ns;  ///< 0: not yet
};

std::int64_t now_ns() { return Clock::now().time_since_epoch().count(); }

struct Fleet {
  std::vector<std::string> names;
  std::vector<std::string_view> processes;
  std::vector<network::ChannelSetup> channels;
  int domain = 1 + static_cast<int>(getpid()) % 229;

  void join(network::ProcessNumber from, network::ProcessNumber to) {
    channels.push_back({static_cast<network::ChannelNumber>(channels.size()), "channel", from, to, 64});
  }
  [[nodiscard]] network::CarrierSetup setup(network::ProcessNumber process) const {
    network::CarrierSetup made;
    made.system = "fleet";
    made.net_hash = "0";
    made.process = process;
    made.processes = processes;
    made.incarnation = 1;
    made.liveliness = std::chrono::milliseconds(900);
    made.domain = domain;
    made.channels = channels;
    return made;
  }
};

Fleet fleet_of(std::uint32_t count, bool star) {
  Fleet fleet;
  for (std::uint32_t number = 0; number < count; ++number)
    fleet.names.push_back("p" + std::to_string(number));
  fleet.processes.assign(fleet.names.begin(), fleet.names.end());
  for (std::uint32_t from = 0; from < count; ++from)
    for (std::uint32_t to = from + 1; to < count; ++to)
      if (from == 0 || !star) {
        fleet.join(from, to);
        fleet.join(to, from);
      }
  return fleet;
}

struct Listener final : network::Carrier::Listener {
  void heard(network::ChannelNumber, const network::Data&, const network::Value&) override {}
  void heard(network::ChannelNumber, const network::State&) override {}
  void reachable(network::ProcessNumber process, bool is_there) override {
    is_there ? (void)there.insert(process) : (void)there.erase(process);
    if (!is_there) ++lost;
  }
  void complaint(std::string_view text) override { std::cout << text << std::endl; }
  std::set<network::ProcessNumber> there;
  int lost = 0;
};

[[noreturn]] void be(const Fleet& fleet, network::ProcessNumber process, Shared& shared) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dds::DdsCarrier carrier(fleet.setup(process));
  shared.opened_ns[process] = now_ns();
  const std::size_t peers = dds::deployment_of(fleet.setup(process)).peers.size();
  Listener listener;
  for (;;) {
    carrier.receive(listener, 1s);
    if (shared.met_ns[process] == 0 && listener.there.size() == peers) shared.met_ns[process] = now_ns();
  }
}

/// The figures of a process: seconds of CPU; kB of its private memory, or of its part of shared memory.
double cpu_s(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string word;
  for (int at = 0; at < 13; ++at) file >> word;
  long user = 0, system = 0;
  file >> user >> system;
  return static_cast<double>(user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}
long memory_kb(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/smaps_rollup");
  for (std::string word; file >> word;)
    if (word == "Pss:") {
      long kb = 0;
      file >> kb;
      return kb;
    }
  return 0;
}
/// The number of packets that loopback has carried.
double packets() {
  std::ifstream file("/sys/class/net/lo/statistics/rx_packets");
  double count = 0;
  file >> count;
  return count;
}

template <class Times>
bool all_set(const Times& times, std::size_t count) {
  for (std::size_t at = 0; at < count; ++at)
    if (times[at] == 0) return false;
  return true;
}

struct Totals {
  double cpu = 0, packets = 0, office_cpu = 0;
};
Totals totals(const std::vector<pid_t>& processes) {
  Totals sum{.cpu = 0, .packets = packets(), .office_cpu = cpu_s(processes.front())};
  for (const pid_t one : processes) sum.cpu += cpu_s(one);
  return sum;
}

int measure(std::uint32_t count, bool star) {
  const Fleet fleet = fleet_of(count, star);
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto& shared = *new (memory) Shared{};
  const std::int64_t start = now_ns();
  std::vector<pid_t> processes;
  for (std::uint32_t number = 0; number < count; ++number) {
    const pid_t one = fork();
    if (one == 0) be(fleet, number, shared);
    processes.push_back(one);
  }
  while (!all_set(shared.met_ns, count) && now_ns() - start < 120'000'000'000)
    std::this_thread::sleep_for(5ms);
  const bool met = all_set(shared.met_ns, count);
  std::int64_t last_opened = 0, last_met = 0;
  for (std::size_t at = 0; at < count; ++at) {
    last_opened = std::max<std::int64_t>(last_opened, shared.opened_ns[at]);
    last_met = std::max<std::int64_t>(last_met, shared.met_ns[at]);
  }
  const Totals forming = totals(processes);
  std::this_thread::sleep_for(5s);
  const Totals before = totals(processes);
  std::this_thread::sleep_for(rest);
  const Totals after = totals(processes);
  long kb = 0;
  for (const pid_t one : processes) kb += memory_kb(one);
  const double seconds = std::chrono::duration<double>(rest).count();
  std::printf(
      "%u processes, %s: all opened after %.2f s, all met after %.2f s%s (CPU until then %.2f s); "
      "%.1f MB each; at rest %.2f %% of a core each, %.1f %% the first, %.0f %% all; %.0f packets/s on lo\n",
      count, star ? "star" : "all", static_cast<double>(last_opened - start) * 1e-9,
      static_cast<double>(last_met - start) * 1e-9, met ? "" : " (NOT ALL)", forming.cpu,
      static_cast<double>(kb) / 1024 / count, (after.cpu - before.cpu) / seconds / count * 100,
      (after.office_cpu - before.office_cpu) / seconds * 100, (after.cpu - before.cpu) / seconds * 100,
      (after.packets - before.packets) / seconds);
  for (const pid_t one : processes) kill(one, SIGKILL);
  for (const pid_t one : processes) waitpid(one, nullptr, 0);
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace tessera::benchmarks

int main(int count, char** values) {
  if (count != 3) {
    std::cerr << "bench_dds_fleet PROCESSES star|all\n";
    return 2;
  }
  const int processes = std::atoi(values[1]);
  if (processes < 2 || processes > static_cast<int>(tessera::benchmarks::most_processes)) return 2;
  return tessera::benchmarks::measure(static_cast<std::uint32_t>(processes),
                                      std::string(values[2]) == "star");
}
