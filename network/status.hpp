#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

/// The state that processes of a deployment send to `tessera top` and the studio, on any machine. It is for display
/// only: no process of the deployment reads it, and it carries no commands.
namespace tessera::network {

/// Longer ones are not sent, and are dropped by those who read.
inline constexpr std::size_t longest_status_bytes = 32768;

/// A process sends two texts. The short one fits into one packet, so that it is seldom lost.
enum class StatusPart : std::uint8_t { brief, whole };

/// One start of a process.
struct StatusSource {
  std::uint32_t process = 0;  ///< as its own net numbers it
  std::uint64_t incarnation = 0;
  auto operator<=>(const StatusSource&) const = default;
};

/// Reads the state that the processes of one system send. It takes no part in their deployment: it writes nothing, no
/// process waits for it, and they know only the number of readers.
///
/// Threads: one.
class StatusReader {
 public:
  /// Receives what has arrived. Any program on the network can have written it. Views are valid during the call only.
  class Listener {
   public:
    virtual ~Listener() = default;
    /// text: at most longest_status_bytes.
    virtual void heard(const StatusSource& source, StatusPart part, std::string_view text) = 0;
    /// The middleware has no writer of that source any more: it has ended, or was silent for the lease.
    virtual void left(const StatusSource& source) = 0;
    /// For a person to read.
    virtual void complaint(std::string_view text) = 0;
  };
  virtual ~StatusReader() = default;
  /// Hands over what has arrived. Waits for something at most `longest`.
  virtual void receive(Listener& listener, std::chrono::nanoseconds longest) = 0;
};

/// The settings of a reader. Views are valid while it is made.
struct StatusReaderSetup {
  std::string_view system;
  int domain = 0;
  std::string_view interface;               ///< as CarrierSetup
  std::span<const std::string_view> peers;  ///< the hosts of the processes
};

/// Makes a reader, under the name open_status_reader_function. Errors: as OpenCarrier.
using OpenStatusReader = StatusReader*(const StatusReaderSetup& setup, char* error, std::size_t size);
inline constexpr const char* open_status_reader_function = "tessera_open_status_reader_1";

}  // namespace tessera::network
