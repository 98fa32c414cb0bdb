#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "explore/budget.hpp"
#include "explore/formula.hpp"

namespace tessera::verify {

/// The small net of a local view (local_view.hpp), with a question about all its markings. Places are numbered from
/// zero; a marking is a text with one character per place.
struct LocalNet {
  /// Places that it takes from and gives to.
  struct Step {
    std::vector<std::uint32_t> takes, gives;
    bool certain = false;
    bool counts = false;  ///< it is one of those that shall be possible
  };
  enum class Kind : std::uint8_t {
    never,            ///< `what` is true in no marking
    always_possible,  ///< from every marking, certain steps lead to where `then` is true, or to one that counts
    leads_to          ///< the same from the markings between one with `what` and the next with `then`
  };
  std::string initial;
  std::vector<Step> steps;
  Kind kind = Kind::never;
  explore::Formula what, then;
  bool counts = false;  ///< one of the steps that count is wanted, instead of `then`

  /// Nets with the same key have the same doubts.
  [[nodiscard]] std::string key() const;

  /// The markings for which the answer may be no.
  struct Doubts {
    bool any = false;
    std::vector<std::uint32_t> places{};  ///< marked in some of them, in order
  };
  /// nullopt: it has too many markings, or too many tokens in a place. Throws explore::CutOff.
  [[nodiscard]] std::optional<Doubts> doubts(const explore::Budget& budget, std::size_t most_markings) const;
};

}  // namespace tessera::verify
