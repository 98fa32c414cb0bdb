#include "server/recordings/recording_tail.hpp"

#include <algorithm>
#include <chrono>

#include "server/recordings/value_json.hpp"

namespace tessera::server {

// ------------------------------------------------------------------------------------------------ names

template <class Id, class Elements>
NetNames::Ids<Id> NetNames::ids_of(const Elements& elements) {
  Ids<Id> ids;
  for (std::uint32_t index = 0; index < elements.size(); ++index)
    ids.emplace_back(elements[index].name, Id{index});
  std::ranges::sort(ids);
  return ids;
}

NetNames::NetNames(const net::Net& net)
    : places_(ids_of<net::PlaceId>(net.places())),
      transitions_(ids_of<net::TransitionId>(net.transitions())) {}

template <class Id>
Id NetNames::find(const Ids<Id>& ids, std::string_view name) {
  const auto found = std::ranges::lower_bound(ids, name, {}, &Ids<Id>::value_type::first);
  return found != ids.end() && found->first == name ? found->second : Id{};
}

std::vector<net::TransitionId> NetNames::transitions_of(const Recording& recording) const {
  std::vector<net::TransitionId> ids;
  for (const Recording::Transition& one : recording.transitions) ids.push_back(find(transitions_, one.name));
  return ids;
}

std::vector<net::PlaceId> NetNames::marked(std::string_view lines) const {
  std::vector<net::PlaceId> places;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    if (const net::PlaceId place = find(places_, lines.substr(0, end)); place.valid())
      places.push_back(place);
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return places;
}

// ------------------------------------------------------------------------------------------------ tail

RecordingTail::Segment::Segment(std::shared_ptr<const Recording> its_recording, const NetNames& names)
    : recording(std::move(its_recording)),
      transitions(names.transitions_of(*recording)),
      values(*recording),
      has_changed(recording->buffers.size()),
      lost(recording->buffers.size()),
      invalid(recording->buffers.size()) {}

RecordingTail::RecordingTail(RecordingStream::Source source, const net::Net& net, Reached* reached)
    : names_(net), stream_(std::move(source)), tokens_(net), reached_(reached) {}

void RecordingTail::keep(Batch& batch, const Recording::Entry& entry) {
  const Event& event = entry.event;
  batch.time_ns = std::max(batch.time_ns, event.time_ns);
  poses_.take(entry);
  if (const auto point = poses_.take_point()) batch.path.push_back(*point);
  if (std::optional<nlohmann::json> notice = notice_of(*segment_->recording, entry))
    notices_.add(std::move(*notice));
  if (event.kind() == Event::Kind::firing) {
    const net::TransitionId transition = segment_->transitions[event.subject];
    if (!transition.valid()) return;
    tokens_.fire(transition);
    if (reached_ != nullptr) fired_.push_back(transition);
    batch.firings.emplace_back(event.time_ns, transition.value);
  } else if (event.kind() == Event::Kind::value) {
    keep_value(batch, entry);
  } else if (event.kind() == Event::Kind::marking) {
    const std::vector<net::PlaceId> places = names_.marked(entry.text);
    if (reached_ != nullptr) marked_.insert(marked_.end(), places.begin(), places.end());
    if (event.version != 0) return;
    tokens_.set(places);
    batch.jumped = true;
  } else if (event.kind() == Event::Kind::parameter) {
    const std::size_t equals = entry.text.find('=');
    if (equals != std::string::npos)
      batch.parameters.emplace_back(entry.text.substr(0, equals), entry.text.substr(equals + 1));
  } else if (event.kind() == Event::Kind::end && event.subject > 0 && reached_ != nullptr) {
    reached_->lack_events();
  }
}

void RecordingTail::keep_value(Batch& batch, const Recording::Entry& entry) {
  const auto change = segment_->values.follow(entry);
  if (!change) return;
  const ValueEvent& event = change->event;
  if (!event.has(ValueFlags::same)) arrays_.take(*change);
  const bool valid = event.has(ValueFlags::valid);
  // Only the first read of an input that holds no valid value says something.
  const bool begins_invalid = event.has(ValueFlags::stamped) && !valid && !segment_->invalid[change->number];
  if (event.has(ValueFlags::stamped)) segment_->invalid[change->number] = !valid;
  if (event.has(ValueFlags::stamped) && (event.has(ValueFlags::fresh) || begins_invalid))
    batch.arrivals.push_back({change->buffer.path, entry.event.time_ns, event.stamp_ns, valid});
  const bool lost = event.has(ValueFlags::silent | ValueFlags::failed);
  const bool as_before = event.has(ValueFlags::same) && lost == segment_->lost[change->number];
  segment_->lost[change->number] = lost;
  if (as_before || segment_->has_changed[change->number]) return;
  segment_->has_changed[change->number] = true;
  segment_->changed.push_back(change->number);
}

/// If there are many firings or arrivals, keeps only the last ones.
void RecordingTail::keep_the_last(Batch& batch) {
  // Threads write one after the other; the page shows the order of time.
  std::ranges::stable_sort(batch.firings, {}, &decltype(batch.firings)::value_type::first);
  if (batch.arrivals.size() > most_arrivals) {
    const std::size_t beyond = batch.arrivals.size() - most_arrivals;
    batch.arrivals_dropped += beyond;
    batch.arrivals.erase(batch.arrivals.begin(),
                         batch.arrivals.begin() + static_cast<std::ptrdiff_t>(beyond));
  }
  if (batch.firings.size() <= most_firings) return;
  const std::size_t beyond = batch.firings.size() - most_firings;
  batch.dropped += beyond;
  batch.firings.erase(batch.firings.begin(), batch.firings.begin() + static_cast<std::ptrdiff_t>(beyond));
}

RecordingTail::Batch RecordingTail::next() {
  using Clock = std::chrono::steady_clock;
  constexpr auto patience = std::chrono::milliseconds(30);
  const Clock::time_point until = Clock::now() + patience;
  Batch batch;
  do {
    if (stream_.next() && stream_.begins()) {
      const bool first = !segment_.has_value();
      values_ = take_changed_values();
      segment_.emplace(stream_.recording(), names_);
      poses_.begin(*stream_.recording());
      arrays_.begin(*stream_.recording());
      if (reached_ != nullptr) reached_->begin(*stream_.recording());
      if (first) {
        batch.parameters = stream_.recording()->parameters;
        batch.lacks_parameters = lacks_beginning(*stream_.recording());
      }
    }
    if (!stream_.recording()) continue;
    for (const Recording::Entry& entry : stream_.recording()->entries) keep(batch, entry);
    keep_the_last(batch);
    if (reached_ != nullptr) reached_->add(std::exchange(fired_, {}), std::exchange(marked_, {}));
  } while (stream_.more() && Clock::now() < until);
  batch.more = stream_.more();
  return batch;
}

nlohmann::json RecordingTail::take_changed_values(std::size_t most) {
  std::size_t bytes = 0;
  while (segment_ && !segment_->changed.empty() && bytes < most) {
    const std::uint32_t buffer = segment_->changed.front();
    segment_->changed.pop_front();
    segment_->has_changed[buffer] = false;
    if (segment_->lost[buffer]) {
      values_[segment_->recording->buffers[buffer].path] = nullptr;
      continue;
    }
    const replay::ValueTrack::Value held = segment_->values.value(buffer);
    if (held.hashed || held.layout == nullptr || held.bytes.size() > largest_value) continue;
    nlohmann::json value = json_of(*held.layout, held.bytes);
    if (value.is_null()) continue;
    const std::string& path = segment_->recording->buffers[buffer].path;
    bytes += path.size() + held.bytes.size();
    values_[path] = std::move(value);
  }
  return std::exchange(values_, nlohmann::json::object());
}

}  // namespace tessera::server
