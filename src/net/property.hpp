#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"

/// Properties from the specification, about the markings of a flat net.
namespace tessera::net {

/// A statement about one marking.
struct Statement {
  enum class Kind : std::uint8_t {
    token,     ///< one of `places` holds a token
    negation,  ///< negation of the only part
    all,       ///< all parts hold
    any        ///< at least one part holds
  } kind = Kind::token;
  std::vector<PlaceId> places{};
  PageId page{};  ///< valid: `places` are all places of that page and of the pages in it ("is running")
  std::vector<Statement> parts{};
};

struct Claim {
  std::string about{};  ///< "robot[3]" if the property has several claims; otherwise empty
  Statement what{};
  Statement then{};  ///< leads_to only
};

struct Property {
  enum class Kind : std::uint8_t {
    never,             ///< `what` is true in no reachable marking
    always,            ///< `what` is true in every reachable marking
    reachable,         ///< `what` is true in some reachable marking
    always_reachable,  ///< from every reachable marking, one in which `what` is true can be reached
    /// After every reachable marking in which `what` is true, `then` becomes true, provided that every
    /// branch that is offered again and again is taken eventually.
    leads_to
  } kind = Kind::never;
  std::string name{};           ///< "motors can always run"
  std::string text{};           ///< "always_reachable robot.motor.drive"
  std::vector<Claim> claims{};  ///< the property holds if all of them hold
  Span span{};
};

}  // namespace tessera::net
