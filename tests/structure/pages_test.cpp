#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

/// The pages refer to each other, and the sources to pages, by links and paths that lead somewhere.
namespace tessera::test {
namespace {

namespace fs = std::filesystem;

std::string page_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The regular files below the folder, as paths from the root of the sources, without what was built or fetched.
std::vector<fs::path> files_below(const fs::path& folder) {
  static constexpr std::array<std::string_view, 5> left_out{"node_modules", "dist", "golden", "build",
                                                            ".tessera"};
  const fs::path root = TESSERA_SOURCE_DIR;
  std::vector<fs::path> files;
  for (auto at = fs::recursive_directory_iterator(root / folder); at != fs::recursive_directory_iterator();
       ++at) {
    if (at->is_directory() && std::ranges::find(left_out, at->path().filename().string()) != left_out.end())
      at.disable_recursion_pending();
    else if (at->is_regular_file())
      files.push_back(fs::relative(at->path(), root));
  }
  return files;
}

std::vector<fs::path> files_of_the_tree() {
  std::vector<fs::path> files{"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CMakeLists.txt"};
  for (const char* folder :
       {"benchmarks", "cli", "cmake", "docs", "editors", "examples", "executor", "network", "recording",
        "ros2", "runtime", "scripts", "share", "sim", "src", "studio", "tests", "vocabulary"})
    std::ranges::move(files_below(folder), std::back_inserter(files));
  return files;
}

struct Page {
  std::set<std::string> anchors;
  struct Link {
    std::size_t line = 0;  ///< from 1
    std::string target;    ///< as written
  };
  std::vector<Link> links;
};

/// The anchor that browsers of repositories give a heading: lower case, spaces as "-", no punctuation.
std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ') anchor += '-';
    if (c == '-' || c == '_' || byte >= 0x80 || std::isalnum(byte) != 0)
      anchor += static_cast<char>(std::tolower(byte));
  }
  return anchor;
}

/// The page's headings and relative links; what stands between fences is neither.
Page page_of(const std::string& text) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  Page page;
  std::istringstream lines(text);
  bool is_code = false;
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin != std::string::npos && line.compare(begin, 3, "```") == 0) is_code = !is_code;
    if (is_code) continue;
    if (line.starts_with('#')) page.anchors.insert(anchor_of(line.substr(line.find_first_not_of("# "))));
    for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at)
      if (const std::string target = (*at)[1]; target.find("://") == std::string::npos)
        page.links.push_back({number, target});
  }
  return page;
}

std::map<fs::path, Page> pages_of_the_tree() {
  std::map<fs::path, Page> pages;
  for (const fs::path& file : files_of_the_tree())
    if (file.extension() == ".md") pages[file] = page_of(page_text(fs::path(TESSERA_SOURCE_DIR) / file));
  return pages;
}

/// The file or folder that a link of the page names, from the root of the sources, without its anchor.
fs::path target_of(const fs::path& page, const std::string& link) {
  const std::string path = link.substr(0, link.find('#'));
  return path.empty() ? page : (page.parent_path() / path).lexically_normal();
}

TEST(Pages, EachLinkLeadsToAFileAndAHeading) {
  const std::map<fs::path, Page> pages = pages_of_the_tree();
  std::size_t links = 0;
  for (const auto& [file, page] : pages)
    for (const auto& [line, target] : page.links) {
      ++links;
      const fs::path leads_to = target_of(file, target);
      EXPECT_TRUE(fs::exists(fs::path(TESSERA_SOURCE_DIR) / leads_to))
          << file.string() << ':' << line << ": " << target;
      const std::size_t hash = target.find('#');
      const auto page_there = pages.find(leads_to);
      if (hash != std::string::npos && page_there != pages.end())
        EXPECT_TRUE(page_there->second.anchors.contains(target.substr(hash + 1)))
            << file.string() << ':' << line << ": " << target;
    }
  EXPECT_GT(links, 300U);
}

/// The pages that the links of these pages lead to.
std::set<fs::path> linked_from(const std::set<fs::path>& from, const std::map<fs::path, Page>& pages) {
  std::set<fs::path> there;
  for (const fs::path& file : from)
    for (const Page::Link& link : pages.at(file).links)
      if (const fs::path page = target_of(file, link.target); pages.contains(page)) there.insert(page);
  return there;
}

