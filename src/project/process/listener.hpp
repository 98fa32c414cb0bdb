#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

/// Makes and starts controllers, for the command line and the studio.
namespace tessera::project {

/// Receives messages and progress on the way from a specification to a running controller. It may be a
/// terminal, or the page of the studio.
///
/// Threads: called in the thread that does the work.
class Listener {
 public:
  virtual ~Listener() = default;
  /// text: for people, in whole lines.
  virtual void say(std::string_view text) = 0;
  /// Reports every diagnostic, as text unless a listener overrides it.
  virtual void say(const diagnostics::Diagnostics& diagnostics);
  /// what: the current step and its progress; it replaces the previous one. Empty: the step is over.
  virtual void progress(std::string_view what) = 0;

  /// "tessera: error: TEXT"
  void complain(std::string_view text);
  /// "tessera: warning: TEXT"
  void warn(std::string_view text);
};

/// A step of the work that reports its progress once it takes longer than a second.
class Step {
 public:
  Step(Listener& listener, std::string what);
  ~Step();
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;
  /// To be called from time to time. `detail` replaces the earlier text after the name of the step.
  void progress(std::string_view detail);
  [[nodiscard]] double seconds() const;

 private:
  Listener& listener_;
  std::string what_;
  std::chrono::steady_clock::time_point start_;
  bool shown_ = false;
};

}  // namespace tessera::project
