#include "robot/control.hpp"

#include <string>

#include "harm.hpp"

namespace safety::robot::control {

void follow(Context& context, const Inputs&, Memory& memory, Outputs& out) {
  out.motion.speed = 1;
  suffer(command_log::Place::control);
  command_log::Log* const log = command_log::own();
  if (log == nullptr) return;
  if (log->harm == command_log::Harm::mute) {
    memory.mute = true;
    log->harm = command_log::Harm::none;
    log->struck_ns = command_log::now_ns();
  }
  if (log->harm != command_log::Harm::chatter) return;
  static const std::string line(400, '.');
  for (int count = 0; count < 10; ++count) context.log("{}", line);
}

}  // namespace safety::robot::control
