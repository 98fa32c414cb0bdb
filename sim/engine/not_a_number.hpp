#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tessera::sim {

/// The first attribute of numbers in an XML text of which one is NaN: "`kp` is NaN (line 12)". The engine says that
/// there is one, but not where. nullopt: there is none in this text.
[[nodiscard]] std::optional<std::string> not_a_number_in(std::string_view xml);

}  // namespace tessera::sim
