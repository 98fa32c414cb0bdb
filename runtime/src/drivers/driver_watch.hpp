#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "tessera/time.hpp"

namespace tessera {

/// Watches the calls of drivers that the thread of the run makes before and after the run. A driver that
/// does not return holds this thread, which can then neither report it nor react to a signal.
///
/// A call that takes longer than a second is reported, and again after two, four and so on seconds.
/// - Constructor, `open` and first safe command: the run waits for them until a signal asks it to stop. If
///   the same call still lasts for `patience` afterwards, the watch gives up.
/// - `close` and destructor: the watch gives up after `patience`.
/// It also gives up if `exit` is called while it exists and nothing else has noticed that (LastChance).
///
/// Threads: constructed and destroyed by the run's, whose calls it watches; one at a time per process.
class DriverWatch {
 public:
  /// what: "close() of robot.motor.left has not returned for 4.0 s". The function ends the process. Meanwhile
  /// the thread of the run does not continue, even if the driver returns after all.
  using EndProcess = std::function<void(const std::string& what)>;
  using Warn = std::function<void(const std::string& text)>;
  DriverWatch(Duration patience, Warn warn, EndProcess end_process);
  DriverWatch(const DriverWatch&) = delete;
  DriverWatch& operator=(const DriverWatch&) = delete;
  ~DriverWatch();

  enum class Step : std::uint8_t { constructor, open, safe_command, close, destructor };
  /// The calling thread calls that driver while this object exists. path: must outlive it. Does nothing in a
  /// thread without a watch.
  class Call {
   public:
    Call(Step step, std::string_view path);
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    ~Call();

   private:
    DriverWatch* watch_;
  };
  /// While it exists, the calls of this thread are not watched.
  class Unwatched {
   public:
    Unwatched() : watch_(of_thread_) { of_thread_ = nullptr; }
    Unwatched(const Unwatched&) = delete;
    Unwatched& operator=(const Unwatched&) = delete;
    ~Unwatched() { of_thread_ = watch_; }

   private:
    DriverWatch* watch_;
  };

 private:
  struct Noted {
    Step step;
    std::string_view path;
    std::int64_t since_ns;
    std::int64_t said_ns = 0;                // how long it had lasted when that was reported last
    std::optional<std::int64_t> asked_ns{};  // when a request to stop was seen
  };
  void watch();
  [[nodiscard]] bool is_too_long(Noted& call) const;
  [[nodiscard]] static bool at_start(const Noted& call) { return call.step <= Step::safe_command; }
  [[nodiscard]] static std::string name_of(const Noted& call);
  void report(Noted& call) const;
  [[noreturn]] void give_up(std::unique_lock<std::mutex>& lock, const std::string& what);
  static void on_exit_called(int code, void* unused);

  static constinit thread_local DriverWatch* of_thread_;
  Duration patience_;
  Warn warn_;
  EndProcess end_process_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::optional<Noted> call_;
  bool is_over_ = false, has_given_up_ = false;
  std::thread thread_;  // the last member: it looks at the others
};

}  // namespace tessera
