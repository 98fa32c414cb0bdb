#include "project/build/line_coverage.hpp"

#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "project/files/state_folder.hpp"
#include "project/process/process.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// The files of the compiler, or of the programs, in the folder of the build.
std::vector<fs::path> files_of_gcov(const Specification& specification, const std::string& ending) {
  const fs::path build = state_folder(specification.project) / "build/coverage";
  std::vector<fs::path> files;
  if (!fs::is_directory(build)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(build))
    if (entry.path().extension() == ending) files.push_back(entry.path());
  return files;
}

/// Count by line, by file. A header is in several outputs.
using Counts = std::map<fs::path, std::map<std::uint32_t, std::uint64_t>>;

void add_counts(const nlohmann::json& output, const fs::path& sources, Counts& counts) {
  // Some compilers are started with paths that are relative to the folder of the build, for example by ccache.
  const fs::path started_in = output.value("current_working_directory", "");
  for (const nlohmann::json& file : output.at("files")) {
    const fs::path path = fs::weakly_canonical(started_in / file.at("file").get<std::string>());
    const fs::path relative = path.lexically_relative(sources);
    if (relative.empty() || *relative.begin() == "..") continue;
    for (const nlohmann::json& line : file.at("lines"))
      counts["src" / relative][line.at("line_number").get<std::uint32_t>()] +=
          line.at("count").get<std::uint64_t>();
  }
}

}  // namespace

void clear_line_coverage(const Specification& specification) {
  for (const fs::path& file : files_of_gcov(specification, ".gcda")) fs::remove(file);
}

std::vector<LineCoverage> line_coverage(const Specification& specification) {
  Counts counts;
  const fs::path sources = fs::weakly_canonical(specification.project / "src");
  // By the files of the compiler: a source that no test has reached has no others.
  for (const fs::path& notes : files_of_gcov(specification, ".gcno")) {
    std::string problem;
    const Exit exit =
        capture({"gcov", "--json-format", "--stdout", notes.string()}, [&](std::string_view line) {
          const nlohmann::json output = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
          if (output.is_object())
            add_counts(output, sources, counts);
          else
            problem += line;
        });
    if (exit.code != 0) throw std::runtime_error(fmt::format("gcov cannot read the coverage: {}", problem));
  }
  std::vector<LineCoverage> result;
  for (const auto& [file, lines] : counts) {
    LineCoverage& one = result.emplace_back(LineCoverage{file, lines.size(), {}});
    for (const auto& [line, count] : lines)
      if (count == 0) one.missed.push_back(line);
  }
  return result;
}

std::string ranges_of(const std::vector<std::uint32_t>& lines) {
  std::string text;
  for (std::size_t at = 0; at < lines.size();) {
    std::size_t last = at;
    while (last + 1 < lines.size() && lines[last + 1] == lines[last] + 1) ++last;
    if (!text.empty()) text += ", ";
    text += last == at ? std::to_string(lines[at]) : fmt::format("{}-{}", lines[at], lines[last]);
    at = last + 1;
  }
  return text;
}

}  // namespace tessera::project
