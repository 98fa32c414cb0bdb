#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/behaviours/defaults.hpp"
#include "spec/document/section.hpp"
#include "spec/model/model.hpp"

/// Groups of behaviours. After reading, a group is an element of the list of behaviours, and so is everything in it.
namespace tessera::spec {

using SlotId = Id<struct SlotTag>;  ///< into the result of slots_of

/// A behaviour or a group of the file.
struct Slot {
  const Entry* entry = nullptr;
  SlotId parent{};     ///< the group that it is in
  std::string name{};  ///< "charge.ask"
  bool is_group = false;
};

/// Groups stand in groups at most that deep.
inline constexpr std::size_t most_nested_groups = 8;

/// All behaviours and groups of a subsystem, in the order of the file: a group stands before what is in it.
///
/// Errors: E104 `behaviours` of a group is no map; E341 groups too deep in one another; E342 a group of nothing;
///         E343 two that have the same name in C++.
[[nodiscard]] std::vector<Slot> slots_of(const std::vector<Entry>& entries, Diagnostics& out);

/// The keys that it may have. Complains about those that only behaviours, or only groups, have. Errors: E344.
[[nodiscard]] std::initializer_list<std::string_view> keys_of(const Slot& slot, Diagnostics& out);

/// All keys of a group, or of a behaviour.
[[nodiscard]] std::initializer_list<std::string_view> known_keys(bool of_group);

/// The groups from the given one to the outermost, which comes first. innermost: may be none.
[[nodiscard]] std::vector<SlotId> groups_around(const std::vector<Slot>& slots, SlotId innermost);

/// The name of a behaviour that stands elsewhere in the subsystem: why it cannot be named here, and what to write.
/// parent: the group around the place that names it. Errors: E345 it is in another group, or outside of this one.
/// Returns whether it is one.
bool complain_about_place(const Node& name, SlotId parent, const std::vector<Slot>& slots, Diagnostics& out);

/// Adds the entries by which `until` of the groups around leave it, and their conditions to those that end it.
///
/// untils: of the groups around it that have one, the outermost first.
/// Precondition: its `next` has been read, and nothing has been added to it.
void add_untils(Behaviour& behaviour, const std::vector<const Expression*>& untils);

/// `until` of a group as a condition of the group itself: whether the behaviour in it that was left had found that
/// it holds. It is not evaluated again.
[[nodiscard]] Expression held_until(const Expression& until, std::string name);

/// Leads errors and failures inside of groups by `on_error` of the group, else out of the group; and finds out how
/// each group can end.
///
/// on_error: per behaviour, of groups. Errors: E101, E346 `on_error: stop` in a group. Warnings: W361.
/// Precondition: complete_next has not been called.
void complete_groups(Subsystem& subsystem, std::vector<std::optional<OnError>>& on_error, Diagnostics& out);

}  // namespace tessera::spec
