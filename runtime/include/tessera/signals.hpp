#pragma once

#include <array>
#include <csignal>
#include <cstdint>
#include <string>

namespace tessera {

/// The reaction of a process to a signal while it, or its child, may move something. The controller
/// and the program that started it use the same table.
enum class SignalUse : std::uint8_t {
  stop,     ///< the run ends safely; exit code 128 + its number
  suspend,  ///< safe commands first, then the process stops until SIGCONT
  ignore    ///< the call that caused it fails with an error code, which the caller checks
};

struct HandledSignal {
  int number;
  const char* name;
  SignalUse use;
};

/// Every signal that a process can catch and that would otherwise end or stop it, except those of a crash
/// (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP). Real-time signals stop a run, too.
inline constexpr std::array handled_signals{
    HandledSignal{SIGHUP, "SIGHUP", SignalUse::stop},        // the terminal was closed
    HandledSignal{SIGINT, "SIGINT", SignalUse::stop},        // Ctrl-C
    HandledSignal{SIGQUIT, "SIGQUIT", SignalUse::stop},      // Ctrl-backslash
    HandledSignal{SIGTERM, "SIGTERM", SignalUse::stop},      //
    HandledSignal{SIGUSR1, "SIGUSR1", SignalUse::stop},      //
    HandledSignal{SIGUSR2, "SIGUSR2", SignalUse::stop},      //
    HandledSignal{SIGALRM, "SIGALRM", SignalUse::stop},      // a timer of the user's
    HandledSignal{SIGVTALRM, "SIGVTALRM", SignalUse::stop},  //
    HandledSignal{SIGPROF, "SIGPROF", SignalUse::stop},      //
    HandledSignal{SIGIO, "SIGIO", SignalUse::stop},          //
    HandledSignal{SIGPWR, "SIGPWR", SignalUse::stop},        // the power fails
    HandledSignal{SIGSTKFLT, "SIGSTKFLT", SignalUse::stop},  //
    HandledSignal{SIGXCPU, "SIGXCPU", SignalUse::stop},      // a limit, also of real-time threads
    HandledSignal{SIGTSTP, "SIGTSTP", SignalUse::suspend},   // Ctrl-Z
    HandledSignal{SIGPIPE, "SIGPIPE", SignalUse::ignore},    // the output is not read any more
    HandledSignal{SIGXFSZ, "SIGXFSZ", SignalUse::ignore},    // a file may not grow any more
    HandledSignal{SIGTTIN, "SIGTTIN", SignalUse::ignore},    // a background process reads its terminal
    HandledSignal{SIGTTOU, "SIGTTOU", SignalUse::ignore},    // a background process writes to its terminal
};

/// Calls `visit(number, use)` for each handled signal and each real-time signal.
template <class Visit>
void for_handled_signals(Visit visit) {
  for (const HandledSignal& signal : handled_signals) visit(signal.number, signal.use);
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) visit(number, SignalUse::stop);
}

/// "SIGHUP", "SIGRTMIN+3"; for other signals "signal 11".
[[nodiscard]] inline std::string signal_name(int number) {
  for (const HandledSignal& signal : handled_signals)
    if (signal.number == number) return signal.name;
  if (number >= SIGRTMIN && number <= SIGRTMAX)
    return number == SIGRTMIN ? "SIGRTMIN" : "SIGRTMIN+" + std::to_string(number - SIGRTMIN);
  return "signal " + std::to_string(number);
}

}  // namespace tessera
