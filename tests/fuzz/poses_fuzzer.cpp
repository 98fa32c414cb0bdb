#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "tessera/poses.hpp"

/// Whatever the frames are, they are refused or give poses that can be encoded, and that are the same after
/// it. The first byte is the number of bodies; each frame has its length in front of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t bodies = data[0];
  std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  tessera::PoseDecoder decoder(bodies), again(bodies);
  tessera::PoseEncoder encoder(bodies);
  for (std::int64_t time_ns = 0; !rest.empty(); time_ns += tessera::pose_period.count()) {
    const std::size_t length = static_cast<std::uint8_t>(rest.front());
    rest.remove_prefix(1);
    const std::string_view frame = rest.substr(0, length);
    rest.remove_prefix(frame.size());
    if (!decoder.take(frame) && decoder.known()) std::abort();
    if (!decoder.known()) continue;
    const std::string_view made = encoder.encode(time_ns, decoder.poses());
    if (made.size() > tessera::PoseEncoder::longest_frame(bodies)) std::abort();
    if (!made.empty() && !again.take(made)) std::abort();
    for (std::size_t body = 0; body < bodies; ++body) {
      const auto &one = decoder.poses()[body].steps, &other = again.poses()[body].steps;
      const bool same = one == other;
      bool opposite = true;  // the same rotation
      for (std::size_t at = 0; at < one.size(); ++at)
        opposite = opposite && (at < 3 ? one[at] == other[at] : one[at] == -other[at]);
      if (!same && !opposite) std::abort();
    }
  }
  return 0;
}
