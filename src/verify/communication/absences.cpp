#include "verify/communication/absences.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tessera::verify {
namespace {

using BehaviourKey = std::pair<net::SubsystemId, net::BehaviourId>;

class Absences {
 public:
  explicit Absences(const net::Net& net) : net_(net) {
    for (const net::Place& place : net.places())
      if (place.operation.kind == net::Operation::Kind::transition_function)
        lines_.emplace(BehaviourKey(place.subsystem, place.operation.behaviour), place.span.line);
    for (const net::Parts::Block& block : net.parts().blocks)
      users_[{block.channel, block.sends}].push_back(&block);
  }

  void name(ChannelFlow& channel, Side side, const CommunicationStructure& structure) const {
    const bool sends = side == Side::send;
    const char* does = sends ? "sends on it" : "receives it";
    const auto found = users_.find({channel.id, sends});
    if (found == users_.end()) {
      channel.absent = owner_by_name(channel.name, side);
      channel.absence = "no behaviour of " + channel.absent + (sends ? " sends on it" : " receives it");
      return;
    }
    const net::Parts::Block& user = *found->second.front();
    channel.absent = net_.parts()[user.subsystem].path;
    const std::string entered = named({user.subsystem, user.behaviour}) + ", which " + does + ", ";
    const std::string stays = that_stays(user.subsystem, structure);
    channel.absence =
        stays.empty() ? entered + "follows no behaviour of " + channel.absent + " that can run"
                      : channel.absent + " never leaves " + stays + ", so " + entered + "is never entered";
  }

 private:
  /// "look (line 9)"
  [[nodiscard]] std::string named(const BehaviourKey& key) const {
    std::string text = net_.parts()[key.first].behaviours[key.second.value];
    if (const auto line = lines_.find(key); line != lines_.end() && line->second > 0)
      text += " (" + net_.parts().sources.short_words(line->second) + ")";
    return text;
  }

  /// The first behaviour that the subsystem reaches and never leaves; empty: there is none.
  [[nodiscard]] std::string that_stays(net::SubsystemId id, const CommunicationStructure& structure) const {
    const auto subsystem = std::ranges::find(structure.subsystems, id, &SubsystemFlow::id);
    if (subsystem == structure.subsystems.end()) return {};
    const auto stays =
        std::ranges::find_if(subsystem->behaviours, [](const BehaviourFlow& one) { return !one.leaves; });
    if (stays == subsystem->behaviours.end()) return {};
    const std::vector<std::string>& names = net_.parts()[id].behaviours;
    for (std::uint32_t index = 0; index < names.size(); ++index)
      if (net_.parts().behaviour_path(id, {index}) == stays->name) return named({id, {index}});
    return {};
  }

  /// "b.control" of "a.control.y->b.control.x"
  static std::string owner_by_name(const std::string& channel, Side side) {
    const std::size_t arrow = channel.find("->");
    if (arrow == std::string::npos) return "the other side";
    const std::string end = side == Side::send ? channel.substr(0, arrow) : channel.substr(arrow + 2);
    return end.substr(0, end.rfind('.'));
  }

  const net::Net& net_;
  std::map<BehaviourKey, std::uint32_t> lines_;
  std::map<std::pair<net::ChannelId, bool>, std::vector<const net::Parts::Block*>> users_;  // by side: sends
};

}  // namespace

void name_absences(CommunicationStructure& structure, const net::Net& net) {
  const auto is_whole = [](const ChannelFlow& channel) {
    return channel.sender.valid() && channel.receiver.valid();
  };
  if (std::ranges::all_of(structure.channels, is_whole)) return;
  const Absences absences(net);
  for (ChannelFlow& channel : structure.channels)
    if (!is_whole(channel))
      absences.name(channel, channel.sender.valid() ? Side::receive : Side::send, structure);
}

}  // namespace tessera::verify
