// Compares values sent through a carrier between two processes with a bare publisher and subscriber of
// Cyclone DDS: one-way latency, and the throughput. Both have the same configuration and use UDP on loopback.
// They take turns in the same run; the counters are medians over the rounds. docs/inside/performance.md has figures.

#include <benchmark/benchmark.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "network/dds/carrier.hpp"

using namespace std::chrono_literals;

namespace tessera::benchmarks {
namespace {

constexpr int rounds = 5, values_in_a_round = 2000;
constexpr auto flat_out = 300ms;
constexpr network::ChannelNumber channel = 0;
using Clock = std::chrono::steady_clock;

std::int64_t now_ns() { return Clock::now().time_since_epoch().count(); }

std::int64_t thread_cpu_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return time.tv_sec * 1'000'000'000 + time.tv_nsec;
}

int domain() { return 1 + static_cast<int>(getpid()) % 229; }

/// A channel for values from one thread to another.
class Line {
 public:
  virtual ~Line() = default;
  /// number: from 1; the value begins with the time.
  virtual void send(std::uint64_t number) = 0;
  /// Receives for a while, and calls `arrived` with each value.
  virtual void receive() = 0;
  std::function<void(std::uint64_t number, std::int64_t sent_ns)> arrived;
};

network::CarrierSetup setup(network::ProcessNumber process, std::uint32_t size) {
  static const std::array<std::string_view, 2> processes{"sender", "receiver"};
  static network::ChannelSetup only;
  only = {.number = channel, .name = "values", .sender = 0, .receiver = 1, .longest_value_bytes = size};
  network::CarrierSetup made;
  made.system = "benchmark";
  made.net_hash = "0";
  made.process = process;
  made.processes = processes;
  made.incarnation = 1;
  made.liveliness = std::chrono::milliseconds(900);
  made.domain = domain();
  made.channels = std::span(&only, 1);
  return made;
}

class CarrierLine final : public Line, private network::Carrier::Listener {
 public:
  explicit CarrierLine(std::uint32_t size) : bytes_(size), from_(setup(0, size)), to_(setup(1, size)) {}
  void send(std::uint64_t number) override {
    const std::chrono::nanoseconds stamp(now_ns());
    from_.send(channel, {{1}, {1}, {number}, false}, {stamp, true, bytes_});
  }
  void receive() override { to_.receive(*this, 5ms); }

 private:
  void heard(network::ChannelNumber, const network::Data& data, const network::Value& value) override {
    arrived(data.number.value, value.stamp.count());
  }
  void heard(network::ChannelNumber, const network::State&) override {}
  void reachable(network::ProcessNumber, bool) override {}
  void complaint(std::string_view) override {}

  std::vector<std::byte> bytes_;
  dds::DdsCarrier from_, to_;
};

class BareLine final : public Line {
 public:
  explicit BareLine(std::uint32_t size) : bytes_(size), from_(domain(), at()), to_(domain(), at()) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
    writer_ = dds_create_writer(from_.participant(), topic(from_), qos, nullptr);
    reader_ = dds_create_reader(to_.participant(), topic(to_), qos, nullptr);
    dds_delete_qos(qos);
    waitset_ = dds_create_waitset(to_.participant());
    dds_waitset_attach(waitset_, dds_create_readcondition(reader_, DDS_ANY_STATE), 0);
    room_.bytes._maximum = size;
    room_.bytes._buffer = room_bytes_.data();
  }
  void send(std::uint64_t number) override {
    tessera_wire_Data sample{};
    sample.number = number;
    sample.stamp_ns = now_ns();
    sample.bytes._buffer = bytes_.data();
    sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(bytes_.size());
    dds_write(writer_, &sample);
  }
  void receive() override {
    dds_waitset_wait(waitset_, nullptr, 0, std::chrono::nanoseconds(5ms).count());
    void* sample = &room_;
    dds_sample_info_t info;
    while (dds_take(reader_, &sample, &info, 1, 1) == 1)
      if (info.valid_data) arrived(room_.number, room_.stamp_ns);
  }

