#pragma once

#include <exception>
#include <optional>
#include <utility>

#include "tessera/result.hpp"

/// Errors and warnings of MuJoCo, which would end the process or go to a file otherwise.
namespace tessera::sim {

/// Directs errors and warnings of the engine to `complaint_of`, for the whole process. Repeated calls are
/// allowed.
void catch_complaints();

/// Collects the first warning of the engine in this thread during its lifetime.
class WarningScope {
 public:
  explicit WarningScope(std::optional<Problem>& complaint);
  WarningScope(const WarningScope&) = delete;
  WarningScope& operator=(const WarningScope&) = delete;
  ~WarningScope();

 private:
  std::optional<Problem>* outer_;
};

/// Calls the engine. Returns its error or its first warning.
///
/// Threads: any; each gets its own complaints.
template <class Call>
[[nodiscard]] std::optional<Problem> complaint_of(Call&& call) {
  std::optional<Problem> complaint;
  const WarningScope scope(complaint);
  try {
    std::forward<Call>(call)();
  } catch (const std::exception& e) {
    complaint = Problem{e.what()};
  } catch (...) {  // the engine's own exception type, which no header declares
    complaint = Problem{"the engine gave up without saying why"};
  }
  return complaint;
}

}  // namespace tessera::sim
