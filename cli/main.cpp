#include <cstdlib>
#include <exception>
#include <filesystem>
#include <system_error>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "project/process/process.hpp"
#include "tessera/signals.hpp"
#include "tessera/standard_streams.hpp"

namespace {

namespace cli = tessera::cli;

int command(int argc, char** argv) {
  cli::CommandLine line("tessera", TESSERA_VERSION,
                        "Tessera: robot controllers from hierarchical Petri nets.\n"
                        "From one file to a proved net, a C++ controller and a simulated robot.");
  line.footer(
      "First steps:\n"
      "  tessera new rover && cd rover   a project with a simulated robot\n"
      "  tessera simulate --for 60s      build it and watch it drive\n"
      "`tessera COMMAND --help` shows the options of a command, with examples.");
  line.option(
      "--state", "DIR", [](const std::string& folder) { setenv("TESSERA_STATE_DIR", folder.c_str(), 1); },
      "The folder for builds and recordings, instead of .tessera of the project "
      "(or TESSERA_STATE_DIR)");
  for (auto* add : {cli::add_new,       cli::add_check, cli::add_migrate,
                    cli::add_rename,    cli::add_show,  cli::add_verify,
                    cli::add_export,    cli::add_play,  cli::add_generate,
                    cli::add_package,   cli::add_test,  cli::add_simulate,
                    cli::add_schedules, cli::add_merge, cli::add_run,
                    cli::add_replay,    cli::add_rerun, cli::add_top,
                    cli::add_set,       cli::add_panel, cli::add_emergency_stop,
                    cli::add_reset,     cli::add_world, cli::add_studio,
                    cli::add_guard,     cli::add_lsp,   cli::add_completion})
    add(line);
  try {
    return line.read(argc, argv);
  } catch (const tessera::project::Interrupted& interrupted) {
    cli::terminal().say("tessera: " + tessera::signal_name(interrupted.signal) + ": " + interrupted.what() +
                        "\n");
    return 128 + interrupted.signal;
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string what = error.path1().empty() ? "a file" : error.path1().string();
    const int code = cli::complain("cannot use " + what + ": " + error.code().message());
    if (error.code() == std::errc::no_such_file_or_directory)
      cli::terminal().say(
          "hint: it was there a moment ago; if something has removed it, run the command again\n");
    return code;
  } catch (const std::exception& error) {
    return cli::complain(error.what());
  } catch (...) {  // from a library: MuJoCo's is no std::exception
    return cli::complain("a library failed without saying why");
  }
}

}  // namespace

int main(int argc, char** argv) {
  tessera::open_missing_streams();
  return cli::end_output(command(argc, argv));
}
