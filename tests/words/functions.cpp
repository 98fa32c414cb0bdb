#include "robot/control.hpp"
#include "robot/motor.hpp"
#include "robot/sensor.hpp"
#include "station/control.hpp"

// The transition functions of spec.yaml.
namespace small::robot::control {
void init(Context&, const Inputs&, Memory& memory, Outputs& out) {
  ++memory.count;
  out.motion = 0;
}
void follow(Context&, const Inputs& in, Memory& memory, Outputs& out) {
  ++memory.count;
  out.motion = in.line;
  out.note = memory.count;
}
void rest(Context&, const Inputs&, Memory& memory, Outputs&) { memory.count = 0; }
}  // namespace small::robot::control

namespace small::robot::sensor {
void watch(Context& context, const Inputs&, Memory&, Outputs& out) {
  out.line = static_cast<double>(context.iteration % 5);
  out.picture = out.line / 2;
}
}  // namespace small::robot::sensor

namespace small::robot::motor {
void drive(Context&, const Inputs&, Memory&, Outputs&) {}
}  // namespace small::robot::motor

namespace small::station::control {
void listen(Context&, const Inputs&, Memory&, Outputs&) {}
}  // namespace small::station::control
