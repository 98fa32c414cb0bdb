#pragma once

#include <cstdint>
#include <string_view>

namespace tessera {

/// A descriptor that others share, such as standard error, written to without ever waiting in the kernel: a
/// terminal or a pipe is opened anew, since O_NONBLOCK on the shared one would reach whoever shares it.
///
/// Threads: one.
class PatientOutput {
 public:
  explicit PatientOutput(int shared);
  PatientOutput(const PatientOutput&) = delete;
  PatientOutput& operator=(const PatientOutput&) = delete;
  ~PatientOutput();

  enum class Result : std::uint8_t { all, some, gone };
  /// Writes what there is room for and takes that off `bytes`. gone: nobody will ever read it.
  [[nodiscard]] Result write(std::string_view& bytes);
  /// Waits for room, at most so long.
  void await_room(int milliseconds) const;

 private:
  int shared_, own_ = -1;
  bool socket_ = false, file_ = false;
};

}  // namespace tessera
