#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "language/language.hpp"
#include "language/questions/place.hpp"

namespace tessera::language {

/// Finds the texts that may stand at the cursor.
class Completer {
 public:
  Completer(const Document& document, Position position);
  std::vector<Proposal> complete();

 private:
  static constexpr std::size_t most_proposals = 1000;
  /// The element that a path in a text leads to.
  enum class PathEnd : std::uint8_t { agent, subsystem, output, input, real, behaviour };

  void add(Proposal::Kind kind, const std::string& label, std::string detail = {}, std::string insert = {},
           std::string documentation = {});
  /// A name of which there is one for each member of a fleet.
  enum class Form : std::uint8_t {
    name,    ///< all of them: request
    member,  ///< of one: request[i]
    either
  };
  void add_names(const NamesOf& names, Form form = Form::name);
  /// In quotes where YAML would read its brackets as a list.
  [[nodiscard]] std::string quoted_if_needed(const std::string& text) const;
  [[nodiscard]] const std::string& step(std::size_t at) const;
  [[nodiscard]] bool colon_follows() const;
  void keys(const Way& way);
  /// Keys that are names of the specification.
  void key_names(const Way& way);
  /// Whether the cursor's scalar is the first thing of its line, so that a key may stand there.
  [[nodiscard]] bool begins_line() const;
  void value();
  bool special_value();
  [[nodiscard]] bool is_type_place() const;
  void types();
  bool channel_value(const std::string& last);
  bool value_in_unit();
  // completion_groups.cpp
  /// Leaves the groups around out of `inside_`: ["behaviours", "ask", "next"].
  void leave_groups();
  /// Whether a key of behaviours may stand in the map at the cursor: a group has other keys.
  [[nodiscard]] bool fits(const std::string& key) const;
  /// Behind `start`, `on_error` and `until` of a group. false: the cursor is elsewhere.
  bool value_of_group();
  /// Whether the cursor is in a template of a group.
  [[nodiscard]] bool in_group_template() const;
  void templates(bool of_groups);
  /// The names that the template takes which the behaviour at the cursor uses.
  void names_to_give();
  /// Behind `use`, and in `with`. false: the cursor is elsewhere.
  bool value_of_template();
  /// each robot
  void each_fleet();
  /// The index of the members for which the cursor's behaviour is; empty: it is for none.
  [[nodiscard]] std::string own_fleet() const;
  /// any(...), count(...)
  void functions_of_members();

  void stop();
  /// Behind + only what the subsystem does not list, behind - only what it lists.
  void buffers(const std::string& key);
  /// Proposes the behaviours of the subsystems in the system or in an agent.
  void on_error();
  /// The names before the cursor that dots join: {"in", "line"} of "a + in.line.le".
  [[nodiscard]] std::vector<std::string> chain() const;
  void expression();
  void states_of_buffer(bool input);

  // completion_memory.cpp
  /// The memory cells with few values.
  [[nodiscard]] NamesOf kept_cells(const UnitNames& unit) const;
  void values_of_cell(const UnitNames& unit, const std::string& cell);
  /// The memory cells with a goal.
  [[nodiscard]] NamesOf goals(const UnitNames& unit) const;
  /// Behind `orders:`, and behind `goal:` or `progress:` of a memory cell. false: the cursor is elsewhere.
  bool value_of_goal();
  /// Behind `sets: { lent_to:`. false: the cursor is elsewhere.
  bool value_of_change();
  /// Behind `memory.lent_to ==`, in a condition or a property. false: the cursor is elsewhere.
  bool value_after_comparison();

  // completion_paths.cpp
  void words_of_formulas();
  static const NamesOf& ends(const UnitNames& unit, PathEnd end);
  /// fleet: the index that an agent of a fleet gets.
  void paths(PathEnd end, const std::string& fleet);
  /// The names, with an index where there is one for each member of a fleet.
  void members_of_fleets(const NamesOf& names, const std::string& index);
  /// The behaviours in the group that a path names.
  void behaviours_in_path(const UnitNames& unit, const std::vector<std::string>& names);
  /// Proposes what the net knows of the last communication of a buffer, in a property.
  void outcomes_of(const UnitNames& unit, const std::string& buffer);
  /// The fields of the real buffer that a path names, or of a structure in it.
  void fields_of_path(const UnitNames& unit, const std::vector<std::string>& names);
  [[nodiscard]] std::vector<std::string> chain_of_key() const;
  void whole_paths(PathEnd end, const std::string& fleet);
  void paths_in_group(const UnitNames& unit, SymbolId group, const std::string& path, std::size_t depth);
  void add_path(const std::string& path, const std::string& detail);

  const Document& document_;
  const Index& index_;
  std::size_t cursor_, begin_ = 0, end_ = 0;  ///< begin_, end_: the word at the cursor
  std::string marked_;
  PlaceInText place_;
  const UnitNames* unit_ = nullptr;
  Way inside_;                      ///< from the unit on, without the groups around
  SymbolId group_{}, behaviour_{};  ///< at the cursor: the innermost group, and the behaviour or group in it
  bool in_list_ = false;            ///< of behaviours: the cursor is where one of their names stands
  std::vector<Proposal> proposals_;
  std::set<std::string> seen_;
};

}  // namespace tessera::language
