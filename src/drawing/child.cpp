#include "drawing/child.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "drawing/drawing.hpp"

namespace tessera::drawing {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Temporary files and not pipes: neither process can fill a pipe and wait for the other.
File temporary() {
  File file(std::tmpfile(), &std::fclose);
  if (!file) throw LayoutError(std::string("cannot create a temporary file: ") + std::strerror(errno));
  return file;
}

std::string contents(std::FILE* file) {
  std::rewind(file);
  std::string text;
  std::array<char, 65536> chunk{};
  for (std::size_t got = 0; (got = std::fread(chunk.data(), 1, chunk.size(), file)) > 0;)
    text.append(chunk.data(), got);
  return text;
}

/// Exit status of `dot -Tjson` with these files as its three streams.
int run_with(std::FILE* in, std::FILE* out, std::FILE* err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(in), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(err), STDERR_FILENO);
  char program[] = "dot", format[] = "-Tjson";
  std::array<char*, 3> arguments{program, format, nullptr};
  pid_t child = 0;
  const int failure = posix_spawnp(&child, program, &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT)
    throw LayoutError(
        "pictures are laid out by graphviz, whose program 'dot' is not installed (Debian: graphviz)");
  if (failure != 0)
    throw LayoutError(std::string("cannot start graphviz's 'dot': ") + std::strerror(failure));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

std::string run_dot(const std::string& graph) {
  const File in = temporary(), out = temporary(), err = temporary();
  if (std::fwrite(graph.data(), 1, graph.size(), in.get()) != graph.size() || std::fflush(in.get()) != 0)
    throw LayoutError(std::string("cannot write a temporary file: ") + std::strerror(errno));
  std::rewind(in.get());
  const int status = run_with(in.get(), out.get(), err.get());
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw LayoutError("graphviz's 'dot' failed: " + contents(err.get()));
  return contents(out.get());
}

}  // namespace tessera::drawing
