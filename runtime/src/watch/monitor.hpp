#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>
#include <vector>

#include "assembly/assembly.hpp"
#include "tessera/growing_recording.hpp"
#include "watch/remote_control.hpp"

namespace tessera {

/// Serves what the subsystems show, and the recording (tessera/monitor.hpp), in a thread of its own, from
/// construction to destruction, which is best after the recorder was closed: the last clients see all of it.
/// Takes no part in the run: what goes wrong with it is in `failure` and ends nothing.
///
/// Threads: made and destroyed by one; the assembly must outlive it.
class Monitor {
 public:
  /// remote: takes commands; nullptr: there are none.
  Monitor(Assembly& assembly, const Clock& clock, RemoteControl* remote = nullptr);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  /// A warning on the console unless it listens.
  void complain_of_failure(Time now) const;

 private:
  [[nodiscard]] bool listen_in(const std::string& folder);
  void serve();
  void serve_until_ended();
  void admit();
  struct Client {
    int socket;
    std::string said;                             ///< the beginning of a command
    std::string waiting;                          ///< what its socket had no room for
    std::int64_t took_ns = 0;                     ///< when it last took some of that
    std::unique_ptr<GrowingRecording> recording;  ///< nullptr: it has not asked for it
    bool missed_a_line = false;                   ///< since it had not taken what came before
    bool owner = false;
    bool gone = false;
  };
  void send_to_all();
  static void deliver(Client& client);
  void hear(Client& client);
  void hear_the_rest(Client& client);
  void obey_all(Client& client, std::string_view heard);
  void obey(Client& client, const std::string& line);
  [[nodiscard]] std::string carry_out(const nlohmann::json& command);
  [[nodiscard]] std::string answer_to(const nlohmann::json& command);
  bool add_piece(Client& client);
  void say_goodbye(Client& client);
  void drop_the_gone();
  [[nodiscard]] std::string snapshot() const;

  Assembly& assembly_;
  const Clock& clock_;
  std::string recording_path_, socket_file_, failure_;
  int listening_ = -1, ending_ = -1;
  bool cannot_accept_ = false;  // no descriptor is left: it tries again after the next line
  RemoteControl* remote_;
  std::vector<Client> clients_;
  std::thread thread_;
};

}  // namespace tessera
