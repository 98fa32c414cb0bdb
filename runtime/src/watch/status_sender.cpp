#include "watch/status_sender.hpp"

#include <cxxabi.h>
#include <fmt/core.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <system_error>

#include "system/console.hpp"
#include "watch/snapshot.hpp"
#include "watch/status_text.hpp"

namespace tessera {
namespace {

using namespace std::chrono_literals;

/// The time between two checks for readers.
constexpr auto look_period = 500ms;
constexpr auto send_period = 200ms;
/// Any program may read: all readers together get 40 messages a second at most.
constexpr auto period_per_reader = 50ms;
/// The snapshot of a large system takes long to write: the thread then rests for this many times as long, up
/// to a second.
constexpr int rest_per_sending = 50;
constexpr auto longest_rest = 1000ms;

/// Processor time of this thread: other work of the machine does not count.
[[nodiscard]] std::chrono::nanoseconds work_so_far() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

StatusSender::StatusSender(const Assembly& assembly, const Clock& clock)
    : assembly_(assembly), clock_(clock) {
  try {
    thread_ = std::thread([this] { serve(); });
  } catch (const std::system_error& error) {
    console::print(LogLevel::warning, clock_.now(), "tessera",
                   fmt::format("other machines cannot watch this run: {}", error.what()));
  }
}

StatusSender::~StatusSender() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  ending_.notify_all();
  thread_.join();
}

bool StatusSender::ends_within(Real::duration time) {
  std::unique_lock lock(mutex_);
  return ending_.wait_for(lock, time, [this] { return ends_; });
}

void StatusSender::serve() {
  try {
    return serve_until_ended();
  } catch (const abi::__forced_unwind&) {
    throw;
  } catch (const std::exception&) {  // no memory: there may be none for the reason either
  }
  console::print(LogLevel::warning, clock_.now(), "tessera", "other machines cannot watch this run any more");
}

void StatusSender::serve_until_ended() {
  Real::duration rest{0};
  while (!ends_within(rest)) rest = send();
  if (assembly_.carrier->watchers() > 0)
    assembly_.carrier->send_status(network::StatusPart::brief, line_of(ControllerHasEnded{}));
}

StatusSender::Real::duration StatusSender::send() {
  const std::size_t watchers = assembly_.carrier->watchers();
  if (watchers == 0) return look_period;
  const auto begin = work_so_far();
  const StatusTexts texts = status_texts(take_snapshot(assembly_, clock_), network::longest_status_bytes);
  assembly_.carrier->send_status(network::StatusPart::brief, texts.brief);
  assembly_.carrier->send_status(network::StatusPart::whole, texts.whole);
  const auto rest =
      std::min<std::chrono::nanoseconds>((work_so_far() - begin) * rest_per_sending, longest_rest);
  return std::max<Real::duration>({send_period, rest, period_per_reader * watchers});
}

}  // namespace tessera
