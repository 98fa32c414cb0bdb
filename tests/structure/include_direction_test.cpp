// The tables of docs/inside/architecture.md are the rule; the sources keep to them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
const fs::path root = TESSERA_SOURCE_DIR;

std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> all_matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    found.push_back((*at)[1]);
  return found;
}

struct Row {
  std::string name;
  std::vector<std::string> cells;  ///< the names in back quotes of the second column
};

/// The rows of the table whose head is the given line.
std::vector<Row> table(const std::string& head) {
  std::istringstream page(read(root / "docs/inside/architecture.md"));
  std::vector<Row> rows;
  const std::regex quoted("`([^`]+)`");
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line == head) {
      inside = true;
    } else if (inside && !line.starts_with("|")) {
      break;
    } else if (inside && !line.starts_with("|---")) {
      std::vector<std::string> names = all_matches(line, quoted);
      if (names.empty()) continue;
      rows.push_back({names.front(), {names.begin() + 1, names.end()}});
    }
  }
  return rows;
}

std::vector<fs::path> sources(const fs::path& folder, const std::set<std::string>& extensions) {
  std::vector<fs::path> found;
  for (auto at = fs::recursive_directory_iterator(root / folder); at != fs::recursive_directory_iterator();
       ++at) {
    if (at->path().filename() == "node_modules") at.disable_recursion_pending();
    if (at->is_regular_file() && extensions.contains(at->path().extension().string()))
      found.push_back(fs::relative(at->path(), root));
  }
  std::ranges::sort(found);
  return found;
}

std::vector<std::string> includes(const fs::path& file) {
  static const std::regex line("(?:^|\n)\\s*#include \"([^\"]+)\"");
  return all_matches(read(root / file), line);
}

const std::set<std::string> cpp{".cpp", ".hpp"};

std::string module_of(const fs::path& file) {
  auto part = file.begin();
  if (*part == "src" || *part == "studio") ++part;
  return part->string();
}

/// "tessera/..." are the public headers of four modules.
std::string module_of_include(const std::string& include) {
  const std::string first = include.substr(0, include.find('/'));
  if (first != "tessera") return first;
  for (const char* module : {"vocabulary", "executor", "recording"})
    if (fs::exists(root / module / "include" / include)) return module;
  return "runtime";
}

TEST(Structure, ModulesIncludeWhatTheTableNames) {
  std::map<std::string, std::set<std::string>> allowed;
  for (const Row& row : table("| module | includes |")) {
    for (const std::string& cell : row.cells)
      EXPECT_TRUE(cell.starts_with("tessera/") || allowed.contains(cell))
          << row.name << " does not stand below " << cell;
    allowed[row.name] = {row.cells.begin(), row.cells.end()};
  }
  ASSERT_GT(allowed.size(), 15U);
  // Folders of a module, whose headers are included without the module's name.
  std::map<std::string, std::set<std::string>> folders;
  for (const Row& row : table("| module | folders |"))
    folders[module_of(row.name)] = {row.cells.begin(), row.cells.end()};

  std::size_t files = 0;
  for (const char* folder : {"src", "vocabulary", "executor", "recording", "network", "runtime", "sim",
                             "ros2", "studio/server", "cli"})
    for (const fs::path& file : sources(folder, cpp)) {
      ++files;
      const std::string module = module_of(file);
      ASSERT_TRUE(allowed.contains(module))
          << "a module that docs/inside/architecture.md does not know: " << module;
      for (const std::string& include : includes(file)) {
        if (include.find('/') == std::string::npos) continue;  // of the same folder
        const std::string target = module_of_include(include);
        if (target == module || folders[module].contains(target)) continue;
        EXPECT_TRUE(allowed[module].contains(target) || allowed[module].contains(include))
            << file << " includes " << include;
      }
    }
  EXPECT_GT(files, 300U);
}

/// The positions of the names of `row` in it.
std::size_t rank(const Row& row, const std::string& folder) {
  return static_cast<std::size_t>(std::ranges::find(row.cells, folder) - row.cells.begin());
}

TEST(Structure, FoldersOfAModuleIncludeOnlyFoldersBeforeThem) {
  const std::vector<Row> rows = table("| module | folders |");
  ASSERT_GT(rows.size(), 5U);
  const std::regex import_from("from \"(\\.[^\"]+)\"");
  for (const Row& row : rows) {
    const bool web = row.name == "studio/web";
    for (const fs::path& file : sources(row.name, web ? std::set<std::string>{".ts", ".tsx"} : cpp)) {
      const fs::path inside = file.lexically_relative(row.name);
      if (++inside.begin() == inside.end()) continue;  // beside the folders
      const std::string folder = inside.begin()->string();
      if (web && (folder == "tests" || folder == "dist")) continue;
      ASSERT_LT(rank(row, folder), row.cells.size()) << file;
      for (std::string include : web ? all_matches(read(root / file), import_from) : includes(file)) {
        if (web) include = (inside.parent_path() / include).lexically_normal().string();
        if (const std::string own = module_of(row.name) + "/"; include.starts_with(own))
          include.erase(0, own.size());
        const std::string target = include.substr(0, include.find('/'));
        if (const std::size_t at = rank(row, target); at < row.cells.size()) {
          EXPECT_LE(at, rank(row, folder)) << file << " includes " << include;
        }
      }
    }
  }
}

TEST(Structure, FilesAndFoldersAreSmall) {
  std::map<fs::path, std::size_t> in_folder;
  for (const char* folder :
       {"src", "vocabulary", "executor", "recording", "network", "runtime", "sim", "ros2", "studio", "cli"})
    for (const fs::path& file : sources(folder, {".cpp", ".hpp", ".ts", ".tsx", ".css"})) {
      if (file.string().find("/dist/") != std::string::npos) continue;
      const std::string text = read(root / file);
      const bool is_generated = text.starts_with("// Made by ");
      EXPECT_LE(std::ranges::count(text, '\n'), is_generated ? 2000 : 400) << file;
      if (file.extension() != ".css") ++in_folder[file.parent_path()];
    }
  for (const auto& [folder, files] : in_folder) EXPECT_LE(files, 30U) << folder;
}

/// "Where would I change X?" names at most three files for each X, and files that are there.
TEST(Structure, AnswersToWhereWouldIChangeNameFewFilesThatExist) {
  std::istringstream page(read(root / "docs/inside/architecture.md"));
  const std::regex row("^\\| ([^|]*)\\| ([^|]+) \\| [^|]+ \\|$");
  const std::regex quoted("`([^`]+)`");
  std::map<std::string, std::size_t> answers;
  std::string question;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| X | file |")) inside = true;
    if (inside && !line.starts_with("|")) break;
    std::smatch cells;
    if (!inside || line.starts_with("| X |") || line.starts_with("|---")) continue;
    ASSERT_TRUE(std::regex_match(line, cells, row)) << line;
    if (cells[1].length() != 0) question = cells[1];
    ++answers[question];
    for (const std::string& file : all_matches(cells[2], quoted))
      EXPECT_TRUE(fs::exists(root / file)) << question << ": " << file;
  }
  EXPECT_GE(answers.size(), 10U);
  for (const auto& [asked, files] : answers) EXPECT_LE(files, 3U) << asked;
}

}  // namespace
