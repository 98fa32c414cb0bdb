#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/codegen.hpp"
#include "codegen/local_net.hpp"
#include "spec/model/model.hpp"
#include "verify/verify.hpp"

namespace tessera::codegen {

/// A subsystem of a definition that some agent runs: the unit that gets a header, a source and
/// the user's functions.
struct Unit {
  const spec::Definition* definition = nullptr;
  const spec::Subsystem* subsystem = nullptr;
  std::vector<spec::InstanceId> instances;  ///< the instances that run it, in the order of the model
};

/// A part of which there is one for each member of a fleet is one in C++: an array of buffers, or a function that
/// finds the member in its context. Whether a part stands for its family, or for itself.
template <class Part>
[[nodiscard]] bool is_first(const Part& part) {
  return !part.member || part.member->number == 0;
}
/// Its name in C++, which is that in the specification.
template <class Part>
[[nodiscard]] const std::string& written_name(const Part& part) {
  return part.member ? part.member->family : part.name;
}

/// The name of its transition function: "charge_ask" for a behaviour `ask` in a group `charge`.
[[nodiscard]] inline std::string function_name(const spec::Behaviour& behaviour) {
  return behaviour.member ? behaviour.member->family : behaviour.identifier();
}

/// Every unit, definition by definition, except those that no agent uses. Linear in the instances.
[[nodiscard]] std::vector<Unit> units_of(const spec::Model& model);

/// "robot.control"
[[nodiscard]] std::string unit_path(const Unit& unit);
/// "line_follower::robot::control": the namespace of the user's code.
[[nodiscard]] std::string unit_namespace(const spec::Model& model, const Unit& unit);
/// "tessera_generated::units::robot::control": the namespace of what Tessera adds to a unit. Generated names
/// cannot clash with names of the specification: they stand in `tessera_generated`, or begin with `tessera_`
/// where they have to stand beside the user's. `check` reserves both.
[[nodiscard]] std::string generated_namespace(const Unit& unit);
/// "robot/control.hpp"
[[nodiscard]] std::string unit_header(const Unit& unit);
/// "robot/control.data.hpp": the part of it that conditions need.
[[nodiscard]] std::string data_header(const Unit& unit);
/// The parameters a unit sees: those of the system that it does not shadow, then its own.
[[nodiscard]] std::vector<const spec::Parameter*> parameters_of(const spec::Model& model, const Unit& unit);
/// "src/control.cpp", or "src/robot/control.cpp" when there are several definitions.
[[nodiscard]] std::string user_file(const std::vector<Unit>& units, const Unit& unit);

/// The input from which all files of one system are generated.
struct Project {
  const spec::Model& model;
  const verify::VerifiedNet& net;
  std::string spec_path;  ///< its name in #line
  Lines lines;
  std::string spec_name;  ///< its name in comments: "spec.yaml"
  std::vector<Unit> units;
  std::vector<NetVariants> nets;  ///< one per unit

  /// "spec.yaml:12"
  [[nodiscard]] std::string at(const spec::Span& span) const;
  /// The first line of every file; `marker` starts a comment. It states no hash and no line: a file changes only
  /// when its meaning does.
  [[nodiscard]] std::string banner(std::string_view marker = "//") const;
};

}  // namespace tessera::codegen
