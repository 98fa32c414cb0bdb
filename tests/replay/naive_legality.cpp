#include "naive_legality.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "net/token_game.hpp"

namespace tessera::replay {
namespace {

using net::TransitionId;

struct NaiveStep {
  TransitionId named{};
  std::vector<TransitionId> meant;  ///< any of them may have happened
  std::uint32_t version = 0;
  std::vector<std::pair<std::size_t, std::size_t>> after{};  ///< lane, number of steps done there
};
using NaiveLane = std::vector<NaiveStep>;

std::string word_of(const std::string& name) { return name.substr(name.rfind('.') + 1); }

class AllOrders {
 public:
  AllOrders(std::span<const Recording> recordings, const net::Net& net) : net_(net) {
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      numbers_[net.transitions()[index].name] = index;
    for (const net::Place& place : net.places())
      if (place.fused() && (word_of(place.name) == "idle" || word_of(place.name) == "sent_memory"))
        networked_.insert(place.channel.value);
    for (const Recording& recording : recordings) read(recording);
  }

  bool possible() {
    if (!sound_ || !numbers_fit()) return false;
    net::Marking marking = net::initial_marking(net_);
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      if (net_.transitions()[index].name == "t_in") net::fire(net_, {index}, marking);
    return search(std::vector<std::size_t>(lanes_.size(), 0), std::move(marking));
  }

 private:
  void read(const Recording& recording) {
    std::map<std::uint32_t, NaiveLane> lanes;
    std::map<std::uint32_t, std::set<std::string>> peers;
    for (const Recording::Entry& entry : recording.entries) {
      const std::uint32_t instance = entry.event.instance();
      if (entry.event.kind() == Event::Kind::peer) {
        const std::string channel = entry.text.substr(0, entry.text.find('\n'));
        sound_ = sound_ && peers[instance].insert(channel).second;
        continue;
      }
      const TransitionId id{numbers_.at(recording.transitions[entry.event.subject].name)};
      const net::ChannelId channel = net_.channel_of(id);
      if (channel.valid() && networked_.contains(channel.value) && needs_peer(id, entry.event.version))
        sound_ = sound_ && peers[instance].contains(net_.parts()[channel]);
      lanes[instance].push_back({.named = id, .meant = group(id), .version = entry.event.version});
    }
    for (auto& [instance, lane] : lanes) lanes_.push_back(std::move(lane));
  }

  /// Acknowledgements, and reads of a value.
  [[nodiscard]] bool needs_peer(TransitionId id, std::uint32_t version) const {
    const std::string word = word_of(net_[id].name);
    if (net_.parts()[net_[id].block].sends) return word == "t3";
    return word == "t1" && version > 0;
  }

  [[nodiscard]] std::vector<TransitionId> group(TransitionId id) const {
    const std::string& name = net_[id].name;
    const std::string word = word_of(name), page = name.substr(0, name.size() - word.size());
    const std::set<std::string> writes{"t2", "t2n", "t2m"},
        ends{"timeout", "withdraw", "withdraw_m", "recall"};
    std::vector<TransitionId> all;
    if (net_[id].block.valid() && net_.parts()[net_[id].block].sends)
      for (const std::set<std::string>& words : {writes, ends})
        if (words.contains(word))
          for (const std::string& other : words)
            if (const auto found = numbers_.find(page + other); found != numbers_.end())
              all.push_back({found->second});
    if (all.empty()) all.push_back(id);
    return all;
  }

