#include "ros2/tf/taken_stamps.hpp"

#include <map>

#include "ros2/codec/cdr.hpp"

namespace tessera::ros2 {

std::shared_ptr<TakenStamp> TakenStamp::of(const std::string& path) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<TakenStamp>> known;
  const std::lock_guard lock(mutex);
  std::weak_ptr<TakenStamp>& one = known[path];
  std::shared_ptr<TakenStamp> shared = one.lock();
  if (shared == nullptr) one = shared = std::make_shared<TakenStamp>();
  return shared;
}

void TakenStamp::set(const Stamp& stamp) {
  const std::lock_guard lock(mutex_);
  newest_ = {newest_.number + 1, stamp};
}

TakenStamp::Numbered TakenStamp::newest() {
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::optional<Stamp> stamp_of_header(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  Stamp stamp;
  stamp.sec = reader->number<std::int32_t>();
  stamp.nanosec = reader->number<std::uint32_t>();
  return reader->ok() ? std::optional(stamp) : std::nullopt;
}

}  // namespace tessera::ros2
