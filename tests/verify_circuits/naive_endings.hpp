#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>

#include "net/net.hpp"
#include "spec/model/endings.hpp"
#include "spec/model/model.hpp"

/// How behaviours end and what follows, tried with every value of every expression: an oracle that shares no
/// rule with spec::Endings and the nets made with it.
namespace tessera::test {

struct NaiveEndings {
  bool goes_on = false;  ///< for some values the behaviour begins another round
  std::array<bool, spec::all_endings.size()> possible{};
  /// Per ending: the entries of `next` that are taken for some values; -1: none holds.
  std::array<std::set<int>, spec::all_endings.size()> taken{};

  [[nodiscard]] bool ends(spec::Ending ending) const { return possible[static_cast<std::size_t>(ending)]; }
  [[nodiscard]] const std::set<int>& after(spec::Ending ending) const {
    return taken[static_cast<std::size_t>(ending)];
  }
};

/// As the generated controller decides. At most 20 expressions and entries.
[[nodiscard]] NaiveEndings try_endings(const spec::Behaviour& behaviour);

/// The behaviour that a transition t4, t5, t6 or t_NAME_ENTRY belongs to; nullptr: it is none of these.
[[nodiscard]] const spec::Behaviour* behaviour_of(const spec::Model& model,
                                                  const net::Transition& transition);

/// The flat net with the results of the trials for conditions, and a transition "... none" and a place
/// ".none" where possibly no entry holds. failures: any iteration may fail. Places and transitions keep their
/// ids.
[[nodiscard]] net::Net naively_abstract(const spec::Model& model, const net::Net& flat, bool failures);

/// Terminal and error conditions and `next` drawn anew for the behaviours of which some are left: constants,
/// named expressions, entries of every kind.
void draw_endings(spec::Model& model, std::uint64_t seed);
/// The same for one behaviour; `others`: how many behaviours there are to go on to.
void draw_endings(spec::Behaviour& behaviour, std::uint32_t others, std::uint64_t seed);

}  // namespace tessera::test
