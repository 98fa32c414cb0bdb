#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "project/launch.hpp"
#include "project/process/process.hpp"
#include "project/process/process_set.hpp"
#include "spec/model/model.hpp"

/// Runs of a deployed system: which of its processes this machine starts, with which commands and files.
namespace tessera::project {

/// The differences of one run from the deployment of the specification; empty: none.
struct NetworkOptions {
  std::string domain, interface, peers;
};
/// "A, B" as "A" and "B"; empty ones are left out.
[[nodiscard]] std::vector<std::string> names_between_commas(const std::string& list);

/// Processes of a deployment, by their numbers.
struct Placement {
  std::vector<std::uint32_t> here, elsewhere;
};
/// Does the host of a process mean the machine with this name? Empty and `localhost` mean every machine.
[[nodiscard]] bool is_this_machine(const std::string& host, const std::string& machine);
/// The name of this machine.
[[nodiscard]] std::string machine_name();
/// only: names of processes, "cart[*]" for all of a fleet; they run here whatever their host is. Empty: those
/// whose host is this machine. Throws std::runtime_error for a name that the deployment does not have.
[[nodiscard]] Placement placement_of(const spec::Deployment& deployment, const std::vector<std::string>& only,
                                     const std::string& machine);

/// The files that one start of a process leaves in the folder of the run: "process-office.tsr", and of its
/// second start "process-office@2.tsr".
struct ProcessFiles {
  std::filesystem::path recording, summary, note;
};
[[nodiscard]] ProcessFiles process_files(const std::filesystem::path& folder, const std::string& process,
                                         unsigned start);

/// Adds to the command of a controller which process it is.
void add_process(Command& command, const std::string& process, const NetworkOptions& network);
/// The command of a start. Relative names are those of `options`.
[[nodiscard]] Command process_command(const Controller& controller, const LaunchOptions& options,
                                      const NetworkOptions& network, const std::string& process,
                                      const ProcessFiles& files);

/// The command that starts these processes on their own machine, for a person to type there.
[[nodiscard]] std::string command_elsewhere(const LaunchOptions& options, const std::string& host);

/// deployment.json in the folder of a run: times, recordings and ends of all starts of the processes.
class DeploymentFile {
 public:
  DeploymentFile(std::filesystem::path file, const Controller& controller);
  void started(std::uint32_t process, unsigned start, pid_t pid);
  /// how: "ended by itself", "was killed by SIGSEGV in ...".
  void ended(std::uint32_t process, const ProcessEnd& end, const std::string& how);

 private:
  struct Started {
    std::uint32_t process;
    unsigned start;
    pid_t pid;
    std::optional<int> code;
    std::string how;
  };
  void write() const;
  std::filesystem::path file_;
  const spec::Deployment deployment_;
  std::string system_, net_hash_;
  std::vector<Started> all_;
};

}  // namespace tessera::project
