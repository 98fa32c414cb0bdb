#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "bag/bag_inputs.hpp"
#include "bag/bag_writer.hpp"
#include "bag/made_run.hpp"
#include "mcap/reader.hpp"

namespace {

std::string hex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) {
    text += "0123456789abcdef"[static_cast<std::uint8_t>(byte) >> 4U];
    text += "0123456789abcdef"[static_cast<std::uint8_t>(byte) & 15U];
  }
  return text;
}

/// A line per value: time, bytes; then the notes.
int print_inputs(const std::string& file) {
  using namespace tessera;
  const std::string line(80, '=');
  const std::vector<bag::WantedInput> wanted{
      {{"robot.eyes.seen", "/go", "demo/action/Go",
        "Go_Feedback feedback\nGo_Result result\n" + line + "\nMSG: demo/Go_Feedback\nfloat32 left\n" + line +
            "\nMSG: demo/Go_Result\nuint16 code\n",
        "feedback.left=left", "", ""},
       "{call: uint32, state: uint8, left: float32}",
       /*is_action=*/true}};
  std::string error;
  const auto inputs = bag::inputs_of(file, "demo", wanted, error);
  if (!inputs) return std::cout << error << '\n', 1;
  RecordingReader reader;
  reader.feed(inputs->recording);
  for (const Recording::Entry& entry : reader.recording().entries)
    std::cout << entry.event.time_ns << ' ' << hex(value_of(entry).bytes) << '\n';
  for (const std::string& note : inputs->notes) std::cout << note << '\n';
  return 0;
}

}  // namespace

/// `bags write FILE` writes a bag. `bags read FILE` prints what it reads of the bag of another program, a line per
/// message: topic, encoding, schema, time, bytes. `bags inputs FILE` prints the progress of the goals in it.
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
  if (std::strcmp(argv[1], "inputs") == 0) return print_inputs(file);
  const mcap::Condition condition = mcap::read(file, {.message = [](const mcap::ReadMessage& one) {
                                                 std::cout << one.channel.topic << ' ' << one.channel.encoding
                                                           << ' '
                                                           << (one.schema == nullptr ? "-" : one.schema->name)
                                                           << ' ' << one.message.log_ns << ' ';
                                                 std::cout << hex(one.message.data);
                                                 std::cout << '\n';
                                               }});
  if (!condition.is_whole()) std::cout << condition.told() << '\n';
  return condition.is_whole() ? 0 : 1;
}
