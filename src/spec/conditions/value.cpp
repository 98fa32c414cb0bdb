#include "spec/conditions/value.hpp"

namespace tessera::spec {

std::string in_words(const Value& value, const Types& types) {
  switch (value.kind) {
    case Value::Kind::duration:
      return "a duration";
    case Value::Kind::time:
      return "a point in time";
    case Value::Kind::boolean:
      return "true or false";
    case Value::Kind::number:
      return value.declared ? "a number (" + types.spelled(value.type) + ")" : "a number";
    case Value::Kind::array:
      return (value.type.is_sequence ? "a sequence (" : "an array (") + types.spelled(value.type) + ")";
    case Value::Kind::text:
      return "a string";
    case Value::Kind::structure:
      return "a structure (" + types.spelled(value.type) + ")";
    case Value::Kind::choice:
      return value.literal ? "a value of memory." + value.few->name : value.few->few->in_words();
    case Value::Kind::unknown:
      break;
  }
  return "a value";
}

}  // namespace tessera::spec
