#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "project/controller.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct Options {
  std::string spec = ".", output, json;
  bool stubs = false;
  Gate gate;
};

int generate_command(const Options& options) {
  const std::optional<Verified> verified = walk(options.spec, options.gate, terminal());
  if (!verified) return refused();
  const Step step(terminal(), "generating");
  const Generated generated = generate(*verified, {options.stubs, options.output});
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
  return report_missing(generated, terminal()) ? ok : failed;
}

}  // namespace

void add_generate(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("generate", "Write the C++ controller that executes the verified net");
  auto options = std::make_shared<Options>();
  command->add_option("spec", options->spec, "Specification, or the folder of its spec.yaml")
      ->capture_default_str();
  command->add_option("-o,--output", options->output,
                      "Folder for the generated files (default: .tessera/generated)");
  command->add_flag("--stubs", options->stubs, "Append stubs of missing transition functions to your files");
  declare_gate(*command, options->gate);
  command->add_option("--json", options->json, "Write what was done as JSON (- is standard output)");
  command->footer("Example: tessera generate --stubs");
  command->callback([options, &exit_code] { exit_code = generate_command(*options); });
}

}  // namespace tessera::cli
