#include "replay/judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace tessera::replay {

using net::ChannelId;
using Verdict = Legality::Verdict;

Judge::Judge(std::span<const Recording> recordings, const net::Net& net, const ProcessMap& processes)
    : processes_(processes), net_(net, processes) {
  std::unordered_map<std::string_view, std::uint32_t> transitions;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    transitions.emplace(net.transitions()[index].name, index);
  for (std::uint32_t index = 0; index < net.parts().channels.size(); ++index)
    channels_.emplace(net.parts().channels[index], index);
  for (const Recording* recording : in_order(recordings)) {
    sources_.emplace_back(*recording);
    if (!mismatch_) mismatch_ = sources_.back().match(net, transitions);
  }
}

Legality Judge::judge() {
  if (mismatch_) return {.verdict = Verdict::illegal, .why = mismatch_->text, .firings = 0, .marking = {}};
  play_.emplace(net_, starts(), !recording(0).process);
  Outcome outcome = play();
  if (!outcome) outcome = of_the_end();
  return {.verdict = outcome->verdict,
          .why = std::move(outcome->why),
          .firings = play_->firings(),
          .marking = play_->marking()};
}

Judge::Firing Judge::firing_of(std::size_t recording, const Event& event) const {
  const net::TransitionId id = sources_[recording].transition(event);
  return {.transition = id, .start = start_of(recording, net_[id].process), .version = event.version};
}

std::string Judge::complaint(std::size_t recording, const Event& event) const {
  const Firing firing = firing_of(recording, event);
  return sources_[recording].place_of(event) + play_->complaint(firing, play_->obstacle(firing));
}

Outcome Judge::perform(std::size_t recording, const Recording::Entry& entry, bool& performed) {
  std::optional<Problem> wrong;
  if (entry.event.kind() == Event::Kind::peer) {
    wrong = hear(recording, entry);
  } else {
    const Firing firing = firing_of(recording, entry.event);
    performed = play_->obstacle(firing).kind == Obstacle::Kind::no;
    if (!performed) return {};
    wrong = play_->fire(firing);
  }
  if (!wrong) return {};
  return illegal(sources_[recording].place_of(entry.event) + wrong->text);
}

std::optional<Problem> Judge::hear(std::size_t recording, const Recording::Entry& entry) {
  const std::string_view text = entry.text;
  const auto channel = channels_.find(text.substr(0, text.find('\n')));
  const std::optional<std::uint64_t> incarnation = incarnation_in(text);
  if (channel == channels_.end() || !incarnation)
    return Problem{fmt::format("'{}' is no peer of a channel", text)};
  const StartId start = start_that_hears(recording, entry.event, {channel->second});
  if (!start.valid()) return Problem{fmt::format("no process is at that end of '{}'", channel->first)};
  return play_->hear({channel->second}, start, *incarnation);
}

/// The start whose side of the channel hears.
Judge::StartId Judge::start_that_hears(std::size_t recording, const Event& event, ChannelId channel) const {
  const DeployedNet::Channel& ends = net_[channel];
  const bool sends = ends.sender.valid() && event.instance() != system_instance &&
                     net_.net().parts()[ends.sender].path == sources_[recording].path_of(event);
  return start_of(recording, sends ? ends.sending : ends.receiving);
}

Judgement Judge::of_the_end() const {
  const auto incomplete = [](std::string why) { return Judgement{Verdict::incomplete, std::move(why)}; };
  if (!missing_.empty()) return incomplete(missing_);
  std::vector<bool> given(processes_.names.size(), !recording(0).process);
  for (const Source& source : sources_)
    if (source.recording().process) given[source.recording().process->number] = true;
  constexpr const char* assumed = "no recording of {} is given: what it did is assumed";
  if (const std::string names = names_without(processes_, given); !names.empty())
    return incomplete(fmt::format(assumed, names));
  if (!play_->unknown_peer().empty()) return incomplete(fmt::format(assumed, play_->unknown_peer()));
  return {Verdict::legal, ""};
}

Judge::Sequence::Turn Judge::Sequence::follow(const Event& event) {
  const bool was_begun = std::exchange(begun, true);
  const std::uint32_t due = std::exchange(next, event.sequence + 1);
  if (!was_begun || event.sequence == due) return Turn::next;
  return is_before(event.sequence, due) ? Turn::back : Turn::gap;
}

