#include "recorder/marking_track.hpp"

#include <algorithm>

namespace tessera {

MarkingTrack::MarkingTrack(const FlatNet& net, std::vector<ChannelId> channels) {
  for (const FlatNet::FlatPlace& place : net.places) {
    names_.push_back(place.name);
    marked_.push_back(place.tokens > 0);
  }
  std::uint32_t count = 0;
  for (std::size_t index = 0; index < net.transitions.size(); ++index) {
    const FlatNet::FlatTransition& transition = net.transitions[index];
    const auto first = static_cast<std::uint32_t>(arcs_.size());
    arcs_.insert(arcs_.end(), transition.inputs.begin(), transition.inputs.end());
    const auto outputs = static_cast<std::uint32_t>(arcs_.size());
    arcs_.insert(arcs_.end(), transition.outputs.begin(), transition.outputs.end());
    transitions_.push_back({first, outputs, static_cast<std::uint32_t>(arcs_.size()), channels[index]});
    if (channels[index].valid()) count = std::max(count, channels[index].value + 1);
  }
  versions_.resize(count);
}

bool MarkingTrack::may_fire(const Event& firing) const {
  if (!known_) return true;
  const Arcs& arcs = transitions_[firing.subject];
  if (arcs.channel.valid() && firing.version != 0) {
    const std::uint32_t last = versions_[arcs.channel];
    if (firing.version != (last == UINT32_MAX ? 1 : last + 1)) return false;
  }
  return std::all_of(arcs_.begin() + arcs.inputs, arcs_.begin() + arcs.outputs,
                     [&](std::uint32_t place) { return marked_[place]; });
}

void MarkingTrack::fire(const Event& firing) {
  known_ = known_ && may_fire(firing);
  const Arcs& arcs = transitions_[firing.subject];
  if (arcs.channel.valid() && firing.version != 0) versions_[arcs.channel] = firing.version;
  for (std::uint32_t arc = arcs.inputs; arc < arcs.outputs; ++arc) marked_[arcs_[arc]] = false;
  for (std::uint32_t arc = arcs.outputs; arc < arcs.end; ++arc) marked_[arcs_[arc]] = true;
}

std::string MarkingTrack::marked() const {
  std::string text;
  for (std::size_t place = 0; place < names_.size(); ++place)
    if (marked_[place]) text += names_[place] + '\n';
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace tessera
