#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

/// Making and starting controllers: what the command line and the studio share.
namespace tessera::project {

/// Who is told what happens on the way from a specification to a running controller: a terminal, or a page.
///
/// Threads: called in the thread that does the work.
class Listener {
 public:
  virtual ~Listener() = default;
  /// Text for people: whole lines.
  virtual void say(std::string_view text) = 0;
  /// Every diagnostic, as text unless a listener knows better.
  virtual void say(const diagnostics::Diagnostics& diagnostics);
  /// What is going on, and how far it is; takes the place of what was said before. Empty: that is over.
  virtual void progress(std::string_view what) = 0;

  /// "tessera: error: TEXT"
  void complain(std::string_view text);
  /// "tessera: warning: TEXT"
  void warn(std::string_view text);
};

/// A piece of work that tells of itself once it takes longer than a second.
class Step {
 public:
  Step(Listener& listener, std::string what);
  ~Step();
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;
  /// To be called now and then; detail replaces what was shown behind the step's name.
  void progress(std::string_view detail);
  [[nodiscard]] double seconds() const;

 private:
  Listener& listener_;
  std::string what_;
  std::chrono::steady_clock::time_point start_;
  bool shown_ = false;
};

}  // namespace tessera::project
