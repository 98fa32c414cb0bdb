#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "diagnostics/utf8.hpp"
#include "language/language.hpp"
#include "project/files/files.hpp"
#include "project/verification/pipeline.hpp"
#include "spec/parser.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct MigrateOptions {
  std::string spec = ".";
  bool dry_run = false;
};

/// "-" and "+" before the lines of a text; the last one may have no end.
std::string marked(char mark, std::string_view text) {
  std::string marked;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    marked += mark + diagnostics::visible(line) + "\n";
    at = end + 1;
  }
  return marked;
}

/// The lines that change, before and after.
std::string difference(const language::Document& document,
                       const std::vector<language::Migration::Step>& steps) {
  std::string text;
  const language::Lines& lines = document.lines();
  for (std::size_t first = 0; first < steps.size();) {
    std::size_t next = first + 1;
    std::uint32_t last_line = steps[first].edit.range.end.line;
    for (; next < steps.size() && steps[next].edit.range.start.line <= last_line; ++next)
      last_line = std::max(last_line, steps[next].edit.range.end.line);
    const std::uint32_t line = steps[first].edit.range.start.line;
    const std::size_t begin = lines.start_of(line);
    const std::size_t end =
        last_line + 1 < lines.count() ? lines.start_of(last_line + 1) : document.text().size();
    std::string after;
    std::size_t at = begin;
    for (std::size_t step = first; step < next; ++step) {
      const language::TextEdit& edit = steps[step].edit;
      after += document.text().substr(at, lines.offset(edit.range.start) - at) + edit.text;
      at = lines.offset(edit.range.end);
    }
    after += document.text().substr(at, end - at);
    text += fmt::format("line {}\n", line + 1) + marked('-', document.text().substr(begin, end - begin)) +
            marked('+', after);
    first = next;
  }
  return text;
}

/// Notes about what the author has to decide.
void tell_by_hand(const language::Migration& migration, const std::string& file, const std::string& text) {
  diagnostics::Diagnostics notes(file, text);
  for (const language::Migration::ByHand& one : migration.by_hand)
    notes.note("N331", one.span,
               "say where a failure of " + diagnostics::in_quotes(one.behaviour) + " leads: " + one.why,
               "without an entry that names it, an error or a failure ends the subsystem, and the run fails");
  terminal().say(notes);
}

int migrate_command(const MigrateOptions& options) {
  const std::filesystem::path file = spec_file(options.spec);
  diagnostics::Diagnostics found = diagnostics::load(file);
  if (!found.has_errors()) static_cast<void>(spec::parse(found));
  if (found.has_errors()) {
    terminal().say(found);
    return is_unreadable(found) ? usage : failed;
  }
  const language::Grammar grammar("{}");  // which keys are allowed is not asked
  const language::Document document(found.text(), grammar);
  std::optional<language::Migration> migration = language::migrate(document);
  if (!migration) return complain("cannot migrate " + file.string());
  std::ranges::sort(migration->steps, {}, [](const auto& step) { return step.edit.range; });
  std::vector<language::TextEdit> edits;
  for (const language::Migration::Step& step : migration->steps) edits.push_back(step.edit);
  fmt::print("{}", difference(document, migration->steps));
  if (!edits.empty() && !options.dry_run) write_file(file, language::edited(document, edits));
  const char* what = edits.size() == 1 ? "entry" : "entries";
  if (edits.empty())
    fmt::print("{}: nothing to change\n", file.string());
  else
    fmt::print("{}: {} {} for errors and failures {}\n", file.string(), edits.size(), what,
               options.dry_run ? "would be added" : "added");
  tell_by_hand(*migration, found.file(), found.text());
  return migration->by_hand.empty() ? ok : failed;
}

}  // namespace

void add_migrate(CommandLine& app) {
  Subcommand command = app.add("migrate", "Let a specification of an earlier version mean what it meant");
  MigrateOptions& options = command.runs(migrate_command);
  declare_specification(command, options.spec);
  command.flag("--dry-run", options.dry_run, "Show the changes and write nothing");
  command.footer(
      "Entries of `next` that name no error take no errors and no failures any more. Where they did,\n"
      "this command adds { to: NAME, when: error }. Comments, order and style stay.\n"
      "Ends with 0 if nothing is left to do, 1 if something has to be decided by hand (N331) or the\n"
      "specification is wrong, 2 if it cannot be read.\n"
      "Example: tessera migrate --dry-run robot/spec.yaml");
}

}  // namespace tessera::cli
