#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "verify/verify.hpp"

namespace tessera::codegen {

/// The part of the flat net that one subsystem executes, as in tessera::SubsystemNet: rows are numbered in
/// the order in which they stand here, and names do not include the path of the subsystem.
struct LocalNet {
  struct Port {
    std::string name, buffer;
    bool sends = false;
    net::ChannelId channel{};
    bool operator==(const Port&) const = default;
  };
  struct Place {
    std::string name;
    net::BehaviourId behaviour{};  ///< none: it belongs to the subsystem itself
    std::string does{};            ///< C++: "tessera::calls(1)"; empty: nothing
    std::uint32_t tokens = 0;      ///< at the start
  };
  struct Transition {
    std::string name;
    net::BehaviourId behaviour{};
    std::vector<std::string> inputs{}, outputs{};  ///< C++: "4", "tessera::memory(0, 1)"
    std::string guard{};                           ///< C++: "tessera::if_next(1)"; empty: none
    std::string role{};                            ///< C++: "{tessera::Step::go_on, 1}"
    std::string in_words{};                        ///< "follow.snd.in, motion/empty -> follow.snd.motion.2"
  };
  /// A fact that the net knows, as tessera::Fact.
  struct Fact {
    net::FactId id;
    std::string kind, name;  ///< C++: "tessera::Fact::Kind::received", "grant"
  };
  std::vector<Port> ports;
  std::vector<Fact> facts;
  std::vector<Place> places;  ///< behaviour by behaviour, in each those without operation last
  std::vector<Transition> transitions;
  std::size_t in = 0, out = 0;  ///< places
};

/// The nets that the instances of one unit execute. Most instances share one; those at the end of a fleet may
/// have fewer channels.
struct NetVariants {
  std::vector<LocalNet> nets;
  std::vector<std::uint32_t> of_instance;  ///< per instance of the unit, into nets
};

/// The two ends of a channel: for each the number of the port of its block; none: no behaviour uses it.
struct ChannelPorts {
  std::optional<std::size_t> from, to;
};

struct LocalNets {
  std::vector<NetVariants> of_unit;
  Numbered<net::ChannelId, ChannelPorts> of_channel;
};

struct Unit;

/// Takes the flat net apart, subsystem by subsystem. Linear in the net.
[[nodiscard]] LocalNets take_apart(const verify::VerifiedNet& net, const spec::Model& model,
                                   const std::vector<Unit>& units);

}  // namespace tessera::codegen
