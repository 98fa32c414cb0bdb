#include "cli/recordings/film_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cli/outputs.hpp"
#include "project/process/process.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

namespace {

[[nodiscard]] bool is_made_by_ffmpeg(const std::string& ending) {
  return ending == ".mp4" || ending == ".webm" || ending == ".gif";
}

/// The path of a program that the user can start; empty: there is none.
[[nodiscard]] std::string found_in_path(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path candidate = fs::path(rest.substr(0, end)) / program;
    if (end > 0 && access(candidate.c_str(), X_OK) == 0) return candidate.string();
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

[[nodiscard]] project::Command ffmpeg_command(const std::string& program, const std::string& ending,
                                              const std::string& file) {
  project::Command command{program, "-hide_banner", "-loglevel", "error", "-y",
                           "-f",    "yuv4mpegpipe", "-i",        "-"};
  const auto add = [&](std::initializer_list<const char*> words) {
    command.insert(command.end(), words.begin(), words.end());
  };
  if (ending == ".mp4") add({"-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"});
  if (ending == ".webm")
    add({"-pix_fmt", "yuv420p", "-deadline", "realtime", "-cpu-used", "6", "-f", "webm"});
  if (ending == ".gif")
    add({"-vf", "fps=12,split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse", "-f", "gif"});
  command.push_back("file:" + file);
  return command;
}

volatile std::sig_atomic_t film_interrupted = 0;

void note_interrupt(int /*signal*/) { film_interrupted = 1; }

/// Signals that would otherwise end the command and leave the unfinished film behind.
constexpr std::array interrupting{SIGINT, SIGTERM, SIGHUP};

}  // namespace

std::string ending_of(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void check_film_file(const std::string& file, const std::string& ending) {
  if (ending == ".png" || ending == ".apng") check_replaceable(file, "\x89PNG");
  if (ending == ".y4m") check_replaceable(file, "YUV4");
  if (ending == ".gif") check_replaceable(file, "GIF8");
  if (ending == ".webm") check_replaceable(file, "\x1a\x45\xdf\xa3");
  if (ending == ".mp4") check_replaceable(file, std::string_view("\0\0\0\x20", 4));
}

bool is_known_ending(const std::string& ending) {
  return is_made_by_ffmpeg(ending) || ending == ".y4m" || ending == ".png" || ending == ".apng";
}

FilmFile::FilmFile(const std::string& file, const std::string& ending)
    : file_(file), unfinished_(fmt::format("{}.{}.unfinished", file, getpid())) {
  if (is_made_by_ffmpeg(ending))
    start_ffmpeg(ending);
  else
    descriptor_ = open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw std::runtime_error(fmt::format("cannot write '{}': {}", file_, std::strerror(errno)));
  film_interrupted = 0;
  for (std::size_t index = 0; index < interrupting.size(); ++index)
    before_[index] = std::signal(interrupting[index], note_interrupt);
}

FilmFile::~FilmFile() {
  for (std::size_t index = 0; index < interrupting.size(); ++index)
    std::signal(interrupting[index], before_[index]);
  if (descriptor_ >= 0) close(descriptor_);
  if (child_ > 0) waitpid(child_, nullptr, 0);
  std::error_code ignored;
  if (!finished_) fs::remove(unfinished_, ignored);
}

bool FilmFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    if (film_interrupted != 0) return false;
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      reason_ = std::strerror(errno);
      return false;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::optional<Problem> FilmFile::finish(bool complete) {
  if (close(std::exchange(descriptor_, -1)) != 0 && !reason_) reason_ = std::strerror(errno);
  if (child_ > 0) {
    int status = 0;
    while (waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
    child_ = -1;
    if (film_interrupted == 0 && (!WIFEXITED(status) || WEXITSTATUS(status) != 0))
      return Problem{"ffmpeg failed; its message stands above\nhint: --film FILE.png needs no other program"};
  }
  if (film_interrupted != 0) return Problem{fmt::format("interrupted: there is no new '{}'", file_)};
  if (!complete || reason_) return Problem{fmt::format("cannot write '{}': {}", file_, reason_.value_or(""))};
  std::error_code problem;
  fs::rename(unfinished_, file_, problem);
  finished_ = !problem;
  if (problem) return Problem{fmt::format("cannot write '{}': {}", file_, problem.message())};
  return std::nullopt;
}

void FilmFile::start_ffmpeg(const std::string& ending) {
  const std::string program = found_in_path("ffmpeg");
  if (program.empty())
    throw std::runtime_error(fmt::format(
        "a film of the kind {} is made by ffmpeg, which is not installed\n"
        "hint: apt-get install ffmpeg, or --film FILE.png (an animated PNG, which browsers play), or "
        "--film FILE.y4m (uncompressed): both need no other program",
        ending));
  const project::Command command = ffmpeg_command(program, ending, unfinished_);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return;
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  // The end of a child is noticed when a write to it fails.
  std::signal(SIGPIPE, SIG_IGN);
  child_ = fork();
  if (child_ == 0) {
    dup2(ends[0], STDIN_FILENO);
    std::signal(SIGPIPE, SIG_DFL);
    execv(words.front(), words.data());
    _exit(127);
  }
  close(ends[0]);
  descriptor_ = ends[1];
}

}  // namespace tessera::cli
