#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "language/names/code.hpp"
#include "language/schema/grammar.hpp"
#include "language/text/outline.hpp"
#include "tessera/ids.hpp"

/// The names of a specification: what each is, and everywhere that it is used.
namespace tessera::language {

using SymbolId = Id<struct SymbolTag>;

enum class Kind : std::uint8_t {
  type,
  field,
  parameter,
  memory,
  value,
  input,
  output,
  real,
  behaviour,
  condition,
  subsystem,
  agent,
  agent_template,
  model,
  process,
  taken  ///< a name that a template of a group takes by `with`
};
/// In words: "input buffer".
[[nodiscard]] std::string_view words_of(Kind kind);
/// The word that tells a name from others of its path: "input"; "" if none is needed.
[[nodiscard]] std::string_view prefix_of(Kind kind);

struct Symbol {
  Kind kind = Kind::type;
  std::string name;
  std::string path;       ///< for people: "robot.control.line"
  std::string type;       ///< of data: "float64 m/s"; empty: it has none
  std::string fleet;      ///< there is one for each member of that fleet; empty: it is one
  bool is_group = false;  ///< a behaviour that has behaviours, or a template of one
  Extent definition;      ///< the name itself
  Extent whole;           ///< with everything that belongs to it
  SymbolId owner{};
  Way way;  ///< of its value
};

/// In words: "input buffer", "group of behaviours".
[[nodiscard]] std::string_view words_of(const Symbol& symbol);

struct Use {
  Extent extent;
  SymbolId symbol{};
  bool defines = false;
};

enum class SubsystemRole : std::uint8_t { control, receptor, effector };

using NamesOf = std::map<std::string, SymbolId, std::less<>>;

/// A subsystem of a definition, with the names that its functions and conditions may use.
struct UnitNames {
  SymbolId symbol{};
  SubsystemRole role = SubsystemRole::control;
  std::string name;
  Way way;
  NamesOf inputs, outputs, memory, real, parameters;
  NamesOf behaviours;                  ///< and groups, of the subsystem itself
  std::map<SymbolId, NamesOf> groups;  ///< by group: the behaviours and groups in it
  /// By function in C++, "charge_ask": the groups around its behaviour, the outermost first, and the behaviour.
  std::map<std::string, std::vector<SymbolId>, std::less<>> functions;
  NamesOf shared;  ///< `conditions`, which several behaviours may name
  /// By memory cell with values. A fleet stands for the values of its members: `robot[0]`.
  std::map<std::string, NamesOf, std::less<>> values;
  std::map<SymbolId, NamesOf> conditions;  ///< by behaviour: named expressions, also shared ones

  /// The behaviours and groups in a group; none: of the subsystem itself.
  [[nodiscard]] const NamesOf& behaviours_in(SymbolId group) const;
  /// All behaviours and groups, a group before what is in it.
  [[nodiscard]] std::vector<SymbolId> all_behaviours() const;
};

/// A place in a behaviour, a group, or in `behaviours` of one.
struct PlaceInBehaviours {
  SymbolId group;          ///< the innermost group around the behaviour; none: the subsystem
  SymbolId behaviour;      ///< or group; none: it is unknown, or the place is before its name
  std::size_t inside = 0;  ///< where the way goes on behind the name of the behaviour
};

/// An agent described in full, or a template.
struct DefinitionNames {
  SymbolId symbol{};
  std::string name;
  std::vector<UnitNames> units;
};

/// A template of a group, with the names that its text may use: its own, and those that all subsystems that use it have.
struct GroupTemplateNames {
  UnitNames unit;  ///< without functions
  NamesOf taken;   ///< by `with`
};

/// A word that means something else in each subsystem that uses the template it is in.
struct SharedWord {
  Extent extent;
  std::vector<SymbolId> symbols;
};

class Index {
 public:
  /// text: of which `outline` is.
  Index(std::string_view text, const Outline& outline);

