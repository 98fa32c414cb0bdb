#include "robot/eyes.hpp"
#include "robot/gauge.hpp"
#include "robot/legs.hpp"
#include "robot/panel.hpp"
#include "robot/voice.hpp"

namespace patrol::robot {

/// Behaviour watch of robot.eyes: what the server says of the goal.
void eyes::watch(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.progress = in.seen; }

/// Behaviour watch of robot.gauge.
void gauge::watch(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.battery = in.charge;
}

/// Behaviour watch of robot.panel: the last wish of the operator stays.
void panel::watch(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.wish = in.button; }

/// Behaviour act of robot.legs.
void legs::act(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.wanted = in.goal; }

/// Behaviour act of robot.voice.
void voice::act(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.said = in.report; }

}  // namespace patrol::robot
