#include "project/controller.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <stdexcept>

#include "project/installation.hpp"
#include "project/listener.hpp"
#include "project/process.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
}

bool write_if_changed(const fs::path& file, const std::string& text) {
  if (fs::exists(file) && content_of(file) == text) return false;
  write_file(file, text);
  return true;
}

// Files of an earlier generation that this one does not have would be compiled too.
void remove_stale(const fs::path& folder, const std::set<fs::path>& kept) {
  std::vector<fs::path> stale;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && !kept.contains(entry.path())) stale.push_back(entry.path());
  for (const fs::path& file : stale) fs::remove(file);
}

// The user's text, without comments, has a function of that name taking a Context.
bool defines(const std::string& text, const std::string& function) {
  static const std::regex comments(R"(//[^\n]*|/\*[^*]*\*+(?:[^/*][^*]*\*+)*/)");
  const std::regex definition(R"(\bvoid\s+(\w+::)*)" + function + R"(\s*\(\s*(\w+::)*Context\s*&)");
  return std::regex_search(std::regex_replace(text, comments, " "), definition);
}

std::string new_file(const std::vector<codegen::Stub>& stubs) {
  std::string text = stubs.front().preamble;
  for (const codegen::Stub& stub : stubs) text += "\n" + stub.body;
  return text + "\n" + stubs.front().closing;
}

// Before the last closing brace: the end of the namespace.
void append_stub(const fs::path& file, const codegen::Stub& stub) {
  std::string text = content_of(file);
  const std::size_t brace = text.rfind('}');
  text.insert(brace == std::string::npos ? text.size() : brace, stub.body + "\n");
  write_file(file, text);
}

void user_files(const Specification& specification, bool stubs, Generated& result) {
  std::vector<std::vector<codegen::Stub>> files;
  for (codegen::Stub& stub : codegen::stubs(specification.model)) {
    if (files.empty() || files.back().front().file != stub.file) files.emplace_back();
    files.back().push_back(std::move(stub));
  }
  for (const std::vector<codegen::Stub>& functions : files) {
    const fs::path file = specification.project / functions.front().file;
    if (!fs::exists(file)) {
      write_file(file, new_file(functions));
      result.created.push_back(file);
      continue;
    }
    const std::string text = content_of(file);
    for (const codegen::Stub& stub : functions) {
      if (defines(text, stub.function)) continue;
      if (!stubs) {
        result.missing.push_back(stub);
        continue;
      }
      append_stub(file, stub);
      result.created.push_back(file);
    }
  }
}

// "[3/9] Building ..." of ninja becomes "3/9".
std::string ninja_progress(std::string_view line) {
  const std::size_t end = line.find(']');
  if (line.empty() || line.front() != '[' || end == std::string_view::npos) return {};
  return std::string(line.substr(1, end - 1));
}

// ninja's own lines around the compiler's say nothing to the user.
std::string compiler_output(const std::string& text) {
  std::string kept;
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string line = text.substr(start, end - start);
    start = end + 1;
    const bool noise = line.starts_with("[") || line.starts_with("FAILED:") || line.starts_with("ninja:") ||
                       line.find("/c++ ") != std::string::npos || line.find("/g++ ") != std::string::npos;
    if (!noise) kept += line + "\n";
  }
  return kept;
}

Exit build_step(const Command& command, const BuildOptions& options,
                const std::function<void(std::string_view)>& each_line) {
  return options.stop == nullptr ? capture(command, each_line)
                                 : capture_apart(command, *options.stop, each_line);
}

// A build folder knows absolute paths: one that came with a copied project, or that another installation has
// made, would build other sources than these.
bool configure(const Specification& specification, const Generated& generated, const fs::path& build,
               const BuildOptions& options, Listener& listener) {
  const fs::path note = build / "made_for.txt";
  const std::string made_for =
      fmt::format("{}\n{}\n{}\n", specification.project.string(), generated.folder.string(),
                  Installation::find().cmake_package.string());
  if (fs::exists(build / "build.ninja") && fs::exists(note) && content_of(note) == made_for) return true;
  fs::remove_all(build);
  Step step(listener, "configuring");
  const Exit done = build_step({"cmake", "-S", generated.folder.string(), "-B", build.string(), "-G", "Ninja",
                                fmt::format("-DCMAKE_BUILD_TYPE={}", options.debug ? "Debug" : "Release"),
                                fmt::format("-Dtessera_DIR={}", Installation::find().cmake_package.string()),
                                fmt::format("-DTESSERA_PROJECT_DIR={}", specification.project.string())},
                               options, [&](std::string_view line) { step.progress(line); });
  if (done.code != 0) listener.say(done.text);
  if (done.code != 0) fs::remove(build / "build.ninja");
  if (done.code == 0) write_file(note, made_for);
  return done.code == 0;
}

// Editors look for it at the root of a project.
void link_compile_commands(const fs::path& project, const fs::path& build) {
  const fs::path link = project / "compile_commands.json";
  std::error_code ignored;
  if (fs::is_symlink(link) || !fs::exists(link)) {
    fs::remove(link, ignored);
    fs::create_symlink(fs::relative(build / "compile_commands.json", project), link, ignored);
  }
}

}  // namespace

Generated generate(const Verified& verified, const GenerateOptions& options) {
  const Specification& specification = verified.specification;
  Generated result;
  result.folder =
      options.output.empty() ? specification.project / ".tessera/generated" : fs::absolute(options.output);
  std::set<fs::path> kept;
  for (const codegen::File& file :
       codegen::generate(verified.net, specification.model, specification.file.string())) {
    const fs::path path = result.folder / file.path;
    kept.insert(path);
    ++result.files;
    result.lines += static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
    result.written += write_if_changed(path, file.text) ? 1 : 0;
  }
  remove_stale(result.folder, kept);
  user_files(specification, options.stubs, result);
  return result;
}

bool report_missing(const Generated& generated, Listener& listener) {
  for (const fs::path& file : generated.created) listener.say(fmt::format("wrote {}\n", file.string()));
  for (const codegen::Stub& stub : generated.missing)
    listener.say(
        fmt::format("{}: error: no function '{}'\nhint: add it (or run `tessera generate --stubs`):\n\n{}\n",
                    stub.file, stub.function, stub.body));
  return generated.missing.empty();
}

fs::path compile(const Specification& specification, const Generated& generated, const BuildOptions& options,
                 Listener& listener) {
  const fs::path build = specification.project / ".tessera/build" / (options.debug ? "debug" : "release");
  if (!configure(specification, generated, build, options, listener)) return {};
  Step step(listener, "compiling");
  const Exit done = build_step({"cmake", "--build", build.string(), "--target", options.target}, options,
                               [&](std::string_view line) {
                                 if (const std::string count = ninja_progress(line); !count.empty())
                                   step.progress(count);
                               });
  if (done.code != 0) {
    listener.say(compiler_output(done.text));
    return {};
  }
  link_compile_commands(specification.project, build);
  return build / options.target;
}

std::optional<Controller> make_controller(const fs::path& given, const BuildOptions& options,
                                          Listener& listener) {
  std::optional<Verified> verified = walk(given, options.gate, listener);
  if (!verified) return std::nullopt;
  const Generated generated = generate(*verified);
  if (!report_missing(generated, listener)) return std::nullopt;
  const fs::path program = compile(verified->specification, generated, options, listener);
  if (program.empty()) {
    listener.complain("the controller was not built");
    return std::nullopt;
  }
  return Controller{program, std::move(verified->specification), verified->net.report()};
}

}  // namespace tessera::project
