#include <fmt/core.h>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"

namespace tessera::cli {

namespace {

// The words come from the options themselves, so that completion is always up to date.
std::string bash_completion(const CommandLine& line) {
  std::string names, cases;
  for (const CommandLine::Words& words : line.words()) {
    names += " " + words.command;
    std::string options;
    for (const std::string& option : words.options) options += " --" + option;
    cases += fmt::format("    {}) words=\"{}\" ;;\n", words.command, options);
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

void add_completion(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("completion", "Print a script that completes commands and options in bash");
  command.footer("Example: tessera completion > /etc/bash_completion.d/tessera");
  command.callback([&app, &exit_code] {
    fmt::print("{}", bash_completion(app));
    exit_code = ok;
  });
}

}  // namespace tessera::cli
