#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "spec/agents/paths.hpp"
#include "spec/document/document.hpp"

/// The formulas of properties as they are written, names not looked up:
///
///     formula = conjunction { "or" conjunction }      conjunction = negation { "and" negation }
///     negation = "not" negation | "(" formula ")" | ("any" | "all") "(" formula ")" | path [ "->" path ]
///     path = NAME [ "[" index "]" ] { "." NAME }
namespace tessera::spec {

/// A path of any length: robot[i].control.follow
struct WrittenPath {
  std::string agent;
  Span whole, agent_span, index_span;
  Selector selector;
  std::vector<PathPart> parts;  ///< behind the agent
};

struct Formula {
  enum class Kind : std::uint8_t {
    path,      ///< a token there; with `to`, in the memory of that channel
    negation,  ///< of its only part
    both,      ///< of all parts
    either,    ///< of one of the parts
    every,     ///< the only part, for every agent that [*] stands for
    some       ///< the only part, for one of the agents that [*] stands for
  } kind = Kind::path;
  WrittenPath path;
  std::optional<WrittenPath> to;
  std::vector<Formula> parts;
  Span span;  ///< of the word or path that it begins with
};

/// Parses `length` bytes of the text from byte `offset`.
///
/// Errors: E112 a path or index of the wrong form; E114 no formula. One mistake is reported.
[[nodiscard]] std::optional<Formula> read_formula(const Node& text, std::size_t offset, std::size_t length,
                                                  Diagnostics& out);

}  // namespace tessera::spec
