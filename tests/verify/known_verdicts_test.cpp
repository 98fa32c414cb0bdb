// Specifications whose verdicts and waiting subsystems were worked out by hand.

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "proved.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

constexpr auto holds = Verdict::holds;
constexpr auto violated = Verdict::violated;

struct Known {
  const char* file;
  const char* elsewhere;  ///< the name of the same file in the test data; nullptr: it is not there
  const char* property;
  Verdict verdict;
  std::vector<std::string> waits;
};

const std::vector<Known> all_known{
    {"exception_leads_on",
     "exc_shadow_holds",
     "survives_exceptions",
     violated,
     {"c.control waits for a value of a.control.o->c.control.i from a.control", "a.control has ended"}},
    {"exception_leads_on", "exc_shadow_holds", "goes_on", holds, {}},
    {"exception_stays_away",
     nullptr,
     "survives_exceptions",
     violated,
     {"c.control waits for a value of a.control.o->c.control.i from a.control",
      "a.control goes on and sends a.control.o->c.control.i no more"}},
    {"exception_behind_unconditional",
     "exc_shadow_violated",
     "survives_exceptions",
     violated,
     {"c.control waits for a value of a.control.o->c.control.i from a.control", "a.control has ended"}},
    {"error_is_certain", "error_true_none", "goes_on", holds, {}},
    {"error_is_certain", "error_true_none", "deadlock_free", holds, {}},
    {"leads_to", "leads_to", "q", violated, {}},
    {"circle_beside_a_slow_reader",
     "run_end_general",
     "goes_on",
     violated,
     {"a1.control waits for the acknowledgement of a1.control.o1->a1.s2.i1 from a1.s2",
      "a1.s2 waits for the acknowledgement of a1.s2.o0->a1.control.i0 from a1.control"}},
    {"exception_ends_sender",
     "run_end_exc",
     "survives_exceptions",
     violated,
     {"a0.control waits for the acknowledgement of a0.control.o0->a0.s2.i0 from a0.s2", "a0.s2 has ended"}},
    {"own_model_circle",
     "run_own_model",
     "goes_on",
     violated,
     {"a1.control waits for the memory of a1.control.o1->a1.s2.i3 from a1.s2",
      "a1.s2 waits for the acknowledgement of a1.s2.o2->a1.control.i2 from a1.control"}},
    {"own_model_to_itself",
     "run_own_model2",
     "goes_on",
     violated,
     {"a0.control waits for the acknowledgement of a0.control.o3->a0.control.i3 from itself"}},
    {"entry_behind_unconditional", "not_compiled", "goes_on", holds, {}},
};

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

void expect_known(const Known& known, const fs::path& file) {
  SCOPED_TRACE(file.string() + ", " + known.property);
  const Proved all = proved(text_of(file));
  const PropertyResult& result = all[known.property];
  EXPECT_EQ(result.verdict, known.verdict) << result.method << ": " << result.why;
  if (known.verdict == holds || !known.waits.empty()) {
    EXPECT_THAT(texts_of(result), testing::UnorderedElementsAreArray(known.waits));
  }
}

TEST(KnownVerdicts, AreFound) {
  for (const Known& known : all_known)
    expect_known(
        known, fs::path(TESSERA_SOURCE_DIR) / "tests/golden/verdicts" / (std::string(known.file) + ".yaml"));
}

TEST(KnownVerdicts, OfTheTestDataAreFound) {
  const char* folder = std::getenv("TESSERA_TEST_DATA");
  if (folder == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const Known& known : all_known)
    if (known.elsewhere != nullptr)
      expect_known(known, fs::path(folder) / "verdicts" / (std::string(known.elsewhere) + ".yaml"));
}

/// `starved` follows a behaviour that is never acknowledged; `alone` and `other` follow none.
constexpr const char* dead_in_two_ways = R"(tessera: 1
system: s
types: { V: { v: float64 } }
agents:
  a:
    control:
      rate: 10 Hz
      outputs: { o: V }
      behaviours:
        first: { terminal: true, next: starved }
        starved: {}
        alone: {}
  b: { control: { rate: 10 Hz, inputs: { i: V }, behaviours: { work: { receive: [] }, other: {} } } }
channels: [ { from: a.control.o, to: b.control.i, send: blocking } ]
)";

TEST(LiveBehaviours, NamesEveryBehaviourThatCannotRunWithItsLine) {
  using Behaviour = PropertyResult::Behaviour;
  const Proved all = proved(dead_in_two_ways);
  const PropertyResult& live = all["live_behaviours"];
  EXPECT_EQ(live.verdict, violated);
  EXPECT_THAT(live.behaviours,
              ElementsAre(Behaviour{"a.control.starved", 11}, Behaviour{"a.control.alone", 12},
                          Behaviour{"b.control.other", 13}));
  EXPECT_EQ(live.why,
            "3 behaviours can never run: a.control.starved (line 11), a.control.alone (line 12), "
            "b.control.other (line 13)");
}

/// `a` waits for an acknowledgement of its own, and `b` for a value that `a` would send after that.
constexpr const char* waits_for_who_waits = R"(tessera: 1
system: s
types: { V: { v: float64 } }
agents:
  a:
    control:
      rate: 10 Hz
      inputs: { i: V }
      outputs: { first: V, then: V }
      behaviours:
        one: { terminal: true, next: two, send: [first], receive: [i] }
        two: { send: [then], receive: [] }
  b: { control: { rate: 10 Hz, inputs: { i: V }, behaviours: { work: {}, other: {} } } }
channels:
  - { from: a.control.first, to: a.control.i, send: blocking, receive: blocking }
  - { from: a.control.then, to: b.control.i, receive: blocking }
properties:
  - { name: q, leads_to: "a.control.one => a.control.two" }
  - { name: r, always_reachable: a.control.two }
)";

TEST(KnownVerdicts, RunsToWhatNeverFollowsGoOnUntilAllWhoAreWaitedForAreStuck) {
  const Proved all = proved(waits_for_who_waits);
  for (const char* property : {"q", "r"}) {
    SCOPED_TRACE(property);
    const PropertyResult& result = all[property];
    EXPECT_EQ(result.verdict, violated);
    EXPECT_THAT(texts_of(result),
                testing::Contains(
                    "a.control waits for the acknowledgement of a.control.first->a.control.i from itself"));
  }
}

}  // namespace
}  // namespace tessera::verify
