#include "network/dds/peer_search.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace tessera::dds {

struct PeerSearch::Shared {
  std::mutex mutex;
  std::condition_variable ended;
  bool ends = false;
  std::vector<Found> found;
};

PeerSearch::PeerSearch(std::vector<std::string> hosts, AddressOf address_of, std::chrono::milliseconds every)
    : shared_(std::make_shared<Shared>()) {
  if (hosts.empty()) return;
  std::thread([shared = shared_, hosts = std::move(hosts), address_of = std::move(address_of), every] {
    search(shared, hosts, address_of, every);
  }).detach();
}

PeerSearch::~PeerSearch() {
  const std::lock_guard lock(shared_->mutex);
  shared_->ends = true;
  shared_->ended.notify_all();
}

void PeerSearch::search(const std::shared_ptr<Shared>& shared, std::vector<std::string> hosts,
                        const AddressOf& address_of, std::chrono::milliseconds every) {
  while (!hosts.empty()) {
    std::unique_lock lock(shared->mutex);
    if (shared->ended.wait_for(lock, every, [&] { return shared->ends; })) return;
    lock.unlock();
    std::erase_if(hosts, [&](const std::string& host) {
      std::string why;
      std::optional<std::string> address = address_of(host, why);
      if (!address) return false;
      const std::lock_guard again(shared->mutex);
      shared->found.push_back({host, *std::move(address)});
      return true;
    });
  }
}

std::vector<PeerSearch::Found> PeerSearch::take_found() {
  const std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->found, {});
}

}  // namespace tessera::dds
