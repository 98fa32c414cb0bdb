#include <memory>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "cli/walk.hpp"
#include "net/pnml.hpp"

namespace tessera::cli {

namespace {

struct Options {
  std::string spec = ".", pnml;
};

int export_command(const Options& options) {
  std::optional<Specification> specification = read(options.spec);
  if (!specification) return failed;
  const std::optional<Nets> nets = build(*specification);
  if (!nets) return failed;
  write_output(options.pnml, net::to_pnml(nets->flat, {specification->model.system}));
  return ok;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("export", "Write the flat net for other tools");
  auto options = std::make_shared<Options>();
  command->add_option("spec", options->spec, "Specification, or the folder of its spec.yaml")
      ->capture_default_str();
  command
      ->add_option("--pnml", options->pnml, "P/T net of ISO/IEC 15909-2 to this file (- is standard output)")
      ->required();
  command->footer("Example: tessera export --pnml net.pnml");
  command->callback([options, &exit_code] { exit_code = export_command(*options); });
}

}  // namespace tessera::cli
