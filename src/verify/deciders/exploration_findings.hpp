#pragma once

#include <cstddef>
#include <vector>

#include "explore/budget.hpp"
#include "verify/deciders/facts.hpp"
#include "verify/deciders/question.hpp"
#include "verify/search/exploration.hpp"

/// Findings from the results of searches, with runs that are easy to follow.
namespace tessera::verify {

/// good: the answer to the question of the search for which the property holds.
[[nodiscard]] Finding judged(const Found& found, Found::Kind good);
/// The most telling of several answers, all of which have to be `yes`: a `no`, else an `unknown`.
[[nodiscard]] std::size_t worst_of(const std::vector<Found>& all);
/// The finding about several goals. bad: the answer about one of them that is a violation.
[[nodiscard]] Finding judged_together(const std::vector<Found>& all, Found::Kind bad);
/// The goals were those of the question's subjects, one by one.
void name_subjects(Finding& finding, const Question& question);

/// Limits of a search of little worth. They count markings and not time, so that the same run is shown on
/// every machine. In a large net each marking is more work, so the limit is lower.
[[nodiscard]] explore::Limits with_few_markings(const net::Net& net, explore::Limits limits);

/// Names a behaviour that is never entered, if it is the reason why a wait never ends.
void name_absences(std::vector<SubsystemAtEnd>& waits, const NetUnderAssumption& given);
/// Extends the run, whose violation is final, and adds the waits at its end.
void explain(Finding& finding, const NetUnderAssumption& given, const explore::Budget& budget);

/// Leaves out the subsystems that have no influence on a marking in which the goal is true.
void keep_causes(std::vector<net::TransitionId>& run, const net::Net& net, const explore::Formula& goal);
/// The same for a run after which the goal is out of reach: it is a marked place, or one of several.
void keep_causes_of_loss(std::vector<net::TransitionId>& run, const net::Net& net,
                         const explore::Formula& goal, const explore::Budget& budget);

}  // namespace tessera::verify
