#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tessera/recording.hpp"

namespace tessera::server {

/// Something that a recording says in words: {"t", "kind", "who", "text", "level"} of docs/reference/studio.md.
/// nullopt: the entry is a firing, a call, a value, or a part of the file itself.
[[nodiscard]] std::optional<nlohmann::json> notice_of(const Recording& header, const Recording::Entry& entry);

/// The notices of a run in the order of the recording: of each kind the last ones, so that a subsystem that
/// overruns at every instant hides no fault.
class Notices {
 public:
  explicit Notices(std::size_t most_of_a_kind) : most_(most_of_a_kind) {}

  void add(nlohmann::json notice);
  /// {"notices": [...], "dropped": number}: all that are kept.
  [[nodiscard]] nlohmann::json kept() const;
  /// The same, and forgets them; null: there are none.
  [[nodiscard]] nlohmann::json take();

 private:
  std::size_t most_;
  std::map<std::string, std::deque<nlohmann::json>> by_kind_;
  std::uint64_t dropped_ = 0;
};

}  // namespace tessera::server
