#include "server/recordings/recording_notes.hpp"

#include <fmt/core.h>

#include <optional>
#include <stdexcept>

#include "project/files/file_names.hpp"
#include "project/files/files.hpp"
#include "server/analysis/spec_file.hpp"
#include "server/http/json_text.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 20U;
/// In a file `keep`, which keeps the folder of a run: notes have made it, and may remove it again.
constexpr const char* kept_for_notes = "for its notes\n";

fs::path notes_of(const fs::path& recording) {
  return recording.string() + project::file_names::notes_ending;
}

bool is_plain_file(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() == fs::file_type::regular;
}

json shown(const Notes& notes, const std::string& revision, const char* problem) {
  json marks = json::array();
  for (const Notes::Mark& mark : notes.marks) marks.push_back({{"t", mark.time_ns}, {"text", mark.text}});
  return {{"title", notes.title},
          {"text", notes.text},
          {"marks", marks},
          {"revision", revision},
          {"problem", problem}};
}

/// nullopt: the text is not what `write` makes.
std::optional<Notes> read(const std::string& text) {
  const json given = json::parse(text, nullptr, /*allow_exceptions=*/false);
  try {
    Notes notes{given.at("title"), given.at("text"), {}};
    for (const json& mark : given.at("marks")) notes.marks.push_back({mark.at("t"), mark.at("text")});
    if (notes.problem().empty()) return notes;
  } catch (const json::exception&) {
    // Another program has written it.
  }
  return std::nullopt;
}

/// Old runs are removed, but not one for which somebody has written something down.
void keep_run(const fs::path& recording, bool keep) {
  if (recording.filename() != project::file_names::recording) return;
  const fs::path file = recording.parent_path() / "keep";
  std::error_code ignored;
  const bool exists = fs::symlink_status(file, ignored).type() != fs::file_type::not_found;
  if (keep && !exists) project::write_file(file, kept_for_notes);
  if (!keep && is_plain_file(file) && project::content_of(file) == kept_for_notes) fs::remove(file, ignored);
}

}  // namespace

std::string Notes::problem() const {
  if (title.size() > longest_title) return fmt::format("a name has at most {} bytes", longest_title);
  if (title.find('\n') != std::string::npos) return "a name is one line";
  if (text.size() > longest_text) return fmt::format("a note has at most {} bytes", longest_text);
  if (marks.size() > most_marks) return fmt::format("a recording has at most {} marks", most_marks);
  for (const Mark& mark : marks)
    if (mark.text.size() > longest_mark) return fmt::format("a mark has at most {} bytes", longest_mark);
  return {};
}

json RecordingNotes::of(const fs::path& recording) {
  const fs::path file = notes_of(recording);
  std::error_code ignored;
  if (fs::symlink_status(file, ignored).type() == fs::file_type::not_found) return nullptr;
  constexpr const char* unreadable = "the file beside the recording is not one that the studio has written";
  if (!is_plain_file(file) || fs::file_size(file, ignored) > largest_file) return shown({}, "?", unreadable);
  const std::string text = project::content_of(file);
  const std::optional<Notes> notes = read(text);
  return notes ? shown(*notes, revision_of(text), "") : shown({}, "?", unreadable);
}

RecordingNotes::Outcome RecordingNotes::write(const fs::path& recording, const Notes& notes,
                                              const std::string& revision) {
  const std::lock_guard lock(writing_);
  json now = of(recording);
  const bool readable = now.is_null() || now.at("problem") == "";
  if (!readable || (now.is_null() ? std::string() : now.at("revision").get<std::string>()) != revision)
    return {.conflict = true, .now = std::move(now)};
  const fs::path file = notes_of(recording);
  if (notes.empty()) {
    std::error_code problem;
    fs::remove(file, problem);
    if (problem) throw std::runtime_error(file.string() + ": " + problem.message());
  } else {
    json written = shown(notes, "", "");
    written.erase("revision");
    written.erase("problem");
    project::write_file(file, written.dump(1) + "\n");
  }
  keep_run(recording, !notes.empty());
  return {.conflict = false, .now = of(recording)};
}

}  // namespace tessera::server
