// Runs the controller of spec.yaml and prints everything that can be said about it: story SPEC RECORDING
#include <cstdio>
#include <iostream>

#include "codegen/generated.hpp"
#include "diagnostics/source.hpp"
#include "layers/layers.hpp"
#include "replay/coverage.hpp"
#include "replay/events.hpp"
#include "replay/legality.hpp"
#include "replay/perfetto.hpp"
#include "replay/statistics.hpp"
#include "replay/timeline.hpp"
#include "tessera/recording.hpp"
#include "tessera_testing.hpp"
#include "verify/verify.hpp"

namespace tessera::words_test {
namespace {

std::ostream& out = std::cout;

void tell_of_one_subsystem() {
  SubsystemUnderTest<small::robot::control::Context> control;
  for (const unsigned count : {2U, 6U, 10U, 41U}) {
    control.memory.count = count;
    out << "after " << count << ": " << control.iterate("follow") << ", failed " << control.fail("follow")
        << '\n';
  }
  out << "init: " << control.iterate("init") << ", rest: " << control.iterate("rest") << '\n';
}

void run(const std::string& recording) {
  SystemUnderTest system(generated_system());
  system.options.recording = recording;
  system.options.accept_stuck = true;
  system.options.network.conditions = "loss=0.3";
  const RunSummary summary = system.run(std::chrono::seconds(20));
  out << summary.ended << ", " << summary.firings << " firings\n";
  for (const RunSummary::PerSubsystem& one : summary.subsystems)
    out << one.path << ' ' << one.iterations << ' ' << one.overruns << ' ' << one.errors << '\n';
  for (const std::string& behaviour : system.behaviours("robot.control")) out << behaviour << ' ';
  out << '\n';
}

void tell_of(const Recording& recording) {
  for (const Recording::Transition& transition : recording.transitions) {
    const TransitionRole& role = transition.role;
    out << transition.name << ": " << name_of(role.step) << ' ' << role.behaviour << ' '
        << (role.channel ? recording.channels[*role.channel] : "") << '\n';
  }
  out << "roles:\n";
  for (const Recording::Transition& transition : recording.transitions)
    out << name_of(transition.role.step) << ' ' << transition.role.behaviour << '\n';
  for (const replay::SubsystemStatistics& one : replay::statistics_of(recording)) {
    out << one.path << ' ' << one.firings << ' ' << one.iterations << ' ' << one.errors << ' ' << one.timeouts
        << ' ' << one.skips << ' ' << one.overwrites << ' ' << one.period.mean << ' ' << one.iteration.mean
        << '\n';
    for (const auto& wait : one.waits) out << wait.channel << ' ' << wait.time.mean << '\n';
  }
  for (const replay::Lane& lane : replay::timeline_of(recording).lanes) {
    out << lane.path << ' ' << lane.iterations << ' ' << lane.errors_s.size() << '\n';
    for (const auto& stretch : lane.stretches)
      out << lane.behaviours[stretch.behaviour] << ' ' << stretch.from_s << ' ' << stretch.to_s << '\n';
  }
  replay::Selection newest;
  newest.last = 200;
  replay::print_events(recording, newest, out);
  replay::write_perfetto(recording, out);
}

void compare_with_the_net(const Recording& recording, const test::Generated& made) {
  const replay::Legality legality = replay::check_legal(
      {&recording, 1}, made.net, {.names = {"robot", "station"}, .of_agents = {{0}, {1}}});
  out << "legal: " << static_cast<int>(legality.verdict) << ' ' << legality.firings << ' ' << legality.why
      << '\n';
  replay::FiringCounts counts(made.net);
  out << counts.add(recording).value_or(Problem{}).text
      << replay::coverage_text(coverage_of(made.pages, made.net, counts), "spec.yaml",
                               made.net.parts().sources);
}

void verify(const test::Generated& made) {
  const std::vector<net::Invariant> invariants = layers::invariants(made.model, made.pages, made.net);
  const verify::Report report = verify::prove({made.net, &made.pages, invariants});
  for (const verify::PropertyResult& property : report.properties) {
    out << property.name << ' ' << static_cast<int>(property.verdict) << ' ' << property.method << ' '
        << property.explanation << '\n';
  }
}

}  // namespace
}  // namespace tessera::words_test

int main(int, char** arguments) {
  using namespace tessera;
  words_test::tell_of_one_subsystem();
  words_test::run(arguments[2]);
  std::string error;
  const std::optional<Recording> recording = read_recording(arguments[2], error);
  std::remove(arguments[2]);
  if (!recording) return std::puts(error.c_str()), 1;
  words_test::tell_of(*recording);
  const test::Generated made = test::generate(test::read_file(arguments[1]));
  words_test::compare_with_the_net(*recording, made);
  words_test::verify(made);
}
