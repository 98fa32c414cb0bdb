#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "bag/bag_writer.hpp"
#include "bag/made_run.hpp"
#include "mcap/reader.hpp"

/// `bags write FILE` writes a bag. `bags read FILE` prints what it reads of the bag of another program, a line per
/// message: topic, encoding, schema, time, bytes.
int main(int argc, char** argv) {
  using namespace tessera;
  if (argc != 3) return 2;
  if (std::strcmp(argv[1], "write") == 0) {
    const Recording recording = bag::test::made_recording();
    bag::BagWriter writer(recording, bag::test::background(), "a test");
    for (const Recording::Entry& entry : recording.entries) {
      writer.add(entry);
      if (entry.event.kind() == Event::Kind::poses) writer.close_chunk();
    }
    writer.end(0);
    writer.finish();
    std::ofstream(argv[2], std::ios::binary) << writer.take();
    return 0;
  }
  std::ifstream stream(argv[2], std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(stream), {}};
  const mcap::Condition condition = mcap::read(
      file, {.message = [](const mcap::ReadMessage& one) {
        std::cout << one.channel.topic << ' ' << one.channel.encoding << ' '
                  << (one.schema == nullptr ? "-" : one.schema->name) << ' ' << one.message.log_ns << ' ';
        for (const char byte : one.message.data)
          std::cout << "0123456789abcdef"[static_cast<std::uint8_t>(byte) >> 4U]
                    << "0123456789abcdef"[static_cast<std::uint8_t>(byte) & 15U];
        std::cout << '\n';
      }});
  if (!condition.is_whole()) std::cout << condition.told() << '\n';
  return condition.is_whole() ? 0 : 1;
}
