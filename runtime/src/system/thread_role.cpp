#include "system/thread_role.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

namespace tessera {
namespace {

/// In addition to the registers that the kernel saves there.
constexpr std::size_t room_of_handler = std::size_t{64} << 10U;

}  // namespace

AlternateStack::AlternateStack() {
  stack_t there{};
  if (sigaltstack(nullptr, &there) != 0 || (there.ss_flags & SS_DISABLE) == 0) return;
  bytes_ = static_cast<std::size_t>(std::max(sysconf(_SC_SIGSTKSZ), 0L)) + room_of_handler;
  void* const memory =
      mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  if (memory == MAP_FAILED) return;  // a stack overflow then kills as usual
  stack_t stack{};
  stack.ss_sp = memory;
  stack.ss_size = bytes_;
  if (sigaltstack(&stack, nullptr) == 0)
    memory_ = memory;
  else
    munmap(memory, bytes_);
}

AlternateStack::~AlternateStack() {
  if (memory_ == nullptr) return;
  stack_t none{};
  none.ss_flags = SS_DISABLE;
  sigaltstack(&none, nullptr);
  munmap(memory_, bytes_);
}

}  // namespace tessera
