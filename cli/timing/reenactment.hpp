// A run that makes the times of a scenario again, and whether it does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "spec/model/model.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli {

/// The times that a scenario promises of a chain.
struct PromisedTimes {
  std::string chain;
  bool is_age = false;
  std::int64_t from_ns = 0, to_ns = 0;
};
/// nullopt: the file is no scenario of times; the controller says what is wrong with it.
[[nodiscard]] std::optional<PromisedTimes> promised_times(const std::filesystem::path& scenario);

struct Reenactment {
  std::string
      text;  ///< one line: "line to wheels: reaction 142 ms, from 0.08 s to 0.222 s, as in the scenario"
  bool is_same = false;
};
/// Measures the chain in the recording of the run.
[[nodiscard]] Reenactment compare(const PromisedTimes& promised, const Recording& recording,
                                  const spec::Model& model);

}  // namespace tessera::cli
