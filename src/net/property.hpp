#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"

/// Properties of the author over the markings of a flat net.
namespace tessera::net {

/// A statement about one marking.
struct Statement {
  enum class Kind : std::uint8_t {
    token,     ///< one of `places` holds a token
    negation,  ///< of its only part
    all,       ///< of the parts
    any        ///< of the parts
  } kind = Kind::token;
  std::vector<PlaceId> places{};
  PageId page{};  ///< valid: `places` are all those of that page and the pages in it ("is running")
  std::vector<Statement> parts{};
};

struct Claim {
  std::string about{};  ///< "robot[3]", if the property is claimed of several; else empty
  Statement what{};
  Statement then{};  ///< leads_to only
};

struct Property {
  enum class Kind : std::uint8_t {
    never,             ///< `what` is true of no reachable marking
    always,            ///< ... of all
    reachable,         ///< ... of some
    always_reachable,  ///< from every reachable marking, one of which `what` is true can be reached
    leads_to  ///< from every one of which `what` is true, `then` comes if every branch that is offered is
              ///< taken eventually
  } kind = Kind::never;
  std::string name{};           ///< "motors can always run"
  std::string text{};           ///< "always_reachable robot.motor.drive"
  std::vector<Claim> claims{};  ///< all of them have to hold
  Span span{};
};

}  // namespace tessera::net