 private:
  static dds::Location at() { return dds::locate("lo", {}); }
  static dds_entity_t topic(const dds::Domain& domain) {
    return dds_create_topic(domain.participant(), &tessera_wire_Data_desc, "bare", nullptr, nullptr);
  }
  std::vector<std::uint8_t> bytes_, room_bytes_ = bytes_;
  dds::Domain from_, to_;
  dds_entity_t writer_ = 0, reader_ = 0, waitset_ = 0;
  tessera_wire_Data room_{};
};

/// A channel whose receiver has a thread.
class Running {
 public:
  explicit Running(Line& line) : line_(line) {
    line.arrived = [this](std::uint64_t number, std::int64_t sent_ns) {
      latencies_ns.push_back(now_ns() - sent_ns);
      ++count;
      last_ = number;
      last_.notify_one();
    };
    latencies_ns.reserve(1'000'000);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) line_.receive();
    });
    while (last_ == 0) {  // until the two have found each other
      line.send(1);
      std::this_thread::sleep_for(5ms);
    }
  }
  /// Sends and waits until it has arrived.
  void pass(std::uint64_t number) {
    line_.send(number);
    for (std::uint64_t seen = last_; seen < number; seen = last_) last_.wait(seen);
  }
  void stop() { thread_ = {}; }

  std::vector<std::int64_t> latencies_ns;  ///< once the thread has stopped
  std::atomic<std::uint64_t> count{0};

 private:
  Line& line_;
  std::atomic<std::uint64_t> last_{0};
  std::jthread thread_;
};

struct Measured {
  double p50_us = 0, p99_us = 0, send_us = 0, arrived_per_s = 0;
};

double quantile_us(std::vector<std::int64_t>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return static_cast<double>(*at) * 1e-3;
}

void measure_rate(Running& running, Line& line, Measured& measured) {
  const std::uint64_t before = running.count;
  const auto start = Clock::now();
  const std::int64_t cpu_start_ns = thread_cpu_ns();
  std::uint64_t sent = 0;
  while (Clock::now() - start < flat_out) line.send(1'000'000 + ++sent);
  const std::chrono::duration<double> time = Clock::now() - start;
  measured.send_us = static_cast<double>(thread_cpu_ns() - cpu_start_ns) * 1e-3 / static_cast<double>(sent);
  measured.arrived_per_s = static_cast<double>(running.count - before) / time.count();
}

Measured measure(Line& line) {
  Running running(line);
  for (std::uint64_t number = 2; number < 200; ++number) running.pass(number);
  const std::size_t warm = running.count;
  for (std::uint64_t number = 200; number < 200 + values_in_a_round; ++number) {
    running.pass(number);
    std::this_thread::sleep_for(100us);  // like the threads of a robot, which sleep in between
  }
  const std::size_t end = running.count;
  Measured measured;
  measure_rate(running, line, measured);
  running.stop();
  std::vector<std::int64_t> latencies(running.latencies_ns.begin() + static_cast<std::ptrdiff_t>(warm),
                                      running.latencies_ns.begin() + static_cast<std::ptrdiff_t>(end));
  measured.p50_us = quantile_us(latencies, 0.5);
  measured.p99_us = quantile_us(latencies, 0.99);
  return measured;
}

double median(const std::vector<Measured>& all, double Measured::*what) {
  std::vector<double> values;
  for (const Measured& one : all) values.push_back(one.*what);
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void beside_bare(benchmark::State& state) {
  const auto size = static_cast<std::uint32_t>(state.range(0));
  std::vector<Measured> carrier, bare;
  for (auto _ : state)
    for (int round = 0; round < rounds; ++round) {
      CarrierLine with_carrier(size);
      carrier.push_back(measure(with_carrier));
      BareLine without(size);
      bare.push_back(measure(without));
    }
  const auto tell = [&](const std::string& name, double Measured::*what) {
    state.counters[name] = median(carrier, what);
    state.counters["bare " + name] = median(bare, what);
    state.counters["ratio of " + name] = median(carrier, what) / median(bare, what);
  };
  tell("p50 us", &Measured::p50_us);
  tell("p99 us", &Measured::p99_us);
  tell("CPU us a send", &Measured::send_us);
  tell("arrived/s", &Measured::arrived_per_s);
}
BENCHMARK(beside_bare)->Arg(64)->Arg(1 << 20)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace tessera::benchmarks

BENCHMARK_MAIN();
