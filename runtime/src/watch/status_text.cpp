#include "watch/status_text.hpp"

#include <algorithm>
#include <utility>

namespace tessera {
namespace {

/// An operator may type a reason of any length, but the brief text fits into one packet.
constexpr std::size_t longest_reason = 300;

/// Leaves out the second half of the longest list. false: all are empty.
[[nodiscard]] bool shorten(Snapshot& snapshot) {
  const std::size_t longest = std::max(
      {snapshot.subsystems.size(), snapshot.waits.size(), snapshot.links.size(), snapshot.chains.size()});
  const auto halve = [&](auto& list) {
    if (list.size() < longest) return false;
    snapshot.left_out += list.size() - list.size() / 2;
    list.resize(list.size() / 2);
    return true;
  };
  return longest > 0 && (halve(snapshot.subsystems) || halve(snapshot.links) || halve(snapshot.waits) ||
                         halve(snapshot.chains));
}

}  // namespace

StatusTexts status_texts(Snapshot snapshot, std::size_t most_bytes) {
  snapshot.channels.clear();
  snapshot.recording.reset();
  snapshot.deployment.reset();
  if (snapshot.emergency) snapshot.emergency->resize(std::min(snapshot.emergency->size(), longest_reason));
  for (Snapshot::Subsystem& one : snapshot.subsystems) one.memory.clear();
  StatusTexts texts;
  texts.whole = line_of(snapshot);
  while (texts.whole.size() > most_bytes && shorten(snapshot)) texts.whole = line_of(snapshot);
  snapshot.subsystems.clear();
  snapshot.waits.clear();
  snapshot.links.clear();
  snapshot.chains.clear();
  snapshot.left_out = 0;
  snapshot.brief = true;
  texts.brief = line_of(snapshot);
  return texts;
}

}  // namespace tessera
