#include "robots.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "blocks.hpp"
#include "nets/flat_net.hpp"

namespace tessera::benchmarks {
namespace nets {
namespace {

constexpr Behaviour run_only[] = {{"run"}};
constexpr Behaviour take_give[] = {{"take"}, {"give"}};
constexpr Port sends_x[] = {{"x", Side::send, "value"}};
constexpr Port receives_x[] = {{"x", Side::receive, "value"}};
constexpr Port both[] = {{"in", Side::receive, "value"}, {"out", Side::send, "value"}};

#define RUN_PLACES {"in"}, {"out"}, BEHAVIOUR_PLACES("run")
#define RUN ENTER("run"), BEHAVIOUR_TRANSITIONS("run"), NEXT_END("run", 0)
#define SND(block, p) block("run", p, "run.snd.in", "run.snd.out")
#define RCV(block, p) block("run", p, "run.rcv.in", "run.rcv.out")

constexpr named::Place alone_places[] = {RUN_PLACES};
constexpr named::Place sender_places[] = {RUN_PLACES, SEND_PLACES("run", "x")};
constexpr named::Place receiver_places[] = {RUN_PLACES, RECEIVE_PLACES("run", "x")};
constexpr named::Place patient_sender_places[] = {RUN_PLACES, SEND_PLACES("run", "x"),
                                                  WAIT_PLACE("run", "x")};
constexpr named::Place relay_places[] = {RUN_PLACES, SEND_PLACES("run", "out"), RECEIVE_PLACES("run", "in")};
constexpr named::Place asker_places[] = {RUN_PLACES, SEND_PLACES("run", "out"), WAIT_PLACE("run", "out"),
                                         RECEIVE_PLACES("run", "in")};
constexpr named::Place answerer_places[] = {{"in"},
                                            {"out"},
                                            BEHAVIOUR_PLACES("take"),
                                            RECEIVE_PLACES("take", "in"),
                                            BEHAVIOUR_PLACES("give"),
                                            SEND_PLACES("give", "out"),
                                            WAIT_PLACE("give", "out")};
const named::Transition alone_transitions[] = {RUN, NO_SEND("run"), NO_RECEIVE("run")};
const named::Transition sender_transitions[] = {RUN, SND(ASYNC_SEND, "x"), NO_RECEIVE("run")};
const named::Transition receiver_transitions[] = {RUN, NO_SEND("run"), RCV(ASYNC_RECEIVE, "x")};
const named::Transition patient_sender_transitions[] = {RUN, SND(B_SEND, "x"), NO_RECEIVE("run")};
const named::Transition patient_receiver_transitions[] = {RUN, NO_SEND("run"), RCV(B_RECEIVE_ACK, "x")};
const named::Transition relay_transitions[] = {RUN, SND(ASYNC_SEND, "out"), RCV(ASYNC_RECEIVE, "in")};
const named::Transition asker_transitions[] = {RUN, SND(B_SEND, "out"), RCV(B_RECEIVE_ACK, "in")};
const named::Transition answerer_transitions[] = {ENTER("take"),
                                                  BEHAVIOUR_TRANSITIONS("take"),
                                                  NO_SEND("take"),
                                                  B_RECEIVE_ACK("take", "in", "take.rcv.in", "take.rcv.out"),
                                                  NEXT("take", 0, "give"),
                                                  BEHAVIOUR_TRANSITIONS("give"),
                                                  B_SEND("give", "out", "give.snd.in", "give.snd.out"),
                                                  NO_RECEIVE("give"),
                                                  NEXT("give", 0, "take")};

}  // namespace

const SubsystemNet alone = testing::numbered(run_only, {}, alone_places, alone_transitions);
const SubsystemNet sender = testing::numbered(run_only, sends_x, sender_places, sender_transitions);
const SubsystemNet receiver = testing::numbered(run_only, receives_x, receiver_places, receiver_transitions);
const SubsystemNet patient_sender =
    testing::numbered(run_only, sends_x, patient_sender_places, patient_sender_transitions);
const SubsystemNet patient_receiver =
    testing::numbered(run_only, receives_x, receiver_places, patient_receiver_transitions);
const SubsystemNet relay = testing::numbered(run_only, both, relay_places, relay_transitions);
const SubsystemNet asker = testing::numbered(run_only, both, asker_places, asker_transitions);
const SubsystemNet answerer = testing::numbered(take_give, both, answerer_places, answerer_transitions);

}  // namespace nets

namespace {

Call* call_in_use = nullptr;
std::uint32_t made = 0;

struct Inputs {
  Input<Payload> value;
};
struct Outputs {
  Output<Payload> value;
};
struct Empty {};
struct PlainContext : Context {
  explicit PlainContext(const Empty&) {}
};

class Part final : public SubsystemOf<Inputs, Empty, Outputs, Empty, PlainContext> {
 public:
  Part() : number_(made++) {}
  void bind(Bindings& bindings) override {
    bindings.input("value", in.value);
    bindings.output("value", out.value);
  }
  void call(std::uint16_t) override {
    if (*call_in_use) (*call_in_use)(number_, context_);
  }
  Outcome decide(std::uint16_t behaviour, bool failed) override {
    if (failed) return Outcome::error;
    return several_ || behaviour != 0 ? Outcome::terminal : Outcome::go_on;
  }
  int route(std::uint16_t, bool) override { return 0; }
  void has_several_behaviours() { several_ = true; }

