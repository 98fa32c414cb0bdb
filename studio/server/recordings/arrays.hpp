#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "replay/values.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

/// The arrays of numbers that real receptors read, such as scans and pictures, for a page that draws them.
///
/// Threads: one at a time.
class ArrayTrack {
 public:
  /// Larger arrays are never sent.
  static constexpr std::size_t largest = std::size_t{1} << 20U;

  /// A segment of the recording begins.
  void begin(const Recording& header);
  /// A value that a buffer of the recording got.
  void take(const replay::ValueTrack::Change& change);

  /// {path: base64 of the numbers, or null: it is not recorded, or too large} for the arrays that have
  /// changed since the last call, about `most` bytes of them; the others come next time.
  [[nodiscard]] nlohmann::json take_changed(std::size_t most);
  [[nodiscard]] bool has_changed() const { return !changed_.empty(); }

 private:
  std::vector<bool> is_array_;                  // per buffer
  std::map<std::string, std::string> changed_;  // by path; empty: not sent
};

}  // namespace tessera::server
