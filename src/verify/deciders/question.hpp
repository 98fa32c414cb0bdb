#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "net/property.hpp"
#include "verify/communication/communication.hpp"
#include "verify/subsystem_at_end.hpp"

namespace tessera::verify {

/// One thing to decide about a net. A property is one question or several.
struct Question {
  enum class Kind : std::uint8_t {
    safe,
    exclusive_channels,  ///< subjects: memories, by SharedMemory::id
    deadlock_free,
    goes_on,          ///< subjects: subsystems, by Place::subsystem
    channels_flow,    ///< subjects: channels, by Place::channel
    sound_pages,      ///< subjects: pages
    live_behaviours,  ///< subjects: places that start a behaviour
    claims            ///< claims of `property`; subjects: their numbers
  } kind = Kind::safe;
  Assume assume = Assume::conditions;
  /// The subjects of the question that are still open. The answer is yes if it is yes for each.
  /// Empty for a question about the net as a whole.
  std::vector<std::uint32_t> subjects{};
  const net::Property* property = nullptr;
};

/// Can a run show that the answer is no? No run can show that something cannot be reached.
[[nodiscard]] inline bool has_runs(const Question& question) {
  return question.kind != Question::Kind::live_behaviours &&
         (question.property == nullptr || question.property->kind != net::Property::Kind::reachable);
}

/// The result of a method for a question.
struct Finding {
  enum class Kind : std::uint8_t { holds, violated, unknown } kind = Kind::unknown;
  std::string method{};       ///< name of the method; empty: the title of the decider
  std::string why{};          ///< violated, unknown: the reason, in one line
  std::string explanation{};  ///< what the method did
  std::string hint{};         ///< violated: what would help
  /// unknown: the subjects that are still open. violated: subjects, some of which violate the property, for
  /// methods that look for a run.
  std::vector<std::uint32_t> subjects{};
  /// violated: a run that shows it, as transitions of the abstract net.
  std::vector<net::TransitionId> trace{};
  bool has_trace = false;
  std::vector<SubsystemAtEnd> waits{};
  std::string
      cut_off{};  ///< violated: what is not shown because a limit was reached: PropertyResult::cut_off
  std::uint64_t states = 0;
};

}  // namespace tessera::verify
