#include "harm.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <memory>
#include <vector>

namespace {

using command_log::Harm;

volatile int sink = 0;

__attribute__((noinline)) int overflow(int depth) {
  volatile char frame[4096];
  frame[depth % 4096] = static_cast<char>(depth);
  return overflow(depth + 1) + frame[(depth + 1) % 4096];
}

void loop_for_ever() {
  for (;;) sink = sink + 1;
}

void touch_beyond_a_file() {
  const int file = memfd_create("empty", 0);
  auto* const page = static_cast<volatile char*>(mmap(nullptr, 4096, PROT_READ, MAP_SHARED, file, 0));
  sink = page[0];
}

void allocate_for_ever() {
  std::vector<std::unique_ptr<std::vector<char>>> all;
  for (std::size_t size = std::size_t{1} << 40U;; size *= 2)
    all.push_back(std::make_unique<std::vector<char>>(size));
}

void in_real_time() {
  sched_param parameters{};
  parameters.sched_priority = 10;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

void do_harm(Harm harm) {
  switch (harm) {
    case Harm::none:
    case Harm::chatter:
    case Harm::mute:
      return;
    case Harm::abort:
      std::abort();
    case Harm::exit:
      std::exit(0);
    case Harm::quick_exit:
      std::quick_exit(0);
    case Harm::underscore_exit:
      _exit(0);
    case Harm::segv: {
      volatile int* volatile nowhere = nullptr;
      *nowhere = 1;
      return;
    }
    case Harm::bus:
      return touch_beyond_a_file();
    case Harm::fpe:
      raise(SIGFPE);
      return;
    case Harm::ill:
      __builtin_trap();
    case Harm::sys:
      raise(SIGSYS);
      return;
    case Harm::trap:
      raise(SIGTRAP);
      return;
    case Harm::terminate:
      std::terminate();
    case Harm::throw_number:
      throw 42;
    case Harm::pthread_exit:
      pthread_exit(nullptr);
    case Harm::stack_overflow:
      sink = overflow(0);
      return;
    case Harm::loop:
      return loop_for_ever();
    case Harm::fifo_loop:
      in_real_time();
      return loop_for_ever();
    case Harm::out_of_memory:
      return allocate_for_ever();
    case Harm::kill:
      kill(getpid(), SIGKILL);
      return;
    case Harm::stop:
      kill(getpid(), SIGSTOP);
      return;
    case Harm::exec:
      execlp("sleep", "sleep", "1000", nullptr);
      return;
    case Harm::close_all:
      syscall(SYS_close_range, 3U, ~0U, 0U);
      return;
  }
}

}  // namespace

void suffer(command_log::Place place) {
  command_log::Log* const log = command_log::own();
  if (log == nullptr || log->place.load() != place) return;
  const Harm harm = log->harm.load();
  if (harm == Harm::none || harm == Harm::chatter || harm == Harm::mute) return;
  log->harm = Harm::none;
  log->struck_ns = command_log::now_ns();
  do_harm(harm);
}
