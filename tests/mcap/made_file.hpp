#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mcap/reader.hpp"
#include "mcap/writer.hpp"

/// A file with two channels, and what was read from it.
namespace tessera::mcap::test {

inline std::string text_of(std::uint64_t number) {
  return "message " + std::to_string(number) + " of a file that is read again";
}

/// Chunk n holds the messages 3n to 3n + 2, alternately of both channels.
inline std::string made_file(std::uint64_t chunks) {
  Writer writer("", "a test");
  const std::uint16_t schema = writer.add_schema("Text", "jsonschema", R"({"type": "object"})");
  const std::uint16_t a = writer.add_channel({0, schema, "/a", "json", {{"buffer", "robot.a"}}});
  const std::uint16_t b = writer.add_channel({0, 0, "/b", "x-test", {}});
  writer.attach({0, "spec.yaml", "text/yaml", "system: nothing\n"});
  std::string file = writer.take();
  for (std::uint64_t number = 0; number < 3 * chunks; ++number) {
    writer.write(number % 2 == 0 ? a : b, 1000 * number, 1000 * number + 1, text_of(number));
    if (number % 3 == 2) writer.close_chunk();
    file += writer.take();
  }
  writer.add_metadata({"run", {{"clock", "simulated"}}});
  writer.finish();
  return file + writer.take();
}

struct Contents {
  Condition condition;
  std::vector<std::string> messages;  ///< "/a: text"
  std::vector<std::string> attachments, metadata;
  std::uint64_t gaps = 0;
};

inline Contents contents_of(std::string_view file) {
  Contents contents;
  contents.condition =
      read(file, {.message =
                      [&](const ReadMessage& one) {
                        contents.messages.push_back(one.channel.topic + ": " + std::string(one.message.data));
                      },
                  .attachment =
                      [&](const Attachment& one) {
                        contents.attachments.push_back(one.name + ": " + std::string(one.data));
                      },
                  .metadata = [&](const Metadata& one) { contents.metadata.push_back(one.name); },
                  .gap = [&] { ++contents.gaps; }});
  return contents;
}

inline std::string message(std::uint64_t number) {
  return (number % 2 == 0 ? "/a: " : "/b: ") + text_of(number);
}

}  // namespace tessera::mcap::test
