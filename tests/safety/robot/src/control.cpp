#include "robot/control.hpp"

#include <string>

#include "harm.hpp"

namespace safety::robot::control {

void follow(Context& context, const Inputs&, Memory&, Outputs& out) {
  out.motion.speed = 1;
  suffer(command_log::Place::control);
  const command_log::Log* const log = command_log::own();
  if (log == nullptr || log->harm != command_log::Harm::chatter) return;
  static const std::string line(400, '.');
  for (int count = 0; count < 10; ++count) context.log("{}", line);
}

}  // namespace safety::robot::control
