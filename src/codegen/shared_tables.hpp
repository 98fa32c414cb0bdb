#pragma once

#include <string>

#include "net/net.hpp"
#include "spec/model/model.hpp"

namespace tessera::codegen {

/// The part of the flat net that belongs to no subsystem, as C++: the memory of the channels and their media,
/// a table for each kind, and the pages above the subsystems.
struct SharedTables {
  std::string channels;  ///< definitions of the tables below; empty: the net has no channels
  std::string pages;     ///< definitions of `system_page` and `agent_page`
  struct Names {
    std::string places, medium;  ///< empty: the channel has none
  };
  Numbered<net::ChannelId, Names> of_channel;  ///< the tables of each channel
};

/// Linear in the net.
[[nodiscard]] SharedTables shared_tables(const net::Net& net);

}  // namespace tessera::codegen
