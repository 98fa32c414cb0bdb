#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "language_server/server.hpp"
#include "project/files/installation.hpp"

namespace tessera::cli {

void add_lsp(CommandLine& app) {
  Subcommand command = app.add("lsp", "Help an editor to write specifications (Language Server Protocol)");
  command.footer(
      "Editors start this command and speak to it over standard input and output. It completes, explains "
      "and\n"
      "renames names of the specification, and shows mistakes while you type.\n"
      "docs/use/editors.md says how VS Code and Neovim start it.");
  command.runs([] {
    return language_server::serve({.schema = project::Installation::find().share / "spec.schema.json"});
  });
}

}  // namespace tessera::cli