  [[nodiscard]] const Numbered<SymbolId, Symbol>& symbols() const { return symbols_; }
  [[nodiscard]] const Symbol& operator[](SymbolId id) const { return symbols_[id]; }
  /// By position, without duplicates.
  [[nodiscard]] const std::vector<Use>& uses() const { return uses_; }
  /// The names of placed models in checks, measures and targets of drivers, also of those that are no agents.
  [[nodiscard]] const std::vector<Extent>& objects() const { return objects_; }
  /// The use that a cursor touches.
  [[nodiscard]] const Use* at(std::size_t offset) const;
  /// The definition that begins there; or nullptr.
  [[nodiscard]] const Use* defined_at(std::size_t offset) const;

  [[nodiscard]] const std::string& system() const { return system_; }
  [[nodiscard]] const std::vector<DefinitionNames>& definitions() const { return definitions_; }
  [[nodiscard]] const std::vector<GroupTemplateNames>& group_templates() const { return group_templates_; }
  /// Or nullptr.
  [[nodiscard]] const GroupTemplateNames* group_template(std::string_view name) const;
  [[nodiscard]] const std::vector<SharedWord>& shared_words() const { return shared_words_; }
  /// The unit, or template of a group, that contains the place `way`, or nullptr.
  [[nodiscard]] const UnitNames* unit_at(const Way& way) const;
  /// The agents that are fleets.
  [[nodiscard]] const NamesOf& fleets() const { return fleets_; }
  /// Follows a way of the unit through its groups. nullopt: it does not lead to `behaviours`.
  [[nodiscard]] std::optional<PlaceInBehaviours> behaviour_at(const UnitNames& unit, const Way& way) const;
  /// The definition of an agent, through `use`; or nullptr.
  [[nodiscard]] const DefinitionNames* definition_of(std::string_view agent) const;
  [[nodiscard]] const NamesOf& types() const { return types_; }
  [[nodiscard]] const NamesOf& agents() const { return agents_; }
  [[nodiscard]] const NamesOf& templates() const { return templates_; }
  [[nodiscard]] const NamesOf& models() const { return models_; }
  [[nodiscard]] const NamesOf& parameters() const { return parameters_; }
  /// The fields of the structure that a type such as "Pose[3]" names; or nullptr.
  [[nodiscard]] const NamesOf* fields_of(std::string_view type) const;
  /// The name in C++ of the enumeration of a memory cell with values: "LentTo"; empty: it has none.
  [[nodiscard]] std::string enumeration_of(SymbolId cell) const;
  /// Whether an agent is a fleet, so that paths need an index.
  [[nodiscard]] bool is_fleet(std::string_view agent) const { return fleets_.contains(agent); }

  /// The contents of `in`, `out`, `memory` or `parameters` in that unit; nullptr: `base` is none of them. A
  /// receptor finds its real buffers in `in`, an effector in `out`.
  [[nodiscard]] std::optional<NamesOf> members(const UnitNames& unit, std::string_view base) const;

 private:
  friend class IndexBuilder;
  std::string system_;
  Numbered<SymbolId, Symbol> symbols_;
  std::vector<Use> uses_;
  std::vector<Extent> objects_;
  std::vector<DefinitionNames> definitions_;
  std::vector<GroupTemplateNames> group_templates_;
  std::vector<SharedWord> shared_words_;
  NamesOf types_, agents_, templates_, models_, parameters_, fleets_;
  std::map<SymbolId, NamesOf> fields_;
  std::map<SymbolId, std::string> enumerations_;
  std::map<std::string, std::string, std::less<>> use_of_;  ///< agent or template -> template
};

using FoundUse = std::function<void(Extent, SymbolId)>;

/// The uses of names in code of a unit: `in.line.left`, `memory.count`, `context.parameters.v`.
///
/// base: what the names `in`, `out`, `memory` and `parameters` mean; tokens: of the code, or a part of it.
void resolve_members(const Index& index, const UnitNames& unit, const std::vector<Token>& tokens,
                     const FoundUse& found);

/// The values of memory cells in a condition: `memory.lent_to == nobody`. Parameters: as for resolve_members.
void resolve_values(const UnitNames& unit, const std::vector<Token>& tokens, const FoundUse& found);

}  // namespace tessera::language