// ------------------------------------------------------------------------------------------- written order

WrittenOrder::WrittenOrder(const Recording& run, const net::Net& net, const ProcessMap& processes)
    : Judge({&run, 1}, net, processes),
      run_(run),
      lanes_(run.instances.size() + 1),
      playing_(!lacks_beginning(run)) {
  for (const ProcessId process : processes.names.ids()) current_.push_back({process.value});
  begun_ = static_cast<std::uint32_t>(current_.size());
}

/// The first start of each process, and those that the recording names.
std::vector<NetPlay::Start> WrittenOrder::starts() const {
  std::vector<NetPlay::Start> all;
  for (const ProcessId process : processes_.names.ids())
    all.push_back({.process = process, .incarnation = 1});
  for (const Recording::Entry& entry : run_.entries) {
    if (entry.event.kind() != Event::Kind::process || entry.event.version != 1) continue;
    const auto found = std::ranges::find(processes_.names, entry.text.substr(0, entry.text.find('\n')));
    const std::optional<std::uint64_t> incarnation = incarnation_in(entry.text);
    if (found == processes_.names.end() || !incarnation) break;  // it ends the play
    all.push_back({.process = {static_cast<std::uint32_t>(found - processes_.names.begin())},
                   .incarnation = *incarnation});
  }
  return all;
}

Judge::StartId WrittenOrder::start_of(std::size_t, ProcessId process) const {
  return process.valid() ? current_[process] : StartId{};
}

Outcome WrittenOrder::play() {
  if (!playing_ && std::ranges::none_of(run_.entries, is_known_marking, &Recording::Entry::event))
    note("its beginning is gone, and the marking after that is not known");
  for (const Recording::Entry& entry : run_.entries)
    if (Outcome outcome = play(entry)) return outcome;
  if (run_.truncated) note("the recording is cut off at its end");
  if (run_.lost > 0) note(fmt::format("{} events of the run are missing", run_.lost));
  return {};
}

Outcome WrittenOrder::play(const Recording::Entry& entry) {
  const Event& event = entry.event;
  if (is_known_marking(event)) return play_marking(entry);
  if (!is_counted(event)) return {};
  const Source& source = sources_.front();
  if (const auto wrong = source.stranger(event, net_)) return illegal(wrong->text);
  const auto turn = lanes_[std::min<std::size_t>(event.instance(), run_.instances.size())].follow(event);
  if (turn == Sequence::Turn::back) return illegal(source.twice(event));
  if (turn == Sequence::Turn::gap) {
    note(source.missing(event));
    playing_ = false;
  }
  if (event.kind() == Event::Kind::process && event.version == 1) return begin_again(entry);
  if (!playing_ || !is_played(event)) return {};
  if (event.time_ns < std::exchange(last_ns_, event.time_ns))
    return illegal(source.place_of(event) + "an event is recorded there, but time went back");
  bool performed = true;
  Outcome outcome = perform(0, entry, performed);
  return performed ? outcome : illegal(complaint(0, event));
}

Outcome WrittenOrder::play_marking(const Recording::Entry& entry) {
  const std::optional<Problem> wrong =
      playing_ ? play_->compare(entry.text, {}) : play_->start_from(entry.text, {});
  if (!std::exchange(playing_, true))
    for (Sequence& lane : lanes_) lane.begun = false;
  if (wrong) return illegal(sources_.front().place_of(entry.event) + wrong->text);
  return {};
}

/// A process has died before, and starts again.
Outcome WrittenOrder::begin_again(const Recording::Entry& entry) {
  const auto found = std::ranges::find(processes_.names, entry.text.substr(0, entry.text.find('\n')));
  if (found == processes_.names.end() || !incarnation_in(entry.text))
    return illegal(
        fmt::format("{}'{}' is no start of a process", sources_.front().place_of(entry.event), entry.text));
  StartId& current = current_[ProcessId{static_cast<std::uint32_t>(found - processes_.names.begin())}];
  current = {begun_++};
  play_->restart(current);
  return {};
}

}  // namespace tessera::replay
