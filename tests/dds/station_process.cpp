// A process of the deployment of tests/dds/crossing.hpp, for tests that kill it or put it into a network of its own.
// Arguments: role, domain, incarnation, interface, peers.
#include <csignal>
#include <cstdlib>
#include <iostream>

#include "network/dds/carrier.hpp"
#include "network/dds/setup_error.hpp"
#include "tests/dds/crossing.hpp"
#include "tests/dds/heard.hpp"
#include "tests/dds/sides.hpp"

namespace {

using namespace tessera::test;
using namespace tessera;
using network::Incarnation;

constexpr std::uint64_t transfers = 300;

[[noreturn]] void stay(dds::DdsCarrier& carrier) {
  Heard heard;
  for (;;) carrier.receive(heard, std::chrono::seconds(1));
}

/// Ends when the last value was acknowledged.
int send(dds::DdsCarrier& carrier) {
  SendingSide side(carrier, Crossing::goal, Incarnation{10});
  for (std::uint64_t count = 1; count <= transfers; ++count) {
    side.write(count);
    while (side.waiting()) side.step();
  }
  std::cout << side.repetitions << " repetitions\n";
  return side.strange == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/// Ends when the sender has gone after the last value: it may not have heard that it was taken.
int read(dds::DdsCarrier& carrier) {
  ReceivingSide side(carrier, Crossing::goal, Incarnation{20});
  for (std::uint64_t count = 1;;) {
    side.step();
    const auto value = side.read();
    if (value && *value != count++) {
      std::cout << "read " << *value << ", expected " << count - 1 << '\n';
      return EXIT_FAILURE;
    }
    if (count > transfers && !side.sees_sender()) return side.strange == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
  }
}

/// Prints whether the other is heard within two seconds.
int listen(dds::DdsCarrier& carrier) {
  Heard heard;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  while (std::chrono::steady_clock::now() < end && heard.changes.empty())
    carrier.receive(heard, std::chrono::milliseconds(20));
  std::cout << (heard.changes.empty() && heard.complaints.empty() ? "silence" : "heard") << '\n';
  return EXIT_SUCCESS;
}

int run(const std::vector<std::string>& arguments) {
  const std::string& role = arguments.at(0);
  Crossing crossing;
  crossing.domain = std::stoi(arguments.at(1));
  crossing.interface = arguments.at(3);
  for (std::size_t at = 4; at < arguments.size(); ++at) crossing.peers.push_back(arguments[at]);
  const bool is_office = role == "send" || role == "listen";
  dds::DdsCarrier carrier(
      crossing.setup(is_office ? Crossing::office : Crossing::cart, std::stoull(arguments.at(2))));
  if (role == "send") return send(carrier);
  if (role == "read") return read(carrier);
  if (role == "listen") return listen(carrier);
  stay(carrier);
}

}  // namespace

int main(int count, char** values) {
  std::signal(SIGALRM, SIG_DFL);
  alarm(100);  // it does not outlive its test for long
  try {
    return run({values + 1, values + count});
  } catch (const std::exception& error) {
    std::cout << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
