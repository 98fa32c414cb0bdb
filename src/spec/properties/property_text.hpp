#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "spec/agents/paths.hpp"
#include "spec/document/document.hpp"

/// The formulas of properties as they are written, before names are looked up:
///
///     formula = conjunction { "or" conjunction }      conjunction = negation { "and" negation }
///     negation = "not" negation | "(" formula ")" | ("any" | "all") "(" formula ")" | path [ "->" path ]
///              | path ( "==" | "!=" | "<" | "<=" | ">" | ">=" ) ( NAME [ "[" index "]" ] | NUMBER )
///     path = NAME [ "[" index "]" ] { "." NAME [ "[" index "]" ] }
namespace tessera::spec {

/// An index of a part of a path; plain: it has none.
struct WrittenIndex {
  Selector selector;
  Span span{};
};

/// A path of any length: robot[i].control.follow
struct WrittenPath {
  std::string agent;
  Span whole, agent_span, index_span;
  Selector selector;
  std::vector<PathPart> parts;          ///< after the agent, without their indices
  std::vector<WrittenIndex> indices{};  ///< per part: of one for each member of a fleet
};

struct Formula {
  enum class Kind : std::uint8_t {
    path,      ///< a token in that place; with `to`, in the memory of that channel; or `compared`
    negation,  ///< negation of the only part
    both,      ///< all parts hold
    either,    ///< at least one part holds
    every,     ///< the only part holds for every agent that [*] stands for
    some       ///< the only part holds for at least one agent that [*] stands for
  } kind = Kind::path;
  WrittenPath path;
  std::optional<WrittenPath> to;
  std::optional<Comparison> compared{};
  WrittenIndex compared_index{};  ///< of the value: robot[i]
  std::vector<Formula> parts;
  Span span;  ///< of its first word or path
};

/// Parses `length` bytes of the text from byte `offset`.
///
/// Errors: E112 a path or index of the wrong form; E114 no formula. One mistake is reported.
[[nodiscard]] std::optional<Formula> read_formula(const Node& text, std::size_t offset, std::size_t length,
                                                  Diagnostics& out);

}  // namespace tessera::spec
