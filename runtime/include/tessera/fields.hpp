#pragma once

#include <tuple>

/// Lists the fields of a structure. So the runtime can look for numbers that are not finite, and record the
/// fields one by one. The macro stands at the end of the structure:
///
///     struct Velocity {
///       double linear{}, angular{};
///       TESSERA_FIELDS(Velocity, linear, angular)
///     };
///
/// It defines `tessera_fields_of(const Type&)`, a std::tuple of pointers to members, and
/// `tessera_field_names_of(const Type&)`, "linear, angular".
#define TESSERA_FIELDS(Type, ...)                                                           \
  friend auto tessera_fields_of(const Type&) {                                              \
    return std::tuple(__VA_OPT__(TESSERA_EXPAND_5(TESSERA_EACH_FIELD(Type, __VA_ARGS__)))); \
  }                                                                                         \
  friend auto tessera_field_names_of(const Type&) { return #__VA_ARGS__; }

// Each expansion handles one more field.
#define TESSERA_EACH_FIELD(Type, field, ...) \
  &Type::field __VA_OPT__(, TESSERA_EACH_FIELD_AGAIN TESSERA_NO_ARGUMENTS(Type, __VA_ARGS__))
#define TESSERA_EACH_FIELD_AGAIN() TESSERA_EACH_FIELD
#define TESSERA_NO_ARGUMENTS ()
#define TESSERA_EXPAND_5(...) \
  TESSERA_EXPAND_4(TESSERA_EXPAND_4(TESSERA_EXPAND_4(TESSERA_EXPAND_4(__VA_ARGS__))))
#define TESSERA_EXPAND_4(...) \
  TESSERA_EXPAND_3(TESSERA_EXPAND_3(TESSERA_EXPAND_3(TESSERA_EXPAND_3(__VA_ARGS__))))
#define TESSERA_EXPAND_3(...) \
  TESSERA_EXPAND_2(TESSERA_EXPAND_2(TESSERA_EXPAND_2(TESSERA_EXPAND_2(__VA_ARGS__))))
#define TESSERA_EXPAND_2(...) \
  TESSERA_EXPAND_1(TESSERA_EXPAND_1(TESSERA_EXPAND_1(TESSERA_EXPAND_1(__VA_ARGS__))))
#define TESSERA_EXPAND_1(...) \
  TESSERA_EXPAND_0(TESSERA_EXPAND_0(TESSERA_EXPAND_0(TESSERA_EXPAND_0(__VA_ARGS__))))
#define TESSERA_EXPAND_0(...) __VA_ARGS__
