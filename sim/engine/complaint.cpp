#include "sim/engine/complaint.hpp"

#include <mujoco/mujoco.h>

#include <cstdio>
#include <stdexcept>

namespace tessera::sim {
namespace {

/// Receives the warnings of the engine that this thread causes.
thread_local std::optional<Problem>* warnings = nullptr;

/// MuJoCo requires that this function does not return. Its C code has unwind tables on all Debian
/// architectures that ship it.
[[noreturn]] void on_error(const char* message) { throw std::runtime_error(message); }

void on_warning(const char* message) {
  if (warnings == nullptr) {
    std::fprintf(stderr, "MuJoCo: %s\n", message);
  } else if (!*warnings) {
    *warnings = Problem{message};
  }
}

}  // namespace

void catch_complaints() {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
}

WarningScope::WarningScope(std::optional<Problem>& complaint) : outer_(warnings) { warnings = &complaint; }
WarningScope::~WarningScope() { warnings = outer_; }

}  // namespace tessera::sim