 private:
  std::uint32_t number_;
  bool several_ = false;
};

std::unique_ptr<Subsystem> make_one() { return std::make_unique<Part>(); }
std::unique_ptr<Subsystem> make_changing() {
  auto part = std::make_unique<Part>();
  part->has_several_behaviours();
  return part;
}

}  // namespace

Robot::Robot(Call call) {
  static Call kept;
  kept = std::move(call);
  call_in_use = &kept;
}

Robot::~Robot() { call_in_use = nullptr; }

std::uint32_t Robot::add(const SubsystemNet& net, Duration period, int cpu) {
  const auto index = static_cast<std::uint32_t>(instances_.size());
  const std::string& name =
      *names_.emplace_back(std::make_unique<std::string>("part" + std::to_string(index)));
  instances_.push_back({"robot", name, Kind::control, &net,
                        net.behaviours.size() == 1 ? make_one : make_changing, period, Duration{0}});
  instances_.back().policies.realtime.cpu = cpu;
  return index;
}

void Robot::connect(std::uint32_t from, std::string_view out, std::uint32_t to, std::string_view in,
                    std::span<const FusedPlace> places) {
  const std::string& name =
      *names_.emplace_back(std::make_unique<std::string>("channel" + std::to_string(channels_.size())));
  const auto end = [&](std::uint32_t instance, std::string_view port) {
    return End{instance, named::number_of(instances_[instance].net->ports, port)};
  };
  channels_.push_back({name, end(from, out), end(to, in), places});
}

void Robot::measure_ages() {
  static constexpr std::initializer_list<std::uint32_t> first{0}, both{0, 1};
  chain_ways_ = {{0, channels_.size() == 1 ? first : both}};
}

RunSummary Robot::run(RunOptions options) {
  made = 0;
  options.clock = RunOptions::Clock::steady;
  System system{tables_version,        "measured",           "", "", {}, instances_, channels_,
                &testing::system_page, &testing::agent_page, {}, {}};
  constexpr std::array chains{Chain{"measured", std::chrono::hours(1), std::chrono::hours(1)}};
  system.chains = chains;
  system.chain_ways = chain_ways_;
  const std::string hash = net_of(system).hash();
  system.net_hash = hash;
  std::string error;
  const std::optional<RunSummary> summary = execute(system, options, error);
  if (summary && !summary->failed) return *summary;
  std::fprintf(stderr, "%s\n", summary ? summary->ended.c_str() : error.c_str());
  std::abort();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace tessera::benchmarks
