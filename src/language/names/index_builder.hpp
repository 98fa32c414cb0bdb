#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "language/names/code.hpp"
#include "language/names/index.hpp"
#include "language/names/kinds.hpp"

namespace tessera::language {

/// Walks the outline twice: first the definitions, then the uses.
class IndexBuilder {
 public:
  IndexBuilder(std::string_view text, const Node& root, Index& index)
      : text_(text), root_(root), index_(index) {}
  void build();

 private:
  // definitions.cpp
  SymbolId define(Kind kind, const Entry& entry, SymbolId owner, Way way, const std::string& above);
  void define_all(const Node& map, Kind kind, SymbolId owner, const Way& way, const std::string& above,
                  NamesOf& names);
  void define_types();
  void define_agents(const char* section, Kind kind, NamesOf& names);
  void define_unit(DefinitionNames& definition, const Entry& entry, SubsystemRole role, const Way& above);
  /// The values of the memory cells of a unit, and the names of their enumerations.
  void define_values(UnitNames& unit, const Node& memory, const std::string& path);
  /// Defines what is in the map `behaviours` of the subsystem, or of a group. around: the groups around it.
  void define_behaviours(UnitNames& unit, const Node& map, const std::vector<SymbolId>& around);
  void define_conditions(UnitNames& unit, const Entry& behaviour, SymbolId owner);
  /// Fleets whose members are values of memory cells.
  void define_member_values();

  // group_templates.cpp
  void define_group_template(const Entry& entry, SymbolId id);
  /// Gives a unit the behaviours of the templates that its groups use. inside: the groups around `map`.
  void link_templates(UnitNames& unit, const Node& map, const std::vector<SymbolId>& inside);
  /// inside: the groups down to the one that uses `from`.
  void link_template(UnitNames& unit, const GroupTemplateNames& from, const std::vector<SymbolId>& inside);
  void link_group(UnitNames& unit, const UnitNames& from, SymbolId group,
                  const std::vector<SymbolId>& inside);
  void link_all();
  void use_in_templates();
  /// `use` of a group, its `with`, and what the text of the template means in this unit.
  void use_template(const UnitNames& unit, const Entry& behaviour, SymbolId group);
  /// The names that a template takes, in its text.
  void use_taken(const Node& node, const NamesOf& taken, bool gives);
  void use_taken(Extent extent, const NamesOf& taken);
  /// Finds the names that units which use templates have in common.
  void share_names();
  /// The words of an expression at their places in the file, each name of a template replaced by what stands for it.
  [[nodiscard]] std::vector<Token> words_of_expression(const Node& text) const;

  // uses.cpp
  void use(Extent extent, const NamesOf& names, std::string_view name);
  void use(const Node& scalar, const NamesOf& names);
  /// Buffers of `send` or `receive`, or changes of the list of the subsystem: [+request, -grip].
  void use_list(const Node& list, const NamesOf& names);
  /// "+request"
  void use_signed(Extent at, std::string_view text, const NamesOf& names);
  /// `terminal`, `error`, and `when` of an output: an expression, the name of a shared one, or a map of both.
  void use_condition(const UnitNames& unit, const Node& condition);
  void use_type(const Node& value);
  /// "each robot", in `whole`, which begins at byte `at` of the file.
  void use_each(std::size_t at, std::string_view whole);
  void use_types();
  void use_in_unit(UnitNames& unit);
  /// `on_error` of the system and of agents: the behaviour of the first subsystem that does not say it itself.
  void use_on_errors();
  /// The keys of a map that is a value of a structure.
  void use_fields(const Node& value, const std::string& type);
  void use_limit(const UnitNames& unit, const Entry& limit);
  /// The bytes of the file: several lines and escapes as they stand there.
  [[nodiscard]] std::string_view written(Extent extent) const;
  static Extent moved(Extent extent, std::size_t by);
  /// group: in which the behaviours stand; none: the subsystem.
  void use_in_behaviours(const UnitNames& unit, const Node& map, SymbolId group, std::size_t depth);
  void use_in_behaviour(const UnitNames& unit, const Entry& behaviour, SymbolId group);
  /// `sets: { lent_to: a }`
  void use_sets(const UnitNames& unit, const Node& sets);
  void use_expression(const UnitNames& unit, const Node& text);

  // uses_in_paths.cpp
  void paths(Extent extent, Place place);
  void paths(const Node& scalar, Place place);
  /// The values with which the path can be compared; nullptr: it leads to no memory cell with values.
  const NamesOf* use_path(const DottedPath& path, std::size_t base, Place place);
  const NamesOf* use_memory_path(const UnitNames& unit, const DottedPath& path, std::size_t base);
  void use_in_channels();
  void use_in_drivers(const Node& drivers);
  void use_in_deployment();
  void use_in_formulas();
  void use_in_chains();
  /// Objects that are models placed in the world; others are bodies of its file.
  void use_in_world(const Node& simulation);
  void sort_uses();

  /// The text that a `with` gives for a name.
  struct Given {
    std::string text;
    std::size_t at = 0;
    bool is_written = false;  ///< exactly so, from byte `at` on
  };
  using Givens = std::map<std::string, Given, std::less<>>;
  [[nodiscard]] Givens givens_of(const Node& with) const;

  std::string_view text_;
  const Node& root_;
  Index& index_;
  std::map<std::size_t, SymbolId> defined_at_;  ///< an alias repeats definitions of its anchor
  std::set<const Node*> walked_;                ///< `behaviours` of groups
  std::vector<const Node*> nodes_;              ///< the bodies of the units, in their order
  std::size_t next_node_ = 0;
  std::map<SymbolId, std::string> used_templates_;              ///< by group
  std::map<std::string, std::vector<const UnitNames*>> users_;  ///< of templates
  bool in_template_ = false;                                    ///< while a template is defined
  const Givens* givens_ = nullptr;           ///< while the text of a template is read for a unit
  std::vector<std::string> open_templates_;  ///< that are being read, so that circles end
  std::size_t expansions_ = 0;               ///< of templates, so that many uses of each other end
};

}  // namespace tessera::language
