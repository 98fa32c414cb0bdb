#include "tessera/transition_role.hpp"

#include <algorithm>
#include <array>

namespace tessera {
namespace {

// The names, in the order of the enumerators.
constexpr std::array<std::string_view, 23> step_names{
    "other",    "start_system",  "end_system",  "start_agent",     "end_agent",     "start",
    "leave",    "begin_sending", "end_sending", "begin_receiving", "end_receiving", "go_on",
    "terminal", "error",         "page",        "transfer",        "overwrite",     "skip",
    "timeout",  "deliver",       "replace",     "deliver_older",   "lose_older"};
static_assert(step_names.size() == static_cast<std::size_t>(Step::lose_older) + 1);

}  // namespace

std::string_view name_of(Step step) { return step_names[static_cast<std::size_t>(step)]; }

Step step_named(std::string_view name) {
  const auto found = std::ranges::find(step_names, name);
  return found == step_names.end() ? Step::other : static_cast<Step>(found - step_names.begin());
}

}  // namespace tessera