TEST(Pages, AreReachedInTwoStepsFromTheReadme) {
  const std::map<fs::path, Page> pages = pages_of_the_tree();
  std::set<fs::path> reached = linked_from({"README.md"}, pages);
  reached.merge(linked_from(reached, pages));
  std::size_t rooms = 0;
  for (const auto& [file, page] : pages) {
    if (*file.begin() != "docs") continue;
    ++rooms;
    EXPECT_TRUE(reached.contains(file)) << file.string();
  }
  EXPECT_GT(rooms, 40U);
  const std::string readme = page_text(fs::path(TESSERA_SOURCE_DIR) / "README.md");
  EXPECT_LT(std::ranges::count(readme, '\n'), 120);
}

TEST(Pages, ThatSourcesAndMessagesNameExist) {
  static const std::regex named(R"(\bdocs/[\w/-]+\.md\b)");
  std::size_t names = 0;
  for (const fs::path& file : files_of_the_tree()) {
    const std::string text = page_text(fs::path(TESSERA_SOURCE_DIR) / file);
    if (text.find("docs/") == std::string::npos || text.find('\0') != std::string::npos) continue;
    for (std::sregex_iterator at(text.begin(), text.end(), named), end; at != end; ++at, ++names)
      EXPECT_TRUE(fs::exists(fs::path(TESSERA_SOURCE_DIR) / at->str())) << file.string() << ": " << at->str();
  }
  EXPECT_GT(names, 200U);
}

/// The texts between backquotes.
std::vector<std::string> code_of(const std::string& cell) {
  static const std::regex code("`([^`]+)`");
  std::vector<std::string> texts;
  for (std::sregex_iterator at(cell.begin(), cell.end(), code), end; at != end; ++at)
    texts.push_back((*at)[1]);
  return texts;
}

/// The last word of `Kind::word`, `word` or `word()`; empty: the text is no name of C++ or TypeScript.
std::string name_in(const std::string& code) {
  static const std::regex name(R"((?:\w+::)*([A-Za-z_]\w*)(?:\(\))?)");
  std::smatch found;
  return std::regex_match(code, found, name) ? found[1].str() : "";
}

/// The text of a file, or of all files of a folder.
std::string text_at(const std::string& place) {
  const fs::path root = TESSERA_SOURCE_DIR;
  if (!fs::is_directory(root / place)) return page_text(root / place);
  std::string text;
  for (const fs::path& file : files_below(place)) text += page_text(root / file);
  return text;
}

TEST(Pages, TheAnswersToWhereWouldIChangeXNameWhatIsThere) {
  static const std::regex row(R"(\| ([^|]*) ?\| ([^|]+) \| ([^|]+) \|)");
  const std::string page = page_text(fs::path(TESSERA_SOURCE_DIR) / "docs/inside/architecture.md");
  std::istringstream lines(page.substr(page.find("## Where would I change X?")));
  std::size_t names = 0;
  for (std::string line; std::getline(lines, line);) {
    std::smatch cells;
    if (!std::regex_match(line, cells, row)) continue;
    for (const std::string& place : code_of(cells[2])) {
      EXPECT_TRUE(fs::exists(fs::path(TESSERA_SOURCE_DIR) / place)) << line;
      for (const std::string& code : code_of(cells[3])) {
        const std::string name = name_in(code);
        if (name.empty()) continue;
        ++names;
        EXPECT_TRUE(std::regex_search(text_at(place), std::regex("\\b" + name + "\\b"))) << line;
      }
    }
  }
  EXPECT_GT(names, 12U);
}

TEST(Pages, AreReadWithTheirHeadingsAndLinks) {
  const Page page = page_of(
      "# A `net`: what's in it\n[a](b.md#c)\n```\n# none\n[no](x)\n```\n## Next\n"
      "[web](https://x.org) and [own](#next)");
  EXPECT_EQ(page.anchors, (std::set<std::string>{"a-net-whats-in-it", "next"}));
  ASSERT_EQ(page.links.size(), 2U);
  EXPECT_EQ(page.links[0].line, 2U);
  EXPECT_EQ(target_of("pages/use/x.md", page.links[0].target), "pages/use/b.md");
  EXPECT_EQ(target_of("pages/use/x.md", page.links[1].target), "pages/use/x.md");
}

}  // namespace
}  // namespace tessera::test
