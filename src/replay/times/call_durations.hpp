#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tessera/recording.hpp"

/// How long transition functions take, as recordings tell.
namespace tessera::replay {

/// The calls of one behaviour of one subsystem.
struct CallDurations {
  std::uint64_t count = 0;   ///< that did not fail
  std::uint64_t failed = 0;  ///< not measured
  std::int64_t least_ns = 0, most_ns = 0;
  std::int64_t most_at_ns = 0;  ///< when the longest one began
};

/// A call of which both ends are recorded.
struct FinishedCall {
  std::uint32_t instance = 0;
  std::string_view behaviour{};            ///< of the recording's header
  std::int64_t since_ns = 0, took_ns = 0;  ///< until its devices have their commands
  bool failed = false;
};

/// Finds the calls among the entries of a recording, which come in their order.
class CallReader {
 public:
  /// The call that ends with this entry. Calls of which events are missing are left out.
  [[nodiscard]] std::optional<FinishedCall> follow(const Recording& header, const Recording::Entry& entry);

 private:
  struct OpenCall {
    std::optional<std::int64_t> since_ns{};
    std::uint32_t behaviour = 0;
    bool failed = false;
    std::optional<std::uint32_t> next_sequence{};
  };
  std::vector<OpenCall> open_;
};

/// By the path of the subsystem and the name of the behaviour.
using DurationsOfBehaviours = std::map<std::pair<std::string, std::string>, CallDurations>;

/// Adds the calls of a recording, from their beginning until their devices have their commands. Calls of which the
/// recording does not hold both ends are left out. Linear in the recording.
void add_durations(const Recording& recording, DurationsOfBehaviours& to);

/// Joins what two sources tell about the same calls, or about equal ones.
[[nodiscard]] CallDurations joined(const CallDurations& one, const CallDurations& other);

}  // namespace tessera::replay
