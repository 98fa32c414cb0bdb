#pragma once

#include <string>

/// Specifications of well-known problems, for any number of robots. Every side of every channel blocks.
namespace tessera::verify {

/// A ring in which each robot may start an election, and passes on what it hears.
[[nodiscard]] std::string election(unsigned robots);
/// Philosophers and forks. A fork chooses whom to serve first.
[[nodiscard]] std::string philosophers(unsigned robots);
/// Robots that ask one dock, are let in and leave. The dock chooses whom to hear.
[[nodiscard]] std::string docks(unsigned robots);
/// A ring in which each robot tells or hears either neighbour, as it likes.
[[nodiscard]] std::string gossip(unsigned robots);
/// An auctioneer calls all bidders, hears all bids, and awards the work to one of them, or to none.
[[nodiscard]] std::string auction(unsigned robots);
/// One server that hears every client in turn, and then answers every client in turn.
[[nodiscard]] std::string server(unsigned clients);
/// Two channels, one each way, between a hub and each of its clients. parallel: the hub uses all at once.
[[nodiscard]] std::string hub(unsigned clients, bool parallel);
/// A pipeline whose stages give each other credits.
[[nodiscard]] std::string credits(unsigned stages);

}  // namespace tessera::verify
