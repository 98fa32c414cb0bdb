#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

#include "../environment.hpp"
#include "generated.hpp"

namespace tessera::test {
namespace {

/// Files of the controller; the header for tests is no part of it.
std::size_t lines_of_cpp(const Generated& generated) {
  std::size_t lines = 0;
  for (const codegen::File& file : generated.files)
    if (file.path.ends_with("pp") && file.path != "tessera_testing.hpp")
      lines += static_cast<std::size_t>(std::ranges::count(file.text, '\n'));
  return lines;
}

/// Lines of code in the paper: 6 for a place, 6 for a transition, 1 for an arc, 48 for a page (sec. VII).
std::size_t lines_of_the_paper(const Generated& generated) {
  const std::size_t pages = generated.pages.pages.size() - 1;  // the root is no page of another net
  return 6 * generated.net.places().size() + 6 * generated.net.transitions().size() +
         generated.net.arc_count() + 48 * pages;
}

/// share: the most of the paper's lines.
void expect_short(const char* name, const Generated& generated, double share) {
  const std::size_t ours = lines_of_cpp(generated), paper = lines_of_the_paper(generated);
  std::printf("%-32s %8zu lines, the paper's way %8zu (%.1f %%)\n", name, ours, paper,
              100.0 * static_cast<double>(ours) / static_cast<double>(paper));
  EXPECT_LT(static_cast<double>(ours), share * static_cast<double>(paper)) << name;
}

const std::string body = R"(
    control:
      rate: 20 Hz
      inputs:  { line: bool, ahead: float64 }
      outputs: { motion: float64, behind: float64 }
      behaviours: { init: { terminal: true, next: follow }, follow: {} }
    receptors:
      sensor: { rate: 50 Hz, outputs: { line: bool }, behaviours: { watch: {} } }
    effectors:
      motor: { rate: 50 Hz, inputs: { velocity: float64 }, behaviours: { drive: {} } }
)";
const std::string head = "tessera: 1\nsystem: fleet\n";

std::string from_template(int count) {
  return head + "templates:\n  follower:" + body +
         "agents:\n  robot: { use: follower, count: " + std::to_string(count) +
         ", ring: true }\nchannels:\n"
         "  - \"robot[i].sensor.line -> robot[i].control.line\"\n"
         "  - { from: \"robot[i].control.motion\", to: \"robot[i].motor.velocity\", receive: blocking, "
         "timeout: 200 ms }\n"
         "  - robot[i].control.behind -> robot[i+1].control.ahead\n";
}

std::string written_out(int count) {
  std::string agents = "agents:\n", channels = "channels:\n";
  for (int i = 0; i < count; ++i) {
    const std::string robot = "r" + std::to_string(i);
    agents += "  " + robot + ":" + body;
    channels += "  - " + robot + ".sensor.line -> " + robot + ".control.line\n  - { from: " + robot +
                ".control.motion, to: " + robot +
                ".motor.velocity, receive: blocking, timeout: 200 ms }\n  - " + robot +
                ".control.behind -> r" + std::to_string((i + 1) % count) + ".control.ahead\n";
  }
  return head + agents + channels;
}

Generated timed(const char* name, const std::string& text) {
  const auto start = std::chrono::steady_clock::now();
  Generated generated = generate(text);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%-32s %8.3f s from YAML to %zu files, peak memory so far %ld MB\n", name, taken.count(),
              generated.files.size(), usage.ru_maxrss / 1024);
  return generated;
}

/// The smallest example has as many lines above its subsystems as a fleet has, and a head for each of its files.
TEST(Scale, ExamplesTakeAboutAThirdOfThePapersLines) {
  expect_short("01_line_follower", generate_file(line_follower_spec), 0.38);
  expect_short("02_gap", generate_file(gap_spec), 1 / 3.0);
}

TEST(Scale, FleetsTakeLessThanAThirdOfThePapersLines) {
  constexpr int many = share_of(1000);
  for (const int count : {10, many})
    expect_short(("template x " + std::to_string(count)).c_str(), generate(from_template(count)), 1 / 3.0);
  expect_short("many written out", timed("many written out", written_out(many)), 1 / 3.0);
}

TEST(Scale, OneMoreAgentOfATemplateIsOneLinePerInstanceAndChannel) {
  const std::size_t first = lines_of_cpp(generate(from_template(10)));
  const std::size_t second = lines_of_cpp(generate(from_template(10 + share_of(990))));
  EXPECT_EQ(second - first, share_of(990) * (3 + 3));
}

TEST(Scale, AgentsWrittenOutAreLinear) {
  const std::size_t ten = lines_of_cpp(generate(written_out(10)));
  const std::size_t twenty = lines_of_cpp(generate(written_out(20)));
  const std::size_t hundred = lines_of_cpp(timed("100 written out", written_out(100)));
  EXPECT_EQ(hundred - twenty, 8 * (twenty - ten));
}

TEST(Scale, AThousandAgentsOfATemplateShareTheirNet) {
  const Generated generated = timed("template x 1000", from_template(1000));
  EXPECT_EQ(generated.files.size(), 17U);
  EXPECT_GT(generated.net.places().size(), 50000U);
}

}  // namespace
}  // namespace tessera::test
