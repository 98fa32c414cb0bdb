#include "cli/launch.hpp"

#include <unistd.h>

namespace tessera::cli {

void declare_gate(CLI::App& app, project::Gate& gate) {
  app.add_option("--verify-timeout", gate.timeout, "How long verification may take, such as 10s or 2min")
      ->capture_default_str();
  app.add_flag("--accept-violations", gate.accept_violations,
               "Make the controller although a property is violated (it carries the verdicts)");
}

void declare(CLI::App& command, project::LaunchOptions& options) {
  options.progress = isatty(STDERR_FILENO) != 0;
  command.add_option("spec", options.spec, "Specification, or the folder of its spec.yaml")
      ->capture_default_str();
  command.add_option("--for", options.duration, "How long to run: 60s, 500ms, 2min");
  command.add_option("--set", options.set, "PATH=VALUE: change a parameter (v=0.3, robot.control.v=0.3)")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--parameters", options.parameters,
                     "YAML file of parameters (default: params.yaml of the project)");
  command.add_option(
      "--record", options.record,
      "Where to write the recording (default: in the folder of the run, which .tessera/last shows)");
  command.add_option(
      "--record-limit", options.record_limit,
      "Keep the newest part of the recording only: 500MB in all, or 100MBx5, five files of 100 MB; "
      "none: all of it (default: run 1GB, simulate none)");
  command
      .add_option("--record-values", options.record_values,
                  "Which values of buffers to record: none, small (up to 4 KiB; of larger ones a hash), all")
      ->check(CLI::IsMember({"none", "small", "all"}))
      ->capture_default_str();
  command
      .add_option("--inject", options.inject,
                  "Plant a fault, FAULT@WHEN: robot.control.follow:throw@2.5s, robot.control:stall=200ms@1s, "
                  "device:robot.motor@any (docs/running.md)")
      ->take_all()
      ->allow_extra_args(false);
  command.add_flag("--accept-stuck", options.accept_stuck,
                   "A subsystem that waits for ever, while others go on, is no failure");
  declare_gate(command, options.gate);
  command.add_flag("--debug", options.debug, "Build for gdb and print the command that debugs this run");
}

void declare_world(CLI::App& command, project::LaunchOptions& options) {
  command.add_option("--seed", options.seed, "Seed of sensor noise and of ties between subsystems")
      ->capture_default_str();
  command
      .add_option(
          "--hardware", options.hardware,
          "SUBSYSTEM or BUFFER that keeps its real driver (hardware in the loop); the simulated clock is "
          "then not faster than the wall clock")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--track", options.track, "PNG of the floor, dark is line");
  command.add_option("--metres-per-pixel", options.metres_per_pixel, "Scale of the floor picture")
      ->check(CLI::PositiveNumber);
  command.add_option("--start", options.start,
                     "Start pose X,Y,DEGREES: metres from the lower left corner (default: on the line)");
}

}  // namespace tessera::cli
