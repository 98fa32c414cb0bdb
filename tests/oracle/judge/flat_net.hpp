// The flat net of a specification, built from the text of the design (sections 1 to 3) alone.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oracle/nets/petri_net.hpp"
#include "oracle/specification/specification.hpp"

namespace oracle {

/// The meaning of a transition, as far as conditions are concerned.
enum class Role { plain, t4, t5, t6, next, none, sends, skips };

struct FlatTransition {
  std::string name;
  std::vector<int> pre, post;
  Role role = Role::plain;
  int subsystem = -1;  // -1: of the two upper layers
  int behaviour = -1;
  int entry = -1;              // of `next`
  std::map<int, int> facts{};  // values of facts that its condition was evaluated with
  const Skip* skip = nullptr;  // of one that begins a send or skips it
};

struct FlatNet {
  struct PlaceInfo {
    std::string name;
    bool marked = false;
    bool fused = false;
  };
  struct Page {
    std::string path;
    int in = -1, out = -1;
    std::vector<int> places;  // of it and of pages within it; no fused ones
  };
  struct BehaviourInfo {
    std::string path;
    int subsystem = -1;
    const Behaviour* of = nullptr;
    Behaviour whole{};  // with what groups add to it
    int in = -1, out = -1;
    bool waits = false;           // it uses a channel whose side of it blocks
    std::vector<int> received{};  // channels
  };
  struct SubsystemInfo {
    std::string path;
    int in = -1, out = -1, agent_out = -1;
    std::vector<int> behaviours;
    const Subsystem* of = nullptr;
  };
  struct ChannelInfo {
    std::string name;  // "a.control.o->b.control.i"
    const Channel* of = nullptr;
    int sender = -1, receiver = -1;
    std::string output, input;                         // names of the buffers
    std::map<std::string, int> shared;                 // name -> place; empty: no behaviour uses the channel
    std::map<int, std::vector<int>> writing, reading;  // slot -> places of either side
    std::vector<int> reads;                            // transitions that begin to read
    bool received = false;                             // some behaviour has its receiving block
  };
  /// The knowledge of the net of a subsystem about the last communication of a buffer, or a memory cell: one place per
  /// value.
  struct FactInfo {
    int subsystem = -1;
    std::string buffer;  // of a cell "memory.c0"
    int cell = -1;       // of a communication -1
    bool sends = false;
    bool blocks = false;        // a receive; otherwise it skips
    std::vector<int> channels;  // whose blocks set it
    std::vector<int> places;    // well, ill: came, missed; in_time, timed_out
    std::vector<std::string> values;
  };
  struct Counts {
    int places = 0, transitions = 0, pages = 0;
    friend bool operator==(const Counts&, const Counts&) = default;
  };

  std::vector<PlaceInfo> places;
  std::vector<FlatTransition> transitions;
  std::vector<Page> pages;
  std::vector<BehaviourInfo> behaviours;
  std::vector<SubsystemInfo> subsystems;
  std::vector<ChannelInfo> channels;
  std::vector<FactInfo> facts;
  std::map<std::string, int> place_of;
  std::map<std::string, Counts> layers;  // system, agent, subsystem, behaviour, communication
  int system_out = -1;

  int place(const std::string& name) const { return place_of.at(name); }
};

/// All values of `i` for an entry with the index of a fleet: the members' numbers.
struct Fleet {
  int count = 0;  // 0: a single agent
  bool ring = false;
};
Fleet fleet_of(const Specification& specification, const std::string& agent);

FlatNet flat_net(const Specification& specification);

/// The same as a net without names: places and transitions keep their numbers.
PetriNet petri_net(const FlatNet& net);
/// How many tokens are in these places, each of which is named once.
std::uint32_t tokens_in(const Marking& marking, const std::vector<int>& places);
inline bool has_token(const Marking& marking, int place) {
  return marking[static_cast<std::size_t>(place)] > 0;
}

}  // namespace oracle
