#pragma once

#include <exception>
#include <string>
#include <utility>

/// Errors and warnings of MuJoCo, which would end the process or go to a file otherwise.
namespace tessera::sim {

/// Directs errors and warnings of the engine to `complaint_of`, for the whole process. Repeated calls are
/// allowed.
void catch_complaints();

/// Collects the first warning of the engine in this thread during its lifetime.
class WarningScope {
 public:
  explicit WarningScope(std::string& text);
  WarningScope(const WarningScope&) = delete;
  WarningScope& operator=(const WarningScope&) = delete;
  ~WarningScope();

 private:
  std::string* outer_;
};

/// Calls the engine. Returns its error or its first warning; empty: none.
///
/// Threads: any; each gets its own complaints.
template <class Call>
[[nodiscard]] std::string complaint_of(Call&& call) {
  std::string text;
  const WarningScope scope(text);
  try {
    std::forward<Call>(call)();
  } catch (const std::exception& e) {
    text = e.what();
  } catch (...) {  // the engine's own exception type, which no header declares
    text = "the engine gave up without saying why";
  }
  return text;
}

}  // namespace tessera::sim
