#include "safety/guardian.hpp"

#include <fmt/core.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>
#include <utility>

#include "safety/guardian_shared.hpp"
#include "system/waker.hpp"

namespace tessera {
namespace {

using Stage = Guardian::Shared::Stage;

constexpr std::int64_t longest_start_ns = 10'000'000'000, longest_end_ns = 2'000'000'000;

/// Checks every millisecond until `done`, or until the time limit.
template <class Done>
[[nodiscard]] bool await(std::int64_t limit_ns, Done done) {
  const std::int64_t until_ns = monotonic_ns() + limit_ns;
  while (!done()) {
    if (monotonic_ns() > until_ns) return false;
    const timespec pause{.tv_sec = 0, .tv_nsec = 1'000'000};
    nanosleep(&pause, nullptr);
  }
  return true;
}

/// Whether the child process is gone.
[[nodiscard]] bool collect(pid_t process) {
  const pid_t found = waitpid(process, nullptr, WNOHANG);
  return found == process || (found < 0 && errno == ECHILD);
}

}  // namespace

bool Guardian::is_needed(const System& system, const RunOptions& options) {
  return options.guardian && !guarded_drivers(system, options).empty();
}

std::unique_ptr<Guardian> Guardian::start(const System& system, const RunOptions& options,
                                          std::string& error) {
  void* const memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  const int news = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  const pid_t controller = getpid();
  const pid_t process = memory == MAP_FAILED || news < 0 ? -1 : fork();
  if (process < 0) {
    error = fmt::format("the guardian of the devices cannot start: {}", std::strerror(errno));
    if (memory != MAP_FAILED) munmap(memory, sizeof(Shared));
    if (news >= 0) close(news);
    return nullptr;
  }
  // The bytes are zeros. Both processes may treat them as a Shared in the stage `starts`.
  auto* const shared = static_cast<Shared*>(memory);
  if (process == 0) live_as_guardian(system, options, *shared, news, controller);
  std::unique_ptr<Guardian> guardian(new Guardian(shared, news, process));
  const bool answered =
      await(longest_start_ns, [&] { return shared->stage.load() != Stage::starts || collect(process); });
  if (shared->stage.load() == Stage::ready) return guardian;
  if (shared->stage.load() == Stage::failed)
    error = fmt::format("the guardian of the devices cannot make its drivers: {}", shared->error);
  else
    error = fmt::format("the guardian of the devices {}", answered ? "has died" : "does not answer");
  guardian->dismiss();
  return nullptr;
}

Guardian::~Guardian() {
  tell();
  const auto gone = [this] { return collect(process_); };
  // A guardian that was not dismissed waits for the end of this process.
  if (shared_->stage.load() == Stage::dismissed && !await(longest_end_ns, gone)) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  munmap(shared_, sizeof(Shared));
  close(news_);
}

void Guardian::watch_beats() {
  beat();
  shared_->stage = Stage::beating;
}

void Guardian::ignore_beats() { shared_->stage = Stage::ready; }

void Guardian::beat() { shared_->beats.fetch_add(1, std::memory_order_relaxed); }

void Guardian::dismiss() {
  shared_->stage = Stage::dismissed;
  tell();
}

void Guardian::announce_death() {
  shared_->dying = true;
  tell();
}

const std::atomic<bool>& Guardian::has_acted() const { return shared_->has_acted; }

Guardian::Trouble Guardian::trouble() const {
  return shared_->has_acted.load() ? Trouble::acted : noticed_.load();
}

std::string_view Guardian::describe(Trouble trouble) {
  switch (trouble) {
    case Trouble::none:
      break;
    case Trouble::acted:
      return "the process stood still, and the guardian has given the devices the safe command";
    case Trouble::ended:
      return "the guardian of the devices has ended, and nothing else makes them safe if the controller dies";
    case Trouble::stands_still:
      return "the guardian of the devices stands still, and nothing else makes them safe if the controller "
             "dies";
  }
  return "";
}

void Guardian::look_at_it() {
  constexpr unsigned enough = stands_still_after / beat_period;
  const std::uint64_t signs = shared_->signs_of_life.load(std::memory_order_relaxed);
  const bool is_busy = shared_->has_acted.load() || shared_->dying.load();
  looks_ = signs != std::exchange(signs_, signs) || is_busy ? 0 : looks_ + 1;
  if (looks_ >= enough && !is_dismissed()) noticed_ = Trouble::stands_still;
}

void Guardian::note_end() {
  if (!is_dismissed()) noticed_ = Trouble::ended;
}

bool Guardian::is_dismissed() const { return shared_->stage.load() == Stage::dismissed; }

void Guardian::tell() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(news_, &one, sizeof one);
}

}  // namespace tessera
