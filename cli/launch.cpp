#include "cli/launch.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include "cli/outcome.hpp"
#include "cli/terminal.hpp"
#include "project/files/installation.hpp"

namespace tessera::cli {

void declare_specification(Subcommand& command, std::string& spec) {
  command.option("spec", spec, "Specification, or the folder of its spec.yaml").shows_default();
}

void declare_verification_gate(Subcommand& command, project::VerificationGate& gate) {
  command.option("--verify-timeout", gate.timeout, "How long verification may take, such as 10s or 2min")
      .shows_default();
  command.flag("--accept-violations", gate.accept_violations,
               "Make the controller although a property is violated (it carries the verdicts)");
}

void declare_run_options(Subcommand& command, project::LaunchOptions& options) {
  options.progress = isatty(STDERR_FILENO) != 0;
  declare_specification(command, options.spec);
  command.option("--for", options.duration, "How long to run: 60s, 500ms, 2min");
  command.option("--set", options.set, "PATH=VALUE: change a parameter (v=0.3, robot.control.v=0.3)")
      .repeated();
  command.option("--parameters", options.parameters,
                 "YAML file of parameters (default: params.yaml of the project)");
  command.option("--record", options.record,
                 "The file of the recording (default: in the folder of the run, which .tessera/last shows)");
  command.option(
      "--record-limit", options.record_limit,
      fmt::format("Keep the newest part of the recording only: 500MB in all, or 100MBx5, five files of "
                  "100 MB; none: all of it (default: {})",
                  project::usual_record_limit));
  command
      .option("--record-values", options.record_values,
              "Which values of buffers to record: none, small (up to 4 KiB; of larger ones a hash), all")
      .one_of({"none", "small", "all"})
      .shows_default();
  command
      .option("--inject", options.inject,
              "Plant a fault, FAULT@WHEN: robot.control.follow:throw@2.5s, robot.control:stall=200ms@1s, "
              "device:robot.motor@any (docs/use/running.md)")
      .repeated();
  command.flag("--accept-stuck", options.accept_stuck,
               "Do not fail if a subsystem waits for ever while others go on");
  declare_verification_gate(command, options.gate);
  command.flag("--also", options.also, "Start although another run uses the same real devices");
  command.flag("--debug", options.debug, "Build for gdb and print the command that debugs this run");
}

void declare_world_options(Subcommand& command, project::LaunchOptions& options) {
  command.option("--seed", options.seed, "Seed of sensor noise and of ties between subsystems")
      .shows_default();
  command
      .option("--hardware", options.hardware,
              "SUBSYSTEM or BUFFER that keeps its real driver (hardware in the loop); the simulated clock is "
              "then not faster than the wall clock")
      .repeated();
  command.option("--track", options.track, "PNG of the floor, dark is line");
  command.option("--metres-per-pixel", options.metres_per_pixel, "Scale of the floor picture").positive();
  command.option("--start", options.start,
                 "Start pose X,Y,DEGREES: metres from the lower left corner (default: on the line)");
}

int print_debugger_line(const project::Command& command) {
  const auto printers = project::Installation::find().share / "gdb/tessera_printers.py";
  project::Command line{"gdb", "-ix", printers.string(), "--args"};
  line.insert(line.end(), command.begin(), command.end());
  fmt::print("{}\n", project::shell_line(line));
  return ok;
}

}  // namespace tessera::cli
