#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tessera::dds {

/// The IPv4 address of a host, as text. nullopt: it has none now; `why` says why. Waits for the name service.
using AddressOf = std::function<std::optional<std::string>(const std::string& host, std::string& why)>;

/// Looks up the addresses of hosts again and again, until each has one.
///
/// Threads: one caller; the search has a thread of its own.
class PeerSearch {
 public:
  static constexpr std::chrono::milliseconds interval{5000};
  struct Found {
    std::string host, address;
  };

  PeerSearch(std::vector<std::string> hosts, AddressOf address_of,
             std::chrono::milliseconds every = interval);
  /// Does not wait for the name service.
  ~PeerSearch();
  PeerSearch(const PeerSearch&) = delete;
  PeerSearch& operator=(const PeerSearch&) = delete;
  /// The addresses found since the last call.
  [[nodiscard]] std::vector<Found> take_found();

 private:
  struct Shared;
  static void search(const std::shared_ptr<Shared>& shared, std::vector<std::string> hosts,
                     const AddressOf& address_of, std::chrono::milliseconds every);
  std::shared_ptr<Shared> shared_;  ///< shared with a thread that may outlive this object
};

}  // namespace tessera::dds
