#include "robot/control.hpp"

#include <stdexcept>
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

void rest(Context&, const Inputs&, Memory&, Outputs&) {}

void broken(Context&, const Inputs&, Memory&, Outputs&) { throw std::runtime_error("follow has failed"); }

}  // namespace safety::robot::control
