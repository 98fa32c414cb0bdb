#pragma once

#include <cstdint>
#include <string_view>

namespace tessera {

/// Writes to a descriptor that other processes share, such as standard error, without ever
/// waiting in the kernel. A terminal or a pipe is opened again, because O_NONBLOCK on the shared
/// descriptor would affect the others.
///
/// Threads: one.
class PatientOutput {
 public:
  explicit PatientOutput(int shared);
  PatientOutput(const PatientOutput&) = delete;
  PatientOutput& operator=(const PatientOutput&) = delete;
  ~PatientOutput();

  enum class Result : std::uint8_t { all, some, gone };
  /// Writes as many bytes as the output accepts now, and removes them from `bytes`. gone: the reader has gone
  /// for good.
  [[nodiscard]] Result write(std::string_view& bytes);
  /// Waits until the output accepts bytes, at most for this time.
  void await_room(int milliseconds) const;

 private:
  int shared_, own_ = -1;
  bool socket_ = false, file_ = false;
};

}  // namespace tessera
