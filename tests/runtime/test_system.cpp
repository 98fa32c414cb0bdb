#include "test_system.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <utility>

#include "nets/flat_net.hpp"
#include "tessera/panel.hpp"

namespace tessera::testing {
namespace {

constexpr std::size_t most = 8;
std::array<Script, most> scripts;  // of the one TestSystem there is
Devices* devices_in_use = nullptr;
std::mutex devices_mutex;  // of fake devices only

class ScriptSubsystem final : public Subsystem {
 public:
  explicit ScriptSubsystem(const Script& script) : script_(script) {}
  void bind(Bindings& bindings) override {
    bindings.input("x", state_.x);
    bindings.input("y", state_.y);
    bindings.output("x", state_.out_x);
    bindings.output("y", state_.out_y);
    if (script_.senses) bindings.real_input("sensed", state_.sensed);
    if (script_.acts) {
      bindings.real_output("command", state_.command, script_.safe);
      bindings.limit("command", payload(state_.command), script_.limits);
    }
    if (script_.remembers) {
      bindings.remember("count", state_.count);
      bindings.remember("map", state_.map);
      bindings.remember("word", state_.word);
    }
    bindings.parameter("gain", state_.gain, {.minimum = 0, .maximum = 10, .unit = "m/s"});
    bindings.parameter("level", state_.level);
    bindings.parameter("flag", state_.flag);
    bindings.parameter("label", state_.label);
    bindings.parameter("points", state_.points, {.minimum = 0, .unit = "m"});
  }
  void call(std::uint16_t behaviour) override {
    state_.behaviour = behaviour;
    if (script_.writes) {
      state_.out_x = state_.out_x.value();
      state_.out_y = state_.out_y.value();
    }
    script_.call(state_);
  }
  Outcome decide(std::uint16_t, bool failed) override {
    return failed ? Outcome::error : script_.decide(state_);
  }
  int route(std::uint16_t, bool failed) override { return script_.route(state_, failed); }
  Sending sends(std::uint16_t, std::uint32_t output) override {
    return output == 0 ? script_.sends(state_) : Sending::sends;
  }
  void keep_outputs() override { kept_ = {state_.out_x, state_.out_y, state_.command}; }
  void restore_outputs() override { std::tie(state_.out_x, state_.out_y, state_.command) = kept_; }
  Context& context() override { return state_.context; }

 private:
  const Script& script_;
  ScriptState state_;
  std::tuple<SkippableOutput<double>, Output<double>, Output<double>> kept_;
};

template <std::size_t N>
std::unique_ptr<Subsystem> make() {
  return std::make_unique<ScriptSubsystem>(scripts[N]);
}
template <std::size_t... N>
constexpr auto makers(std::index_sequence<N...>) {
  return std::array{&make<N>...};
}
constexpr auto make_table = makers(std::make_index_sequence<most>{});

class FakeReceptor final : public Receptor<double> {
  std::optional<double> read() override {
    const std::lock_guard lock(devices_mutex);
    double value = 0;
    if (devices_in_use->sense && !devices_in_use->sense(value)) return std::nullopt;
    return value;
  }
};
class FakeEffector final : public Effector<double> {
 public:
  FakeEffector() {
    if (devices_in_use->made) devices_in_use->made();
  }

 private:
  bool open() override { return opening_ = true; }
  bool write(const double& value) override {
    {
      const std::lock_guard lock(devices_mutex);
      if (std::exchange(opening_, false)) {
        devices_in_use->at_opening.push_back(value);
        return true;
      }
      devices_in_use->commands.push_back(value);
    }
    return !devices_in_use->accept || devices_in_use->accept(value);
  }
  bool opening_ = false;
};

}  // namespace

TestSystem::TestSystem() { devices_in_use = &devices; }
TestSystem::~TestSystem() {
  devices_in_use = nullptr;
  scripts = {};
}

std::uint32_t TestSystem::add(std::string path, const SubsystemNet& net, Script script, Duration period,
                              Duration stale, Kind kind, Policies policies) {
  const auto index = static_cast<std::uint32_t>(instances_.size());
  const std::size_t dot = path.find('.');
  const std::string_view name = *names_.emplace_back(std::make_unique<std::string>(std::move(path)));
  const auto driver = [&](const char* buffer) -> std::string_view {
    return *names_.emplace_back(std::make_unique<std::string>(std::string(name) + buffer));
  };
  if (script.senses && !panel.empty())
    drivers_.push_back({driver(".sensed"), "panel", nullptr, panel, panel_receptor<double>, nullptr});
  else if (script.senses)
    drivers_.push_back(
        {driver(".sensed"),
         "FakeReceptor",
         nullptr,
         {},
         [](const DriverSetup&) -> std::unique_ptr<RealReceptor> { return std::make_unique<FakeReceptor>(); },
         nullptr});
  if (script.acts)
    drivers_.push_back({driver(".command"),
                        "FakeEffector",
                        nullptr,
                        {},
                        nullptr,
                        [](const DriverSetup&) -> std::unique_ptr<RealEffector> {
                          return std::make_unique<FakeEffector>();
                        }});
  scripts.at(index) = std::move(script);
  instances_.push_back(
      {name.substr(0, dot), name.substr(dot + 1), kind, &net, make_table.at(index), period, stale, policies});
  return index;
}

End TestSystem::end_of(std::uint32_t instance, std::string_view port) const {
  if (port.empty()) return {instance};
  return {instance, named::number_of(instances_[instance].net->ports, port)};
}

void TestSystem::connect(std::uint32_t from, std::string_view out_port, std::uint32_t to,
                         std::string_view in_port, std::span<const FusedPlace> places, Duration send_timeout,
                         Duration receive_timeout, std::uint16_t slots) {
  const auto path = [&](std::uint32_t instance) {
    return std::string(instances_[instance].agent) + '.' + std::string(instances_[instance].name);
  };
  names_.push_back(std::make_unique<std::string>(path(from) + '.' + std::string(out_port) + "->" + path(to) +
                                                 '.' + std::string(in_port)));
  channels_.push_back({*names_.back(), end_of(from, out_port), end_of(to, in_port), places, send_timeout,
                       receive_timeout, slots, medium_of(places)});
}

void TestSystem::deploy(std::vector<std::uint32_t> process_of, Duration liveliness) {
  liveliness_ = liveliness;
  process_of_ = std::move(process_of);
  processes_.clear();
  for (std::uint32_t process = 0; process <= *std::ranges::max_element(process_of_); ++process)
    processes_.push_back(
        {*names_.emplace_back(std::make_unique<std::string>("p" + std::to_string(process))), "", ""});
}

const System& TestSystem::system() {
  system_ = {tables_version, "test",      "",       "verification", {},         instances_,  channels_,
             &system_page,   &agent_page, drivers_, drivers_,       processes_, process_of_, 0,
             liveliness_};
  system_.latency = latency;
  hash_ = net_of(system_).hash();
  system_.net_hash = hash_;
  return system_;
}

RunSummary run(TestSystem& system, const RunOptions& options) {
  std::string error;
  const std::optional<RunSummary> summary = execute(system.system(), options, error);
  EXPECT_TRUE(summary) << error;
  return summary.value_or(RunSummary{});
}

std::string scratch_file(const std::string& name) {
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string folder =
      std::string(test->test_suite_name()) + '.' + test->name() + '.' + std::to_string(getpid());
  std::replace(folder.begin(), folder.end(), '/', '_');
  const std::filesystem::path path = std::filesystem::temp_directory_path() / ("tessera." + folder);
  std::filesystem::create_directories(path);
  return path / name;
}

}  // namespace tessera::testing
