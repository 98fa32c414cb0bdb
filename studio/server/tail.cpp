#include "server/tail.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

namespace tessera::server {

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string GrowingFile::more(std::size_t most) {
  if (descriptor_ < 0) descriptor_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor_ < 0) return {};
  std::string bytes(most, '\0');
  const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

TransitionMap::TransitionMap(const net::Net& net) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    by_name_.emplace_back(net.transitions()[index].name, index);
  std::ranges::sort(by_name_);
}

std::vector<std::uint32_t> TransitionMap::of(const Recording& recording) const {
  std::vector<std::uint32_t> indices;
  for (const Recording::TransitionName& one : recording.transitions) {
    const auto found =
        std::ranges::lower_bound(by_name_, one.name, {}, &decltype(by_name_)::value_type::first);
    indices.push_back(found != by_name_.end() && found->first == one.name ? found->second : UINT32_MAX);
  }
  return indices;
}

RecordingTail::RecordingTail(std::filesystem::path file, const net::Net& net)
    : file_(std::move(file)), net_(net), map_(net) {
  for (const net::Place& place : net.places()) tokens_.push_back(static_cast<std::int32_t>(place.tokens));
}

void RecordingTail::play(std::uint32_t transition) {
  const net::TransitionId id{transition};
  for (const net::Arc& arc : net_.preset(id))
    tokens_[arc.place.value] -= static_cast<std::int32_t>(arc.weight);
  for (const net::Arc& arc : net_.postset(id))
    tokens_[arc.place.value] += static_cast<std::int32_t>(arc.weight);
}

bool RecordingTail::read_header() {
  if (!reader_.has_header()) return false;
  if (!hash_.empty()) return true;
  hash_ = reader_.recording().net_hash;
  transitions_ = map_.of(reader_.recording());
  return true;
}

/// Of many firings, only the last are kept.
void RecordingTail::take(Batch& batch) {
  for (Recording::Entry& entry : std::exchange(reader_.recording().entries, {})) {
    if (entry.event.kind() != Event::Kind::firing) {
      batch.messages.emplace_back(entry.event.time_ns, std::move(entry.text));
      continue;
    }
    ++count_;
    batch.time_ns = std::max(batch.time_ns, entry.event.time_ns);
    const std::uint32_t transition = transitions_[entry.event.subject];
    if (transition == UINT32_MAX) continue;
    play(transition);
    batch.firings.emplace_back(entry.event.time_ns, transition);
  }
  // Threads write one after the other; the page shows time.
  std::ranges::stable_sort(batch.firings, {}, &decltype(batch.firings)::value_type::first);
  if (batch.firings.size() <= most_firings) return;
  const std::size_t beyond = batch.firings.size() - most_firings;
  batch.dropped += beyond;
  batch.firings.erase(batch.firings.begin(), batch.firings.begin() + static_cast<std::ptrdiff_t>(beyond));
}

std::optional<RecordingTail::Batch> RecordingTail::next() {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t piece = std::size_t{1} << 20U;
  constexpr auto patience = std::chrono::milliseconds(30);
  const Clock::time_point until = Clock::now() + patience;
  Batch batch;
  do {
    const std::string bytes = file_.more(piece);
    batch.more = bytes.size() == piece;
    if (bytes.empty()) break;
    reader_.feed(bytes);
    if (read_header()) take(batch);
  } while (batch.more && Clock::now() < until);
  const bool nothing = batch.firings.empty() && batch.dropped == 0 && batch.messages.empty() && !batch.more;
  return nothing ? std::nullopt : std::optional(std::move(batch));
}

std::vector<std::uint32_t> RecordingTail::marking() const {
  std::vector<std::uint32_t> marked;
  for (std::uint32_t place = 0; place < tokens_.size(); ++place)
    if (tokens_[place] > 0) marked.push_back(place);
  return marked;
}

}  // namespace tessera::server
