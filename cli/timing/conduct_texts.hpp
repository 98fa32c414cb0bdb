// Rates, waits, timeouts and `stale`, in words.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "timing/conduct.hpp"

namespace tessera::cli {

struct ConductLine {
  std::string name;  ///< the subsystem
  std::string text;
  bool is_notable = false;  ///< worth a line without --explain: a rate is not kept, something may fire
};

/// Leaves out what cannot be judged, because the specification does not say what something takes.
[[nodiscard]] std::vector<ConductLine> lines_of(const timing::Conduct& conduct,
                                                const timing::Declared& declared, const spec::Model& model);
/// {rates, waits, stale}; times in nanoseconds, null: nothing bounds them.
[[nodiscard]] nlohmann::json conduct_json(const timing::Conduct& conduct, const timing::Declared& declared,
                                          const spec::Model& model);

}  // namespace tessera::cli
