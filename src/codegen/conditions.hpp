#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/project.hpp"

namespace tessera::codegen {

/// The conditions of one unit: the expressions, and the two functions that evaluate them. The expressions are
/// compiled in the scope of the user's transition functions, in a source of their own that includes little: a
/// changed condition compiles nothing else. Messages of the compiler lead to their lines and columns in the
/// specification (Lines).
class Conditions {
 public:
  Conditions(const Project& project, const Unit& unit);

  /// tessera::Subsystem::decide and ::route.
  [[nodiscard]] std::string decide() const;
  [[nodiscard]] std::string route() const;
  /// "static_cast<Behaviour>(behaviour)": the parameter `behaviour` as one of the enumeration.
  [[nodiscard]] static std::string_view behaviour_text(const spec::Subsystem& subsystem);
  /// tessera::Subsystem::sends; empty: every iteration sends everything.
  [[nodiscard]] std::string sends() const;
  /// Private members of the class that evaluates them: the conditions, and what `decide`
  /// remembers for `route`.
  /// Empty: none.
  [[nodiscard]] std::string members() const;
  [[nodiscard]] bool empty() const { return functions_.empty(); }
  /// "robot/control.conditions.hpp"
  [[nodiscard]] std::string header_name() const;
  /// `tessera_Conditions`, in the namespace of the unit: declares the functions.
  [[nodiscard]] File header() const;
  /// Defines them. With Lines::marked, their lines count as lines of the specification, so nothing else may
  /// follow them in the file.
  [[nodiscard]] File source() const;

 private:
  struct Function {
    std::string name;  ///< "tessera_follow_terminal_lost"
    const spec::Expression* expression;
    std::string says;  ///< a comment for the reader: "follow ends when lost"
    bool remembered = false;
  };
  /// The conditions that one behaviour asks for, as indices into functions_, in the order
  /// of the specification.
  struct Asked {
    Numbered<spec::ExpressionId, std::size_t> error, terminal;
    Numbered<spec::NextId, std::size_t> next;                     ///< only meaningful for expressions
    std::vector<Numbered<spec::ExpressionId, std::size_t>> send;  ///< per skippable output
  };

  void add_marked(const Function& function, std::string& out) const;
  void add_listed(const Function& function, File& file) const;
  /// Whether some condition names such a thing.
  [[nodiscard]] bool name(spec::Reference::Kind kind) const;
  /// Whether some condition may name `i`.
  [[nodiscard]] bool names_member() const;
  /// Constants for the values of memory that conditions name.
  [[nodiscard]] std::string values() const;
  std::size_t until_of(spec::BehaviourId group);
  std::size_t add(const std::string& name, const spec::Expression& expression, std::string says);
  Numbered<spec::ExpressionId, std::size_t> add_all(const spec::Behaviour& behaviour,
                                                    const spec::Condition& condition, std::string_view kind);
  [[nodiscard]] std::string decide_case(spec::BehaviourId behaviour) const;
  [[nodiscard]] std::string ask(const std::vector<std::size_t>& functions, std::string_view outcome) const;
  [[nodiscard]] std::string route_case(spec::BehaviourId behaviour) const;
  /// One line of `route`.
  struct Route {
    std::string when;  ///< "if (failed) "; empty: in any case
    spec::NextId entry;
  };
  [[nodiscard]] static std::string return_text(const Route& route, const spec::Next& entry);
  [[nodiscard]] std::string route_text(spec::BehaviourId behaviour, std::vector<Route> routes) const;
  [[nodiscard]] std::string question(spec::BehaviourId behaviour, spec::NextId entry) const;
  [[nodiscard]] std::string when_text(spec::BehaviourId behaviour, spec::NextId entry) const;

  const Project& project_;
  const Unit& unit_;
  const spec::Subsystem& subsystem_;
  std::vector<Function> functions_;
  Numbered<spec::BehaviourId, Asked> asked_;
  std::map<spec::BehaviourId, std::size_t> untils_;  ///< per group, in functions_
  std::set<std::string> names_;
};

}  // namespace tessera::codegen
