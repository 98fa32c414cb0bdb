// Communication models by themselves, and systems that use them.

#include <gmock/gmock.h>

#include "diagnostics/source.hpp"
#include "layers/built_in.hpp"
#include "layers/closed_pair.hpp"
#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"
#include "verify/circuits/circuit_criterion.hpp"
#include "verify/communication/communication.hpp"
#include "verify/communication/model_soundness.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {
namespace {

using ::testing::HasSubstr;

/// A pair of nets: shared places, transitions of both sides; each side has the places work and wait.
struct Pair {
  const char* name;
  const char* shared;
  const char* send;
  const char* receive;
  const char* complaint;  ///< empty: sound
};

std::string side(const std::string& operation, const std::string& transitions) {
  const std::string wait = transitions.find("wait") == std::string::npos ? "" : "wait, ";
  return "{ places: { in, work: { " + operation + ": 1 }, " + wait + "out }, transitions: { " + transitions +
         " } }";
}

std::string models(const Pair& pair) {
  return std::string("models:\n  own:\n    shared: { ") + pair.shared +
         " }\n    send: " + side("write", pair.send) + "\n    receive: " + side("read", pair.receive) + "\n";
}

spec::Model parsed(const std::string& text) {
  diagnostics::Diagnostics out("own.yaml", text);
  const std::optional<spec::Model> model = spec::parse(out);
  EXPECT_TRUE(model) << render(out);
  return model.value_or(spec::Model{});
}

/// A sender with a rate, a receiver without one, and the model between them.
std::string system(const std::string& models, const std::string& options = "") {
  return "tessera: 1\nsystem: s\n" + models +
         "agents:\n"
         "  a: { control: { rate: 10 Hz, outputs: { y: bool }, behaviours: { tell: {} } } }\n"
         "  b: { control: { rate: 10 Hz, inputs: { x: bool }, behaviours: { hear: {} } } }\n"
         "channels:\n  - { from: a.control.y, to: b.control.x, model: own" +
         options + " }\n";
}

constexpr const char* sends = "t1: { from: [in, empty], to: work }, t2: { from: work, to: [out, full] }";
constexpr const char* receives = "t1: { from: [in, full], to: work }, t2: { from: work, to: [out, empty] }";

std::vector<Pair> pairs() {
  return {
      {"HandOver", "empty: 1, full: 0", sends, receives, ""},
      {"StartsFull", "empty: 0, full: 1", sends, receives, ""},
      {"GivesWithoutTaking", "empty: 1, full: 0",
       "t1: { from: in, to: work }, t2: { from: work, to: [out, full] }", receives,
       "own.yaml:5:15: error E431: model 'own' is not safe: place 'empty' holds two tokens after send.t1, "
       "send.t2, receive.t1, receive.t2\n"},
      {"TakesNothing", "empty: 1, full: 0",
       "t1: { from: [in, empty], to: work }, t2: { from: work, to: [out, empty] }",
       "t1: { from: in, to: work }, t2: { from: work, to: out }",
       "own.yaml:7:30: error E432: model 'own' lets slot 1 be written and read at once after receive.t1, "
       "send.t1\n"},
      {"NobodyGivesBack", "empty: 1, full: 0", sends,
       "t1: { from: [in, full], to: work }, t2: { from: work, to: out }",
       "own.yaml:4:3: error E433: model 'own' can get stuck: 'send' never comes to 'out' again after "
       "send.t1, "
       "send.t2, send again\n"},
      {"EndsWithoutReading", "empty: 1, full: 0", sends,
       "t1: { from: [in, full], to: work }, t2: { from: work, to: [out, empty] }, "
       "t3: { from: [in, empty], to: out }",
       "own.yaml:4:3: error E433: model 'own' can get stuck: 'send' never comes to 'out' again after "
       "receive.t3\n"},
      {"NothingToRead", "empty: 1, full: 0",
       "t1: { from: [in, empty], to: work }, t2: { from: work, to: [out, empty] }",
       "t1: { from: [in, full], to: work }, t2: { from: work, to: [out, full] }, t3: { from: in, to: out }",
       "own.yaml:4:3: error E433: model 'own' can run dry: nothing is ever read again, from the start\n"},
      // The sender gives up and leaves the answer to its value behind.
      {"LosesAnAnswer", "empty: 1, full: 0, ack: 0",
       "t1: { from: [in, empty], to: work }, t2: { from: work, to: [wait, full] }, "
       "t3: { from: [wait, ack], to: out }, late: { from: wait, to: out, when: elapsed }",
       "t1: { from: [in, full], to: work }, t2: { from: work, to: [out, empty, ack] }",
       "own.yaml:5:34: error E431: model 'own' is not safe: place 'ack' holds two tokens after send.t1, "
       "send.t2, "
       "receive.t1, receive.t2, receive again, send.late, send again, send.t1, send.t2, receive.t1, "
       "receive.t2\n"},
      {"TakesItsValueBack", "empty: 1, full: 0, ack: 0",
       "t1: { from: [in, empty], to: work }, t2: { from: work, to: [wait, full] }, "
       "t3: { from: [wait, ack], to: out }, late: { from: [wait, full], to: [out, empty], when: elapsed }",
       "t1: { from: [in, full], to: work }, t2: { from: work, to: [out, empty, ack] }", ""},
  };
}

class ModelSoundness : public testing::TestWithParam<Pair> {};

TEST_P(ModelSoundness, AreSoundOrNameTheRun) {
  const std::string text =
      system(models(GetParam()),
             std::string(GetParam().send).find("elapsed") == std::string::npos ? "" : ", timeout: 20 ms");
  const spec::Model model = parsed(text);
  ASSERT_EQ(model.models.size(), 1U);
  const layers::ClosedPair pair = layers::closed_pair(model.models[0]);
  diagnostics::Diagnostics out("own.yaml", text);
  const spec::CommunicationModel& own = model.models[0];
  const bool sound =
      judge_soundness({pair.net, pair.sends_again, pair.receives_again, own.name, own.span}, out);
  EXPECT_EQ(sound, std::string(GetParam().complaint).empty());
  std::string said;
  for (const diagnostics::Diagnostic& one : out.sorted()) {
    const std::string whole = render(one, out);
    said += whole.substr(0, whole.find('\n') + 1);
    EXPECT_THAT(whole, HasSubstr("hint: "));
  }
  EXPECT_EQ(said, GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(Judged, ModelSoundness, testing::ValuesIn(pairs()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(BuiltInModels, AreSoundByThemselves) {
  using spec::Mode;
  const spec::Duration timeout{1};
  for (const Mode send : {Mode::non_blocking, Mode::blocking})
    for (const Mode receive : {Mode::non_blocking, Mode::blocking})
      for (const bool timed : {false, true}) {
        spec::Channel channel;
        channel.send = send;
        channel.receive = receive;
        if (timed && send == Mode::blocking) channel.send_timeout = timeout;
        if (timed && receive == Mode::blocking) channel.receive_timeout = timeout;
        const spec::CommunicationModel& model = layers::model_of({}, channel);
        const layers::ClosedPair pair = layers::closed_pair(model);
        diagnostics::Diagnostics out("", "");
        EXPECT_TRUE(judge_soundness({pair.net, pair.sends_again, pair.receives_again, "built-in", {}}, out))
            << render(out);
      }
}

// ---------------------------------------------------------------------------------------------- systems

struct ProvedModel {
  net::HierarchicalNet pages;
  net::Net net;
  std::vector<net::Invariant> invariants;
  Report report;

  explicit ProvedModel(const std::string& text) {
    const spec::Model model = parsed(text);
    diagnostics::Diagnostics out("own.yaml", text);
    pages = layers::build(model, out).value();
    net = net::flatten(pages, out).value();
    invariants = layers::invariants(model, pages, net);
    report = prove({net, &pages, invariants});
  }
  /// "safe: holds (place invariants)"
  [[nodiscard]] std::string operator[](const std::string& name) const {
    for (const PropertyResult& property : report.properties)
      if (property.name == name)
        return (property.verdict == Verdict::holds      ? "holds ("
                : property.verdict == Verdict::violated ? "violated ("
                                                        : "unknown (") +
               property.method + ")";
    return {};
  }
};

std::string two_slots() {
  diagnostics::Diagnostics file =
      diagnostics::load(std::string(TESSERA_SOURCE_DIR) + "/examples/03_two_slot_buffer/spec.yaml");
  return file.text();
}

TEST(OwnModels, HoldByTheInvariantsOfTheirPairAndByExplicitSearch) {
  const ProvedModel proved(two_slots());
  for (const char* name : {"safe", "exclusive_channels", "sound_pages"})
    EXPECT_EQ(proved[name], "holds (place invariants)") << name;
  for (const char* name : {"goes_on", "channels_flow", "live_behaviours"})
    EXPECT_EQ(proved[name], "holds (reductions and explicit search)") << name;
  EXPECT_EQ(proved["deadlock_free"], "holds (siphons and traps)");
}

const std::string hand_over =
    std::string("models: { own: { shared: { empty: 1, full: 0, spare: 1 }, send: ") +
    side("write",
         "t1: { from: [in, empty, spare], to: work }, t2: { from: work, to: "
         "[out, full, spare] }") +
    ", receive: " + side("read", receives) + " } }\n";

/// Two agents that both receive before they send; and two that communicate by built-in models.
std::string two_groups(const std::string& first) {
  const auto agent = [](const std::string& name, const std::string& behaviours) {
    return "  " + name +
           ": { control: { rate: 10 Hz, inputs: { x: bool }, outputs: { y: bool }, behaviours: { " +
           behaviours + " } } }\n";
  };
  const std::string talk = "talk: { }";
  return "tessera: 1\nsystem: s\n" + hand_over + "agents:\n" + agent("a", first) + agent("b", talk) +
         agent("c", talk) + agent("d", talk) +
         "channels:\n"
         "  - { from: a.control.y, to: b.control.x, model: own }\n"
         "  - { from: b.control.y, to: a.control.x, model: own }\n"
         "  - { from: c.control.y, to: d.control.x, receive: blocking }\n"
         "  - { from: d.control.y, to: c.control.x, receive: blocking }\n";
}

TEST(OwnModels, KeepTheCircuitCriterionFromTheirOwnGroupOnly) {
  const ProvedModel proved(two_groups("talk: {}"));
  const CommunicationResult read = communication_structure(proved.net);
  ASSERT_TRUE(read.structure) << read.why_not;
  const CircuitReport report = judge_circuits(*read.structure);
  ASSERT_EQ(report.groups.size(), 2U);
  EXPECT_EQ(report.groups[0].why_not,
            "'b.control': 'b.control.y->a.control.x' has a communication model of its own");
  EXPECT_TRUE(report.groups[1].applies());
  EXPECT_EQ(report.deadlock_free, Answer::yes);  // the other group runs for ever
  EXPECT_EQ(report.goes_on, Answer::unknown);
  EXPECT_EQ(proved["goes_on"], "holds (reductions and explicit search)");
}

TEST(OwnModels, StopASystemInWhichWhoHearsTwiceWaitsForWhoHearsOnce) {
  const std::string tell = "tell: { receive: [], terminal: true, next: hear }";
  const ProvedModel once(two_groups("hear: { send: [], terminal: true, next: tell }, " + tell));
  EXPECT_EQ(once["goes_on"], "holds (reductions and explicit search)");
  const ProvedModel twice(
      two_groups("hear: { send: [], terminal: true, next: again }, "
                 "again: { send: [], terminal: true, next: tell }, " +
                 tell));
  EXPECT_EQ(twice["goes_on"], "violated (reductions and explicit search)");
  EXPECT_EQ(twice["safe"], "holds (place invariants)");
}

}  // namespace
}  // namespace tessera::verify
