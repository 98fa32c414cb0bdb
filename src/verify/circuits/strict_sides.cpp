#include "verify/circuits/strict_sides.hpp"

#include <cstdint>
#include <map>
#include <utility>

#include "verify/circuits/folding.hpp"

namespace tessera::verify {

std::vector<StrictSide> strict_sides(const CommunicationStructure& structure) {
  std::vector<StrictSide> all;
  for (std::uint32_t index = 0; index < structure.channels.size(); ++index) {
    const ChannelFlow& channel = structure.channels[index];
    if (!channel.networked) continue;
    if (waits_to_receive(channel)) all.push_back({channel.receiver, {index}, Side::receive});
    if (waits_to_send(channel)) all.push_back({channel.sender, {index}, Side::send});
  }
  return all;
}

std::string in_words(const CommunicationStructure& structure, const std::vector<StrictSide>& sides) {
  const StrictSide& first = sides.front();
  const ChannelFlow& channel = structure[first.channel];
  const SubsystemFlowId peer = first.side == Side::send ? channel.receiver : channel.sender;
  std::string text = structure[first.subsystem].name +
                     (first.side == Side::send ? " waits for ever for the acknowledgement of "
                                               : " waits for ever for a value of ") +
                     channel.name + (peer.valid() ? " from " + structure[peer].name : std::string());
  const std::size_t more = sides.size() - 1;
  if (more > 0)
    text += ", and " + std::to_string(more) + (more == 1 ? " more side waits so" : " more sides wait so");
  return text + " once the network is cut";
}

std::string timeout_hint(const CommunicationStructure& structure, const net::Net& net,
                         const std::vector<StrictSide>& sides) {
  constexpr std::size_t shown = 6;
  std::vector<std::uint32_t> lines(net.parts().channels.size(), 0);
  for (const net::Place& place : net.places())
    if (place.fused() && place.span.line > 0) lines[place.channel.value] = place.span.line;
  struct Group {
    std::string first;
    std::size_t members = 0;
  };
  std::map<std::pair<std::uint32_t, Side>, Group> groups;  // by line: the channels of a fleet share one
  for (const StrictSide& side : sides) {
    Group& group = groups[{lines[structure[side.channel].id.value], side.side}];
    if (group.members++ == 0) group.first = structure[side.channel].name;
  }
  std::string text = "give each side that waits a timeout: ";
  std::size_t told = 0;
  for (const auto& [key, group] : groups) {
    if (told++ == shown) break;
    text += (told == 1 ? "" : "; ") +
            std::string(key.second == Side::send ? "send_timeout" : "receive_timeout") + " on " +
            net.parts().sources.words(key.first) + " (" + group.first +
            (group.members > 1 ? " and " + std::to_string(group.members - 1) + " more" : "") + ")";
  }
  return text +
         (groups.size() > shown ? "; and " + std::to_string(groups.size() - shown) + " more lines" : "");
}

}  // namespace tessera::verify
