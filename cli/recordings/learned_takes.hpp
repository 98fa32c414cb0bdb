// The times of transition functions that recordings propose for a specification.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "replay/times/call_durations.hpp"
#include "spec/model/model.hpp"

namespace tessera::cli {

/// A behaviour as it is written once, whatever number of subsystems has it.
struct LearnedTakes {
  std::vector<std::string> names;  ///< "robot[].control.follow"; several if agents share it by a template
  diagnostics::Span span;          ///< of its name in the specification
  spec::Takes declared;
  replay::CallDurations measured;
  spec::Takes proposed{};  ///< as declared if all measured calls are within that
  std::string text{};      ///< "1.5..9 ms"; empty: nothing is to be changed

  static constexpr std::uint64_t few_calls = 100;
};

/// margin: of the shortest call that is taken away, and of the longest one that is added: 0.2. A declared time that
/// measured calls exceed becomes wider; it never becomes narrower.
[[nodiscard]] std::vector<LearnedTakes> learned_takes(const spec::Model& model,
                                                      const replay::DurationsOfBehaviours& measured,
                                                      double margin);

/// "1.5..9 ms": at most two digits of each, rounded outwards. Sets both to what they say.
[[nodiscard]] std::string takes_text(std::int64_t& shortest_ns, std::int64_t& longest_ns);

/// The files of the specification with the proposals.
struct TakesEdit {
  struct File {
    std::string name;  ///< empty: the given file; else the included one, relative to its folder
    std::string before, after;
  };
  std::vector<File> files;  ///< all that were read, also those that stay; the given one is the first
  std::string problem;      ///< why they cannot be changed; then `after` means nothing
  std::vector<std::string>
      elsewhere;  ///< proposals for behaviours that are not written as an entry of their own
};
[[nodiscard]] TakesEdit with_takes(const diagnostics::Diagnostics& specification,
                                   const std::vector<LearnedTakes>& all);

[[nodiscard]] std::string takes_table(const std::vector<LearnedTakes>& all);
[[nodiscard]] nlohmann::json takes_json(const std::vector<LearnedTakes>& all);

}  // namespace tessera::cli
