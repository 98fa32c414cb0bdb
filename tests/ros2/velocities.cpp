// Publishes a velocity at 50 Hz over Fast DDS until it is killed: the other side of examples/14_guard.
//
//     ros2_velocities DOMAIN TOPIC LINEAR_X
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "fast_peer.hpp"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  fast::Peer peer(static_cast<std::uint32_t>(std::atoi(argv[1])));
  auto* const writer = peer.writer<fast::Twist>(std::string("rt") + argv[2]);
  fast::Twist twist;
  twist.linear_x = std::atof(argv[3]);
  while (true) {
    writer->write(&twist);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}
