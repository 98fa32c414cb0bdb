#include <fmt/core.h>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"

namespace tessera::cli {

namespace {

// The words come from the options themselves, so that completion never lags behind.
std::string words_of(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words += " --" + name;
  return words;
}

std::string bash_completion(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    names += " " + command->get_name();
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), words_of(*command));
  }
  return fmt::format(R"(# bash completion of tessera: source this, or put it into /etc/bash_completion.d
_tessera() {{
  local words="{} --help --version"
  case "${{COMP_WORDS[1]}}" in
{}  esac
  [ "$COMP_CWORD" -eq 1 ] && words="{} --help --version"
  if [[ "${{COMP_WORDS[COMP_CWORD]}}" == -* || "$COMP_CWORD" -eq 1 ]]; then
    COMPREPLY=($(compgen -W "$words" -- "${{COMP_WORDS[COMP_CWORD]}}"))
  else
    COMPREPLY=($(compgen -f -- "${{COMP_WORDS[COMP_CWORD]}}"))
  fi
}}
complete -o filenames -F _tessera tessera
)",
                     names, cases, names);
}

}  // namespace

void add_completion(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that completes commands and options in bash");
  command->footer("Example: tessera completion > /etc/bash_completion.d/tessera");
  command->callback([&app, &exit_code] {
    fmt::print("{}", bash_completion(app));
    exit_code = ok;
  });
}

}  // namespace tessera::cli
