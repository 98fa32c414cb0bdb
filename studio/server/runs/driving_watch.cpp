#include "server/runs/driving_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "project/process/control_connection.hpp"
#include "project/process/control_reader.hpp"
#include "server/http/json_text.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/monitor.hpp"

namespace tessera::server {

using nlohmann::json;
using project::ControlConnection;

namespace {

using WatchClock = std::chrono::steady_clock;

/// One socket, until its first state has come.
struct Looked {
  std::string name;
  std::optional<ControlConnection> connection;  ///< nullopt: it takes none now, or was read
  project::ControlReader heard;
  std::optional<Snapshot> snapshot;
  bool over = false;  ///< nobody listens there

  void hear() {
    while (connection) {
      const auto received = connection->receive_at_once(heard);
      while (std::optional<project::ControlMessage> message = heard.next())
        if (auto* state = message->content ? std::get_if<Snapshot>(&*message->content) : nullptr) {
          snapshot = std::move(*state);
          connection.reset();
          return;
        }
      if (received == ControlConnection::Received::nothing) return;
      if (received == ControlConnection::Received::over || heard.exceeds_limits()) {
        over = received == ControlConnection::Received::over;
        connection.reset();
      }
    }
  }
};

/// A run under control of a client has the simulated clock: it drives nothing.
bool drives(const Looked& one) { return !one.over && (!one.snapshot || !one.snapshot->control); }

json look_at_controllers() {
  // Those that hang are shown as well: their devices may move.
  constexpr auto patience = std::chrono::milliseconds(500);
  std::vector<Looked> all;
  for (const std::filesystem::path& file : project::control_sockets(monitor_folder())) {
    ControlConnection::Attempt made = ControlConnection::attempt(file);
    if (!made.connection && !made.may_listen) continue;
    Looked& one = all.emplace_back();
    one.name = file.stem().string();
    one.connection = std::move(made.connection);
  }
  for (const auto end = WatchClock::now() + patience; WatchClock::now() < end;) {
    std::vector<const ControlConnection*> open;
    for (Looked& one : all) {
      one.hear();
      if (one.connection) open.push_back(&*one.connection);
    }
    if (open.empty()) break;
    ControlConnection::wait_for_any(
        open, std::max(std::chrono::milliseconds(1),
                       std::chrono::ceil<std::chrono::milliseconds>(end - WatchClock::now())));
  }
  json controllers = json::array();
  for (const Looked& one : all) {
    if (!drives(one)) continue;
    const std::string system = one.snapshot ? one.snapshot->system : one.name.substr(0, one.name.find('.'));
    controllers.push_back(
        {{"name", one.name},
         {"system", system},
         {"process", one.snapshot ? one.snapshot->pid : -1},
         {"deployed", one.snapshot && one.snapshot->process.has_value()},
         {"answers", one.snapshot.has_value()},
         {"emergency",
          one.snapshot && one.snapshot->emergency ? json(*one.snapshot->emergency) : json(nullptr)}});
  }
  return {{"controllers", std::move(controllers)}};
}

}  // namespace

DrivingWatch::DrivingWatch(Events& events) : events_(events), thread_([this] { watch(); }) {}

DrivingWatch::~DrivingWatch() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  news_.notify_all();
  thread_.join();
}

json DrivingWatch::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

void DrivingWatch::look_soon() {
  {
    const std::lock_guard lock(mutex_);
    soon_ = true;
  }
  news_.notify_all();
}

void DrivingWatch::watch() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    lock.unlock();
    json now;
    try {
      if (events_.has_subscribers()) now = look_at_controllers();
    } catch (const std::exception&) {
      // The folder of the sockets cannot be read: there is nothing to tell.
    }
    lock.lock();
    if (!now.is_null() && now != last_) {
      last_ = now;
      events_.publish("driving", text_of(now));
    }
    news_.wait_for(lock, std::chrono::seconds(1), [this] { return soon_ || over_; });
    soon_ = false;
  }
}

}  // namespace tessera::server
