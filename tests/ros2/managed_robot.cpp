// A controller whose device notes its commands in a file of two numbers, which the test maps: those that are not safe,
// and the safe ones.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>

#include "nets.hpp"
#include "tessera/main.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;
using namespace tessera;
using namespace tessera::testing;

int main(int argc, char** argv) {
  const char* const name = std::getenv("TESSERA_TEST_COMMANDS");
  const int file = name == nullptr ? -1 : open(name, O_RDWR | O_CLOEXEC);
  if (file < 0) return 3;
  void* const memory = mmap(nullptr, 2 * sizeof(std::uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (memory == MAP_FAILED) return 3;
  auto* const commands = static_cast<std::atomic<std::uint64_t>*>(memory);
  TestSystem system;
  Script motor;
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = 5; };
  system.devices.accept = [commands](double value) {
    ++commands[value == 5 ? 0 : 1];
    return access(std::getenv("TESSERA_TEST_BROKEN"), F_OK) != 0;  // while the file exists, it refuses
  };
  const auto control = system.add("robot.control", nets::nb_sender, {}, 1ms);
  const auto wheel = system.add("robot.motor", nets::b_receiver, motor, 0ms, 1min, Kind::effector);
  system.connect(control, "x", wheel, "x", buffered);
  return controller_main(system.system(), argc, argv);
}
