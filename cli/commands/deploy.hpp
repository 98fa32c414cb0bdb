#pragma once

#include <string>
#include <vector>

#include "project/deployed_run.hpp"
#include "project/files/run_folder.hpp"

namespace tessera::cli {

/// The options of `tessera run --deploy`.
struct DeployOptions {
  bool asked = false;
  static constexpr const char* all = "*";
  std::string only = all;  ///< "office,cart[0]"
  std::string restart = "never", on_failure = "stop";
  std::string bags;  ///< folder of the bags; empty: there are none
  project::NetworkOptions network;
};

/// Checks that the options fit the deployment of the specification. Prints the mistakes. process: of
/// `--process`. Also true if the specification cannot be read, because another function reports that. Called
/// before anything is built.
[[nodiscard]] bool check_deployment(const std::string& spec, const DeployOptions& deploy,
                                    const std::string& process);

/// Starts the processes of this machine and waits until all have ended. Prints their lines, each after its
/// name, and at the end a table. Returns the exit code: `ok`; `failed` if one has failed; 128 + the signal
/// that stopped them.
int run_deployed(const project::Controller& controller, const project::RunFolder& folder,
                 const project::LaunchOptions& options, const DeployOptions& deploy);

}  // namespace tessera::cli
