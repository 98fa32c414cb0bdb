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
  enum class PathEnd : std::uint8_t { agent, output, input, real, behaviour };

  void add(Proposal::Kind kind, const std::string& label, std::string detail = {}, std::string insert = {},
           std::string documentation = {});
  void add_names(const NamesOf& names);
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
  /// Behind `sets: { lent_to:`. false: the cursor is elsewhere.
  bool value_of_change();
  /// Behind `memory.lent_to ==`, in a condition or a property. false: the cursor is elsewhere.
  bool value_after_comparison();

  // completion_paths.cpp
  void words_of_formulas();
  static const NamesOf& ends(const UnitNames& unit, PathEnd end);
  /// fleet: the index that an agent of a fleet gets.
  void paths(PathEnd end, const std::string& fleet);
  /// The fields of the real buffer that a path names, or of a structure in it.
  void fields_of_path(const UnitNames& unit, const std::vector<std::string>& names);
  [[nodiscard]] std::vector<std::string> chain_of_key() const;
  void whole_paths(PathEnd end, const std::string& fleet);
  void add_path(const std::string& path, const std::string& detail);

  const Document& document_;
  const Index& index_;
  std::size_t cursor_, begin_ = 0, end_ = 0;  ///< begin_, end_: the word at the cursor
  std::string marked_;
  PlaceInText place_;
  const UnitNames* unit_ = nullptr;
  Way inside_;  ///< from the unit on
  std::vector<Proposal> proposals_;
  std::set<std::string> seen_;
};

}  // namespace tessera::language
