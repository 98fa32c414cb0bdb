// Runs of violations that speak of what the net knows are followed by the running controller, and its recorded runs
// are legal runs of such nets.
#include <string>
#include <vector>

#include "command.hpp"

namespace tessera::cli_test {

using KnownScenarios = Command;

/// Answers of the communication, memory with few values, a group that is left in each way, sends that are skipped by a
/// condition and by the transition function.
constexpr const char* specification = R"(tessera: 1
system: asked
agents:
  a:
    control:
      rate: 10 Hz
      inputs:  { grant: bool, wish: bool }
      outputs: { ask: bool }
      parameters: { luck: { type: int32, default: 1 } }
      memory:  { mode: { values: [low, high] }, tries: { counts: 0..2 }, tired: bool, dice: uint32 }
      behaviours:
        seek:
          until: in.wish
          on_error: mend
          next: [{ to: safe, when: error }, { to: paused, when: until }, inside]
          behaviours:
            ask:
              send: { ask: { when: memory.mode == high } }
              terminal: true
              next:
                - { to: end, when: in.grant.fresh }
                - { to: ask, when: in.grant.timed_out && memory.tries != 2, sets: { tries: +1, mode: high } }
                - mend
            mend: { send: [], receive: [wish], error: memory.tired, terminal: true, next: ask }
        inside: { send: [], receive: [], terminal: true, sets: { tries: 0 }, next: seek }
        paused: { send: [], receive: [wish], terminal: true, next: seek }
        safe:   { send: [], receive: [] }
  b:
    control:
      rate: 10 Hz
      inputs:  { ask: bool }
      outputs: { grant: bool, wish: bool }
      parameters: { luck: { type: int32, default: 1 } }
      memory:  { dice: uint32 }
      behaviours:
        serve:
          send: { grant: { skip: allowed }, wish: }
          receive: [ask]
          terminal: in.ask.timed_out
          next: [{ to: doze, when: error }, doze]
        doze:  { send: [], receive: [], terminal: true, next: serve }
channels:
  - { from: a.control.ask, to: b.control.ask, receive: blocking, timeout: 300 ms }
  - { from: b.control.grant, to: a.control.grant, receive: blocking, timeout: 200 ms }
  - { from: b.control.wish, to: a.control.wish }
properties:
  - { name: fresh, never: a.control.inside }
  - { name: timed_out, never: b.control.doze }
  - { name: mode, never: a.control.memory.mode == high }
  - { name: counted, never: a.control.memory.tries == 2 }
  - { name: mended, never: a.control.seek.mend }
  - { name: paused, never: a.control.paused }
  - { name: failed, never: a.control.safe }
  - name: skipped
    never: "a.control.memory.tries == 0 and a.control.seek.ask.in and b.control.serve.rcv
            and b.control.grant -> a.control.grant.empty"
)";

constexpr const char* server = R"(#include "b/control.hpp"
namespace asked::b::control {
void serve(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const auto luck = static_cast<std::uint32_t>(context.parameters.luck);
  memory.dice = (memory.dice + 77777U * luck) * 1664525U + 1013904223U;
  out.wish = memory.dice / 1024 % 5 == 0;
  if (memory.dice / 4096 % 3 == 0) out.grant.skip();
}
void doze(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
}
)";
constexpr const char* client = R"(#include "a/control.hpp"
namespace asked::a::control {
namespace {
void throw_dice(Context& context, Memory& memory) {
  const auto luck = static_cast<std::uint32_t>(context.parameters.luck);
  memory.dice = (memory.dice + 55555U * luck) * 1664525U + 1013904223U;
  memory.tired = memory.dice / 1024 % 6 == 0;
}
}
void seek_ask(Context& context, const Inputs& in, Memory& memory, Outputs& out) { throw_dice(context, memory); }
void seek_mend(Context& context, const Inputs& in, Memory& memory, Outputs& out) { throw_dice(context, memory); }
void inside(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void paused(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void safe(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
}
)";

TEST_F(KnownScenarios, AreFollowedByTheControllerWhoseRunsAreLegal) {
  write(folder_ / "p/spec.yaml", specification);
  write(folder_ / "p/src/a/control.cpp", client);
  write(folder_ / "p/src/b/control.cpp", server);
  const auto expect_legal = [&](const std::string& recording) {
    const project::Exit checked = tessera("replay " + recording + " --check --spec p");
    EXPECT_EQ(checked.code, 0) << checked.text;
    EXPECT_EQ(checked.text.find("legal: "), 0U) << checked.text;
  };
  for (const char* property :
       {"fresh", "timed_out", "mode", "counted", "mended", "paused", "failed", "skipped"}) {
    SCOPED_TRACE(property);
    const project::Exit verified =
        tessera(std::string("verify p --property ") + property + " --scenario run.json");
    EXPECT_EQ(verified.code, 1) << verified.text;
    const project::Exit done =
        tessera("simulate p --accept-violations --scenario run.json --for 1s --record run.tsr");
    EXPECT_EQ(done.code, 0) << done.text;
    EXPECT_NE(done.text.find("end of the scenario"), std::string::npos) << done.text;
    EXPECT_EQ(done.text.find("cannot be followed"), std::string::npos) << done.text;
    expect_legal("run.tsr");
  }
  for (int luck = 2; luck < 7; ++luck) {
    const project::Exit done = tessera(
        "simulate p --accept-violations --for 60s --record luck.tsr --set luck=" + std::to_string(luck));
    EXPECT_EQ(done.code, 0) << done.text;
    expect_legal("luck.tsr");
  }
}

}  // namespace tessera::cli_test
