#include <fmt/core.h>

#include <exception>
#include <memory>
#include <string>

#include "cli/candidates.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"

namespace tessera::cli {

namespace {

// The scripts ask the command itself, so completion is always up to date. The answer `:files` means the name
// of a file.
constexpr const char* for_bash =
    R"(# bash completion of tessera: source this, or put it into /etc/bash_completion.d
_tessera() {
  local program=${COMP_WORDS[0]/#\~/$HOME} current=${COMP_WORDS[COMP_CWORD]} line
  type -P -- "$program" > /dev/null || program=tessera
  [ "$current" = = ] && current=
  COMPREPLY=()
  while IFS= read -r line; do
    if [ "$line" = :files ]; then
      compopt -o filenames 2> /dev/null
      while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -f -- "$current")
      return
    fi
    COMPREPLY+=("$line")
  done < <("$program" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2> /dev/null)
  [[ ${#COMPREPLY[@]} -eq 1 && $COMPREPLY == *= ]] && compopt -o nospace 2> /dev/null
  # Names with spaces and brackets get the quotes that they need.
  [[ "${COMPREPLY[*]}" == *[\ \[\*]* ]] && compopt -o filenames 2> /dev/null
  return 0
}
complete -F _tessera tessera
)";

constexpr const char* for_zsh = R"(#compdef tessera
# zsh completion of tessera: put it into a folder of $fpath as _tessera, or source it after compinit
_tessera() {
  local -a found values
  found=("${(@f)$("${(Q)words[1]/#\~/$HOME}" complete "${(@)words[2,CURRENT]}" 2> /dev/null)}")
  if [[ "$found[1]" == :files ]]; then
    _files
    return
  fi
  values=("${(@M)found:#*=}")
  found=("${(@)found:#*=}")
  [[ "$PREFIX" == --*=* ]] && compset -P '*='
  (( $#values )) && compadd -S '' -a values
  (( $#found )) && [[ -n "$found[1]" ]] && compadd -a found
}
if [[ "$funcstack[1]" == _tessera ]]; then _tessera "$@"; else compdef _tessera tessera; fi
)";

constexpr const char* for_fish =
    R"(# fish completion of tessera: put it into ~/.config/fish/completions/tessera.fish
function __tessera_complete
    set -l typed (commandline -opc)
    set -l current (commandline -ct | string collect --allow-empty)
    set -l found ($typed[1] complete $typed[2..-1] "$current" 2> /dev/null)
    if test "$found[1]" = :files
        __fish_complete_path "$current"
    else if test (count $found) -gt 0
        string match -q -- '--*=*' "$current"; and set found (string replace -r '=.*' = -- "$current")$found
        printf '%s\n' $found
    end
end
complete -c tessera -f -a '(__tessera_complete)'
)";

void complete(const CommandLine& line, std::vector<std::string> typed) {
  try {
    const Candidates found = candidates(line, std::move(typed));
    if (found.files) fmt::print(":files\n");
    for (const std::string& word : found.words)
      if (word.find('\n') == std::string::npos) fmt::print("{}\n", word);
  } catch (const std::exception&) {
    // A shell has no place for messages during completion.
  }
}

}  // namespace

void add_completion(CommandLine& app) {
  Subcommand command = app.add("completion", "Print a script that completes command lines in a shell");
  auto shell = std::make_shared<std::string>("bash");
  command.option("shell", *shell, "Which shell").one_of({"bash", "zsh", "fish"}).shows_default();
  command.footer(
      "Commands, options, and their values: pages, parameters and properties of the project, running "
      "systems.\n"
      "Examples:\n"
      "  tessera completion bash > /etc/bash_completion.d/tessera\n"
      "  tessera completion zsh > ~/.zfunc/_tessera         (a folder of $fpath)\n"
      "  tessera completion fish > ~/.config/fish/completions/tessera.fish");
  command.runs([shell] {
    fmt::print("{}", *shell == "zsh" ? for_zsh : *shell == "fish" ? for_fish : for_bash);
    return ok;
  });
  app.add_hidden("complete", [&app](std::vector<std::string> typed) { complete(app, std::move(typed)); });
}

}  // namespace tessera::cli