  /// The numbers that each side of each channel gives, by themselves, and what comes before what.
  bool numbers_fit() {
    struct Counted {
      std::uint32_t written = 0, reading = 0, last = 0;
      std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> writes, reads;  ///< lane, steps done
    };
    std::map<std::uint32_t, Counted> all;
    std::vector<std::pair<NaiveStep*, std::uint32_t>> reads, acknowledgements;
    for (std::size_t number = 0; number < lanes_.size(); ++number)
      for (std::size_t at = 0; at < lanes_[number].size(); ++at) {
        NaiveStep& step = lanes_[number][at];
        const net::ChannelId channel = channel_of(step.named);
        if (!channel.valid()) {
          if (step.version != 0) return false;
          continue;
        }
        if (!networked_.contains(channel.value)) {
          if (step.version == 0) return false;
          continue;
        }
        Counted& counted = all[channel.value];
        const std::string word = word_of(net_[step.named].name);
        const bool own_number = net_.channel_of(step.named).valid();
        const bool exchange = has_memory_of_its_own(channel);
        if (net_.parts()[net_[step.named].block].sends) {
          if (word == "t1" || word.starts_with("t2")) {
            if (step.version != counted.written + 1) return false;
            if (word == "t1") continue;
            counted.writes[++counted.written] = {number, at + 1};
          } else if (step.version != (own_number ? counted.written : 0)) {
            return false;
          } else if (word == "t3") {
            acknowledgements.emplace_back(&step, channel.value);
          }
        } else if (word == "t1") {
          if (exchange ? step.version < counted.last : step.version <= counted.last) return false;
          counted.reading = counted.last = step.version;
          if (step.version > 0) reads.emplace_back(&step, channel.value);
        } else if (word == "t2") {
          if (step.version != counted.reading) return false;
          counted.reads[step.version] = {number, at + 1};
        } else if (step.version != 0) {
          return false;
        }
      }
    for (const auto& [step, channel] : reads) {
      const auto found = all[channel].writes.find(step->version);
      if (found == all[channel].writes.end()) return false;
      step->after.push_back(found->second);
    }
    for (const auto& [step, channel] : acknowledgements) {
      const auto found = all[channel].reads.find(step->version);
      if (found == all[channel].reads.end()) return false;
      step->after.push_back(found->second);
    }
    return true;
  }

  [[nodiscard]] bool has_memory_of_its_own(net::ChannelId channel) const {
    return std::ranges::any_of(net_.places(), [&](const net::Place& place) {
      return place.channel == channel && word_of(place.name) == "sent_memory";
    });
  }
  /// `timeout` uses no place of its channel.
  [[nodiscard]] net::ChannelId channel_of(TransitionId id) const {
    const net::ChannelId channel = net_.channel_of(id);
    if (channel.valid() || !net_[id].block.valid() || word_of(net_[id].name) != "timeout") return channel;
    const net::ChannelId other = net_.parts()[net_[id].block].channel;
    return networked_.contains(other.value) ? other : channel;
  }

  bool search(std::vector<std::size_t> done, net::Marking marking) {
    std::vector<std::pair<std::vector<std::size_t>, net::Marking>> open{
        {std::move(done), std::move(marking)}};
    while (!open.empty()) {
      auto [at, tokens] = std::move(open.back());
      open.pop_back();
      if (!seen_.insert({at, tokens}).second) continue;
      bool all_done = true;
      for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        if (at[lane] == lanes_[lane].size()) continue;
        all_done = false;
        const NaiveStep& step = lanes_[lane][at[lane]];
        if (!is_due(step, at)) continue;
        for (const TransitionId id : step.meant) {
          if (!net::enabled(net_, id, tokens)) continue;
          auto next = std::pair(at, tokens);
          ++next.first[lane];
          net::fire(net_, id, next.second);
          if (std::ranges::max(next.second) <= 1) open.push_back(std::move(next));
        }
      }
      if (all_done) return true;
      for (std::uint32_t index = 0; index < net_.transitions().size(); ++index) {
        if (!is_of_medium(net_.transitions()[index].role) || !net::enabled(net_, {index}, tokens)) continue;
        auto next = std::pair(at, tokens);
        net::fire(net_, {index}, next.second);
        open.push_back(std::move(next));
      }
    }
    return false;
  }

  /// After what its number says; and on a local channel with the version that is next.
  [[nodiscard]] bool is_due(const NaiveStep& step, const std::vector<std::size_t>& at) const {
    for (const auto& [lane, count] : step.after)
      if (at[lane] < count) return false;
    const net::ChannelId channel = net_.channel_of(step.named);
    if (!channel.valid() || networked_.contains(channel.value)) return true;
    std::uint32_t fired = 0;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane)
      for (std::size_t number = 0; number < at[lane]; ++number)
        fired += net_.channel_of(lanes_[lane][number].named) == channel ? 1 : 0;
    return step.version == fired + 1;
  }

  const net::Net& net_;
  std::map<std::string, std::uint32_t> numbers_;
  std::set<std::uint32_t> networked_;
  std::vector<NaiveLane> lanes_;
  std::set<std::pair<std::vector<std::size_t>, net::Marking>> seen_;
  bool sound_ = true;
};

}  // namespace

bool naive_legality(std::span<const Recording> recordings, const net::Net& net) {
  return AllOrders(recordings, net).possible();
}

}  // namespace tessera::replay
