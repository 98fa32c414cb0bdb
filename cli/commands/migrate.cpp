#include <fmt/core.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/line_difference.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "diagnostics/utf8.hpp"
#include "language/language.hpp"
#include "project/files/files.hpp"
#include "project/verification/pipeline.hpp"
#include "spec/parser.hpp"
#include "verify/hashes.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct MigrateOptions {
  std::string spec = ".";
  bool dry_run = false;
};

/// Notes about what the author has to decide.
void tell_by_hand(const language::Migration& migration, const std::string& file, const std::string& text) {
  diagnostics::Diagnostics notes(file, text);
  for (const language::Migration::ByHand& one : migration.by_hand)
    notes.note("N331", one.span,
               "say where a failure of " + diagnostics::in_quotes(one.behaviour) + " leads: " + one.why,
               "without an entry that names it, an error or a failure ends the subsystem, and the run fails");
  terminal().say(notes);
}

/// The identity of the net of a text; nullopt: it has none.
std::optional<std::string> net_hash(const std::string& file, const std::string& text) {
  diagnostics::Diagnostics out(file, text);
  const std::optional<spec::Model> model = spec::parse(out);
  if (!model) return std::nullopt;
  const PartialNets nets = build_what_is_possible(*model, out);
  return nets.flat ? std::optional(verify::hash_of(*nets.flat)) : std::nullopt;
}

void tell_shorter(const language::Shortened& shorter, const std::string& file, const std::string& hash,
                  bool dry_run) {
  for (const std::string& one : shorter.done) fmt::print("{}: {}\n", file, one);
  const std::size_t count = shorter.done.size();
  fmt::print("{}: {} default{} {}; the net is the same: {}\n", file, count, count == 1 ? "" : "s",
             dry_run ? "would be written" : "written", hash);
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
  if (const std::string included = language::included_files(document); !included.empty())
    return complain(
        fmt::format("{} includes {}: `migrate` changes a specification in one file; nothing is written",
                    file.string(), included));
  std::optional<language::Migration> migration = language::migrate(document);
  if (!migration) return complain("cannot migrate " + file.string());
  std::vector<language::TextEdit> edits;
  for (const language::Migration::Step& step : migration->steps) edits.push_back(step.edit);
  const std::string routed = edits.empty() ? found.text() : language::edited(document, edits);
  std::optional<language::Shortened> shorter;
  if (migration->by_hand.empty()) shorter = language::shortened(routed);
  const std::string& text = shorter ? shorter->text : routed;
  std::optional<std::string> hash;
  if (text != routed) {
    hash = net_hash(found.file(), routed);
    if (!hash || hash != net_hash(found.file(), text))
      return complain("the shorter form of " + file.string() + " would have another net; nothing is written");
  }
  fmt::print("{}", line_difference(found.text(), text));
  if (text != found.text() && !options.dry_run) write_file(file, text);
  if (text == found.text()) fmt::print("{}: nothing to change\n", file.string());
  if (!edits.empty())
    fmt::print("{}: {} {} for errors and failures {}\n", file.string(), edits.size(),
               edits.size() == 1 ? "entry" : "entries", options.dry_run ? "would be added" : "added");
  if (hash) tell_shorter(*shorter, file.string(), *hash, options.dry_run);
  tell_by_hand(*migration, found.file(), found.text());
  return migration->by_hand.empty() ? ok : failed;
}

}  // namespace

void add_migrate(CommandLine& app) {
  Subcommand command =
      app.add("migrate", "Let a specification of an earlier version mean what it meant, in its shorter form");
  MigrateOptions& options = command.runs(migrate_command);
  declare_specification(command, options.spec);
  command.flag("--dry-run", options.dry_run, "Show the changes and write nothing");
  command.footer(
      "Entries of `next` that name no error take no errors and no failures any more. Where they did,\n"
      "this command adds { to: NAME, when: error }. Then it writes on_error, send, receive and conditions\n"
      "of subsystems for what their behaviours repeat, if the net stays the same. Comments, order and\n"
      "style stay.\n"
      "Ends with 0 if nothing is left to do, 1 if something has to be decided by hand (N331) or the\n"
      "specification is wrong, 2 if it cannot be read.\n"
      "Example: tessera migrate --dry-run robot/spec.yaml");
}

}  // namespace tessera::cli
