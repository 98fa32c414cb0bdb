#include "language/names/kinds.hpp"

namespace tessera::language {

bool is_nothing(const Node& node) { return node.kind == Node::Kind::null; }

std::string type_of(Kind kind, const Node& value) {
  if (kind == Kind::parameter) {
    if (value.is_scalar()) return value.text;
    const std::string unit = value["unit"].text;
    return (value["type"].text.empty() ? "float64" : value["type"].text) + (unit.empty() ? "" : " " + unit);
  }
  if (kind == Kind::model || kind == Kind::process || kind == Kind::behaviour || kind == Kind::condition)
    return {};
  return value.is_map() ? value["type"].text : value.text;
}

const NamesOf& members(const UnitNames& unit, Place place, std::string_view name) {
  if (place == Place::from) return unit.outputs;
  if (place == Place::to) return unit.inputs;
  if (place == Place::real) return unit.real;
  if (unit.behaviours.contains(name)) return unit.behaviours;
  return unit.inputs.contains(name)    ? unit.inputs
         : unit.outputs.contains(name) ? unit.outputs
                                       : unit.behaviours;
}

}  // namespace tessera::language
