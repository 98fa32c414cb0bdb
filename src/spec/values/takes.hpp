#pragma once

#include <optional>
#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

/// The times that calls take, and the amounts that behaviours use.
namespace tessera::spec {

/// Reads a range of times (read_time_range), `{ normal: [2 ms, 0.3 ms], within: 1..3 ms }`, or `{ measured: run.tsr,
/// within: 1..3 ms }`. The recording is not opened.
/// Errors: as read_time_range; E102, E103, E104, E107 keys; E384 a normal distribution with its mean outside.
[[nodiscard]] std::optional<Takes> read_takes(const Node& node, Span at, Diagnostics& out);

/// Reads `uses: { energy: 12 W, bandwidth: 3 MB/s }`. entry may be null.
/// Errors: E104, E205 no number; E206 negative or too large; E386 no amount per time.
[[nodiscard]] std::vector<ResourceUse> read_uses(const Entry* entry, Diagnostics& out);

/// Reads the `200 J` of `at_most: { energy: 200 J }`, the most that a run may use; nullopt after an error. The result
/// lacks its name.
/// Errors: E104, E205 no number; E206 negative or too large.
[[nodiscard]] std::optional<UseCheck> read_most_use(const Entry& entry, Diagnostics& out);

/// Compares the units of each resource in all behaviours and checks.
/// Errors: E386 different units, or a check of something that no behaviour uses.
void check_uses(const Model& model, Diagnostics& out);

}  // namespace tessera::spec
