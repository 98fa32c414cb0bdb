#include <gtest/gtest.h>

#include <utility>

#include "nets.hpp"
#include "nets/flat_net.hpp"
#include "tessera/controller.hpp"
#include "tessera/large_array.hpp"
#include "test_system.hpp"

namespace tessera::testing {
namespace {

/// An element that counts how often it is copied.
struct Counted {
  static inline std::uint64_t copies = 0;
  std::uint8_t value = 0;
  Counted() = default;
  Counted(std::uint8_t number) : value(number) {}  // NOLINT(google-explicit-constructor)
  Counted(const Counted& other) : value(other.value) { ++copies; }
  Counted& operator=(const Counted& other) {
    value = other.value;
    ++copies;
    return *this;
  }
  bool operator==(const Counted&) const = default;
};
constexpr std::size_t pixels = 1'000'000;
struct Image {
  std::uint32_t number = 0;
  LargeArray<Counted, pixels> pixel;
};

TEST(LargeArray, CopiesShareUntilOneIsWrittenTo) {
  LargeArray<int, 10> one{1, 2, 3};
  LargeArray<int, 10> two = one;
  EXPECT_EQ(std::as_const(one).data(), std::as_const(two).data());
  two[1] = 7;
  EXPECT_EQ(std::as_const(one)[1], 2);
  EXPECT_EQ(std::as_const(two)[1], 7);
  EXPECT_EQ(std::as_const(two)[2], 3);
  EXPECT_FALSE(one == two);
  one = two;
  EXPECT_TRUE(one == two);
  one.fill(4);
  EXPECT_EQ(std::as_const(two)[1], 7);
  EXPECT_EQ(std::as_const(one).back(), 4);
}

TEST(LargeArray, WritingInPlaceWhenNobodySharesMovesNothing) {
  LargeArray<int, 10> one;
  const int* const before = std::as_const(one).data();
  one[3] = 1;
  EXPECT_EQ(one.data(), before);
}

struct Inputs {
  Input<Image> image;
};
struct Outputs {
  Output<Image> image;
};
struct Nothing {};
struct PlainContext : Context {
  explicit PlainContext(const Nothing&) {}
};
using Base = SubsystemOf<Inputs, Nothing, Outputs, Nothing, PlainContext>;

/// The options of a test for the two ends.
struct Wanted {
  bool writes = true;
  std::uint64_t sent = 0, received = 0, wrong = 0, kept = 0;
} wanted;

struct Camera final : Base {
  void bind(Bindings& bindings) override { bindings.output("x", out.image); }
  void call(std::uint16_t) override {
    // An output left untouched keeps its last value.
    if (wanted.sent > 0 && std::as_const(out.image).pixel[5].value == static_cast<std::uint8_t>(wanted.sent))
      ++wanted.kept;
    if (!wanted.writes && wanted.sent > 0) return;
    ++wanted.sent;
    out.image.number = static_cast<std::uint32_t>(wanted.sent);
    out.image.pixel[5].value = static_cast<std::uint8_t>(wanted.sent);
  }
  Outcome decide(std::uint16_t, bool) override { return Outcome::go_on; }
  int route(std::uint16_t, bool) override { return 0; }
};
struct Viewer final : Base {
  void bind(Bindings& bindings) override { bindings.input("x", in.image); }
  void call(std::uint16_t) override {
    if (!in.image.fresh) return;
    ++wanted.received;
    const Input<Image>& image = in.image;
    if (image.pixel[5].value != static_cast<std::uint8_t>(image.number)) ++wanted.wrong;
    if (wanted.received == 20) context_.stop("enough");
  }
  Outcome decide(std::uint16_t, bool) override { return Outcome::go_on; }
  int route(std::uint16_t, bool) override { return 0; }
};

/// Copies of elements that a run makes.
std::uint64_t copies_of_a_run(RunOptions::Clock clock) {
  using namespace std::chrono_literals;
  const Instance instances[] = {
      {"robot", "camera", Kind::control, &nets::nb_sender,
       []() -> std::unique_ptr<Subsystem> { return std::make_unique<Camera>(); }, 1ms},
      {"robot", "viewer", Kind::control, &nets::b_receiver,
       []() -> std::unique_ptr<Subsystem> { return std::make_unique<Viewer>(); }}};
  const Channel channels[] = {{"robot.camera.x->robot.viewer.x", {0, 0}, {1, 0}, buffered}};
  System system{tables_version, "images", "", "", {}, instances, channels, &system_page, &agent_page, {}, {}};
  const std::string hash = net_of(system).hash();
  system.net_hash = hash;
  RunOptions options = simulated(60s);
  options.clock = clock;
  std::string error;
  Counted::copies = 0;
  const auto summary = execute(system, options, error);
  EXPECT_TRUE(summary) << error;
  EXPECT_EQ(wanted.wrong, 0U);
  return Counted::copies;
}

struct LargeValue : ::testing::TestWithParam<RunOptions::Clock> {
  LargeValue() { wanted = {}; }
};

TEST_P(LargeValue, IsCopiedAtMostOnceOnItsWayThroughAChannel) {
  // A run that only writes copies each value, and the initial values of arrays.
  wanted.writes = false;
  const std::uint64_t made = copies_of_a_run(GetParam());
  ASSERT_GE(wanted.received, 20U);
  wanted = {};
  const std::uint64_t copied = copies_of_a_run(GetParam());
  ASSERT_GE(wanted.received, 20U);
  EXPECT_GE(wanted.sent, wanted.received);
  EXPECT_LE(copied - made, (wanted.sent - 1) * pixels);
  EXPECT_GE(wanted.kept, wanted.sent - 1);
}

INSTANTIATE_TEST_SUITE_P(Clocks, LargeValue,
                         ::testing::Values(RunOptions::Clock::simulated, RunOptions::Clock::steady),
                         [](const auto& parameters) {
                           return parameters.param == RunOptions::Clock::simulated ? "simulated" : "steady";
                         });

}  // namespace
}  // namespace tessera::testing
