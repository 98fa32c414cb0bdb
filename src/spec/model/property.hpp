#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

/// The properties that a specification asks to be proved (`properties:`).
namespace tessera::spec {

/// A name in a path and its position.
struct PathPart {
  std::string name;
  diagnostics::Span span;
};

/// A path into the net. The agent has been looked up; only the net knows the names after it.
struct NetPath {
  std::string agent;  ///< "robot[3]"; "in" or "out" alone: a place of the system
  std::vector<PathPart> parts;
  diagnostics::Span span;
};

/// The other side of a comparison with a memory cell with few values.
struct Comparison {
  enum class Kind : std::uint8_t {
    equal,
    unequal,
    less,
    less_equal,
    greater,
    greater_equal
  } kind = Kind::equal;
  PathPart value;        ///< a name, or a count
  diagnostics::Span at;  ///< of the operator
};

/// Behind an input: its last receive took a value. Behind an output: nobody acknowledged its last value in time.
inline constexpr std::string_view fresh_in_paths = "fresh", timed_out_in_paths = "timed_out";

/// A statement about one marking.
struct Statement {
  enum class Kind : std::uint8_t {
    /// A token in the place or page at `path`; with `to`, in the memory of that channel; with `compared`, in the
    /// places of those values of the memory cell at `path`.
    token,
    negation,  ///< negation of the only part
    all,       ///< all parts
    any        ///< at least one part
  } kind = Kind::token;
  NetPath path;
  std::optional<NetPath> to;
  std::optional<Comparison> compared{};
  std::vector<Statement> parts;
};

/// The statement of a property about one agent of a fleet, or about the system.
struct Claim {
  std::string about;  ///< "robot[3]"; empty: of the system
  Statement what;
  std::optional<Statement> then;  ///< leads_to: the consequence of `what`
};

struct Property {
  enum class Kind : std::uint8_t { never, always, reachable, always_reachable, leads_to };
  std::string name;
  Kind kind = Kind::never;
  std::string text;           ///< as written
  std::vector<Claim> claims;  ///< the property holds if all of them hold
  diagnostics::Span span;
};

/// "always_reachable"
[[nodiscard]] std::string_view name_of(Property::Kind kind);

}  // namespace tessera::spec
