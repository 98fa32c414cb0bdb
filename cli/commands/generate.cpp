#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/outputs.hpp"
#include "cli/terminal.hpp"
#include "project/build/controller.hpp"
#include "project/files/lock_file.hpp"
#include "project/files/state_folder.hpp"
#include "project/service_units.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct GenerateCommandOptions {
  std::string spec = ".", output, json, systemd;
  std::vector<std::string> sources;
  bool stubs = false, build = false;
  VerificationGate gate;
};

Generated generate_alone(const Verified& verified, const GenerateCommandOptions& options) {
  const std::optional<LockFile> lock =
      options.output.empty()
          ? take_build_lock(state_folder(verified.specification.project), terminal(), nullptr)
          : std::nullopt;
  return generate(verified,
                  {options.stubs, options.output, {options.sources.begin(), options.sources.end()}});
}

int generate_command(const GenerateCommandOptions& options) {
  check_replaceable(options.json, "{");
  const std::optional<Verified> verified = run_pipeline(options.spec, options.gate, terminal());
  if (!verified) return exit_code_without_net();
  const project::Step step(terminal(), "generating");
  const Generated generated = generate_alone(*verified, options);
  if (!options.json.empty()) {
    nlohmann::json verdicts = nlohmann::json::object();
    for (const verify::PropertyResult& property : verified->net.report().properties)
      verdicts[property.name] = name_of(property.verdict);
    const nlohmann::json result{{"folder", generated.folder.string()},
                                {"files", generated.files},
                                {"written", generated.written},
                                {"lines", generated.lines},
                                {"net_hash", verified->net.report().net_hash},
                                {"verification_hash", verified->net.report().verification_hash},
                                {"verdicts", verdicts},
                                {"seconds", step.seconds()}};
    write_output(options.json, result.dump(2) + "\n");
  } else {
    fmt::print("{} files, {} lines in {} ({} changed)\n", generated.files, generated.lines,
               generated.folder.string(), generated.written);
  }
  if (!report_missing(generated, terminal())) return failed;
  for (const codegen::Stub& stub : options.stubs ? generated.unclear : std::vector<codegen::Stub>())
    fmt::print(stderr,
               "note: whether {} has a function '{}' is for the compiler to say; nothing is written for it\n",
               stub.subsystem, stub.function);
  if (!options.systemd.empty())
    for (const std::string& file : write_service_units(verified->specification.model, options.systemd))
      fmt::print(stderr, "{}\n", file);
  if (!options.build) return ok;
  return make_controller(options.spec, {.gate = options.gate}, terminal()) ? ok : failed;
}

}  // namespace

void add_generate(CommandLine& app) {
  Subcommand command = app.add("generate", "Write the C++ controller that executes the verified net");
  GenerateCommandOptions& options = command.runs(generate_command);
  declare_specification(command, options.spec);
  command.option("-o,--output", options.output,
                 "Folder for the generated files (default: .tessera/generated)");
  command
      .option("--sources", options.sources,
              "A source with transition functions, instead of all in src/ (for builds of your own)")
      .repeated();
  command.flag("--stubs", options.stubs, "Write missing transition functions into src/, empty");
  command
      .flag("--build", options.build,
            "Compile the controller too, so that a read-only copy of the project runs")
      .excludes(command.declared("--output"));
  command.option(
      "--systemd", options.systemd,
      "Folder for a unit of systemd per process of `deploy`, or one for the system (docs/use/service.md)");
  declare_verification_gate(command, options.gate);
  command.option("--json", options.json, "Write the list of changes as JSON (- is standard output)");
  command.footer("Example: tessera generate --stubs");
}

}  // namespace tessera::cli
