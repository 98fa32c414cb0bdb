// The parts of a net that runs have reached, for the page.
#include <map>
#include <stdexcept>
#include <string_view>

#include "server/http/json_text.hpp"
#include "server/recordings/recording_stream.hpp"
#include "server/recordings/recording_tail.hpp"
#include "server/recordings/recordings.hpp"

namespace tessera::server {

using nlohmann::json;
using replay::Coverage;

namespace {

json share_of(const Coverage::Share& share) { return {{"reached", share.reached}, {"all", share.all}}; }

/// The elements that were not reached, by their numbers in the net; behaviours by their paths.
json missing_in(const Coverage& coverage, const net::Net& net) {
  std::map<std::string_view, std::uint32_t> places, transitions;
  for (std::uint32_t index = 0; index < net.places().size(); ++index)
    places.emplace(net.places()[index].name, index);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    transitions.emplace(net.transitions()[index].name, index);
  json missing{{"behaviours", json::array()},
               {"places", json::array()},
               {"transitions", json::array()},
               {"never_held", json::array()},
               {"never_false", json::array()}};
  using Kind = Coverage::Missing::Kind;
  for (const Coverage::Group& group : coverage.groups) {
    if (group.kind == Coverage::Group::Kind::behaviour && !group.reached)
      missing["behaviours"].push_back(group.path);
    for (const Coverage::Missing& one : group.missing) {
      if (one.kind == Kind::place)
        missing["places"].push_back(places.at(one.name));
      else
        missing[one.kind == Kind::transition ? "transitions"
                : one.kind == Kind::holds    ? "never_held"
                                             : "never_false"]
            .push_back(transitions.at(one.name));
    }
  }
  return missing;
}

}  // namespace

void Reached::begin(const Recording& header) {
  const std::lock_guard lock(mutex_);
  if (counts_.runs() == 0) counts_.begin_run();
  // A segment that was not read is gone.
  if (header.segment.value_or(0) != next_segment_) counts_.lack_events();
  next_segment_ = header.segment.value_or(0) + 1;
}

void Reached::add(const std::vector<net::TransitionId>& fired, const std::vector<net::PlaceId>& marked) {
  const std::lock_guard lock(mutex_);
  for (const net::TransitionId id : fired) counts_.fire(id);
  for (const net::PlaceId id : marked) counts_.mark(id);
}

void Reached::lack_events() {
  const std::lock_guard lock(mutex_);
  counts_.lack_events();
}

json Reached::coverage(const net::HierarchicalNet& pages, const net::Net& net) const {
  const Coverage coverage = [&] {
    const std::lock_guard lock(mutex_);
    return replay::coverage_of(pages, net, counts_);
  }();
  return {{"behaviours", share_of(coverage.behaviours)},   {"places", share_of(coverage.places)},
          {"transitions", share_of(coverage.transitions)}, {"conditions", share_of(coverage.conditions)},
          {"unreachable", coverage.unreachable},           {"lacks_events", coverage.lacks_events},
          {"missing", missing_in(coverage, net)}};
}

std::optional<std::string> Recordings::coverage(const std::string& name) const {
  const auto all = files();
  const auto found = all.find(name);
  if (found == all.end()) return std::nullopt;
  const std::shared_ptr<const Analysis> analysis = analyses_.of(file_.read().text);
  if (!analysis->net) throw std::runtime_error("the specification has errors, so it has no net");
  Reached reached(*analysis->net);
  RecordingTail tail(RecordingStream::of_file(found->second, GrowingRecording::From::oldest), *analysis->net,
                     &reached);
  for (bool is_first = true;; is_first = false) {
    const bool more = tail.next().more;
    if (is_first && !tail.net_hash()) throw std::runtime_error(name + " is no recording");
    if (is_first && *tail.net_hash() != analysis->net_hash)
      throw std::runtime_error(name + " is of another net than the specification");
    if (!more) break;
  }
  if (tail.is_cut()) reached.lack_events();
  return text_of(reached.coverage(*analysis->pages, *analysis->net));
}

}  // namespace tessera::server
