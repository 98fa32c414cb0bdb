#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "language/edits/edits.hpp"
#include "language/language.hpp"
#include "project/build/user_sources.hpp"
#include "project/files/files.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct RenameOptions {
  std::string spec = ".", name, to;
  bool dry_run = false;
};

std::string lines_text(const std::set<std::uint32_t>& lines) {
  std::string text = lines.size() == 1 ? "line " : "lines ";
  for (const std::uint32_t line : lines) text += (line == *lines.begin() ? "" : ", ") + std::to_string(line);
  return text;
}

int rename_command(const RenameOptions& options) {
  const std::filesystem::path file = spec_file(options.spec);
  const diagnostics::Diagnostics found = diagnostics::load(file);
  if (is_unreadable(found)) {
    terminal().say(found);
    return usage;
  }
  const language::Grammar grammar("{}");  // which keys are allowed is not asked
  const language::Document document(found.text(), grammar, found.folder());
  const language::Named named = language::find_name(document, options.name);
  if (!named.position) return complain(named.problem);
  std::vector<language::Source> sources;
  for (const std::filesystem::path& source : files_with_names(std::filesystem::absolute(file).parent_path()))
    sources.push_back({source.string(), content_of(source)});
  const language::Renaming renaming =
      language::rename(document, nullptr, *named.position, sources, options.to);
  if (renaming.problem) return complain(*renaming.problem);
  std::map<std::string, std::set<std::uint32_t>> sure, unsure;
  for (const language::TextEdit& edit : renaming.edits)
    (edit.sure ? sure : unsure)[edit.path].insert(edit.range.start.line + 1);
  // All that was read: a file without the name may get it from a change that is made at the same time.
  std::vector<Replacement> read{
      {std::filesystem::absolute(file), document.text(), language::edited(document, renaming.edits)}};
  for (const language::Source& source : sources)
    read.push_back({source.path, source.text, language::edited(source, renaming.edits)});
  if (!options.dry_run && !sure.empty())
    if (const auto problem = replace_together(read.front().file.parent_path(), read))
      return complain("nothing was renamed: " + *problem);
  const auto shown = [&](const std::string& path) {
    return path.empty()
               ? file.string()
               : std::filesystem::path(path).lexically_relative(std::filesystem::absolute(".")).string();
  };
  for (const auto& [path, lines] : sure) fmt::print("{}: {}\n", shown(path), lines_text(lines));
  for (const auto& [path, lines] : unsure)
    fmt::print("{}: {} not changed: only a compiler can tell whether it is the same name\n", shown(path),
               lines_text(lines));
  fmt::print(
      "{} {} {} {}\n", options.name,
      sure.empty()      ? "is"
      : options.dry_run ? "would be"
                        : "is now",
      options.to,
      sure.empty() ? "already" : fmt::format("in {} {}", sure.size(), sure.size() == 1 ? "file" : "files"));
  return ok;
}

}  // namespace

void add_rename(CommandLine& app) {
  Subcommand command =
      app.add("rename", "Give a part of a specification another name, also in C++ and params.yaml");
  RenameOptions& options = command.runs(rename_command);
  command.option("name", options.name, "Its name now, such as robot.control.follow").required();
  command.option("new_name", options.to, "Its new name, such as pursue").required();
  declare_specification(command, options.spec);
  command.flag("--dry-run", options.dry_run, "Show the lines that would change and write nothing");
  command.footer(
      "All files are written or none. If several parts have the name, one of these words before it decides:\n"
      "input:, output:, real:, memory:, parameter:, type:, template:, model:, process:, condition:, field:, "
      "with:.\n"
      "The language server and the studio rename in the same way. The way back is the same command.\n"
      "Ends with 0 if it was renamed, 1 if it cannot be, 2 if the specification cannot be read.\n"
      "Example: tessera rename robot.control.follow pursue robot/spec.yaml");
}

}  // namespace tessera::cli
