
#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "net/pnml.hpp"
#include "project/verification/pipeline.hpp"
#include "verify/communication/abstraction.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct ExportOptions {
  std::string spec = ".", pnml;
  bool abstract = false;
};

int export_command(const ExportOptions& options) {
  std::optional<Specification> specification = read(options.spec, terminal());
  if (!specification) return exit_code_without_net();
  const std::optional<Nets> nets = build(*specification, terminal());
  if (!nets) return failed;
  const net::Net net =
      options.abstract ? verify::possible_part(verify::abstract_net(nets->flat)) : nets->flat;
  write_output(options.pnml, net::to_pnml(net, {specification->model.system}));
  return ok;
}

}  // namespace

void add_export(CommandLine& app) {
  Subcommand command = app.add("export", "Write the flat net for other tools");
  ExportOptions& options = command.runs(export_command);
  declare_specification(command, options.spec);
  command.option("--pnml", options.pnml, "P/T net of ISO/IEC 15909-2 to this file (- is standard output)")
      .required();
  command.flag(
      "--abstract", options.abstract,
      "Write the net that `verify` judges: without transitions that never fire, with an outcome where no "
      "condition holds");
  command.footer(
      "Examples: tessera export --pnml net.pnml\n"
      "          tessera export --abstract --pnml net.pnml && tessera verify net.pnml");
}

}  // namespace tessera::cli
