#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

/// Comments begin their sentences with the subject (CONTRIBUTING.md). The test finds the part of this rule that needs no
/// understanding: a sentence that begins with a bare "Of", "What" or the like and is no question.
namespace tessera::test {
namespace {

namespace fs = std::filesystem;

enum class Style : std::uint8_t { slashes, hash };

/// A run of comment lines, or one comment behind code.
struct Comment {
  std::size_t line = 0;  ///< from 1
  std::string text;
};

/// The text of a comment that begins with `mark`, without the mark and a "<" behind it.
std::string_view without_mark(std::string_view comment, std::string_view mark) {
  comment.remove_prefix(std::min(comment.find_first_not_of(mark), comment.size()));
  if (comment.starts_with('<')) comment.remove_prefix(1);
  return comment;
}

/// The text of a line that is only a comment; nullopt: there is code, or nothing.
std::optional<std::string_view> comment_line(std::string_view line, Style style) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t{"), line.size()));
  if (style == Style::hash)
    return line.starts_with('#') ? std::optional(without_mark(line, "#")) : std::nullopt;
  if (line.starts_with("//")) return without_mark(line, "/");
  if (line.starts_with("/*") || line.starts_with("* ")) return without_mark(line, "/*");
  return std::nullopt;
}

/// The text of a comment behind code; a mark inside a string is none.
std::optional<std::string_view> comment_behind_code(std::string_view line, Style style) {
  const std::string_view mark = style == Style::hash ? " # " : " //";
  const std::size_t at = line.find(mark);
  if (at == std::string_view::npos || std::ranges::count(line.substr(0, at), '"') % 2 != 0)
    return std::nullopt;
  return without_mark(line.substr(at + 1), style == Style::hash ? "#" : "/");
}

std::vector<Comment> comments_of(const std::string& source, Style style) {
  std::vector<Comment> comments;
  bool continues = false;
  std::istringstream lines(source);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::optional<std::string_view> whole = comment_line(line, style);
    const bool is_text = whole && whole->find_first_not_of(" \t*/}") != std::string_view::npos;
    if (is_text && continues) comments.back().text.append(*whole);
    if (is_text && !continues) comments.push_back({number, std::string(*whole)});
    continues = is_text;
    if (whole) continue;
    if (const auto behind = comment_behind_code(line, style))
      comments.push_back({number, std::string(*behind)});
  }
  return comments;
}

/// The first sentence with a bare beginning; empty: there is none.
std::string bare_sentence(std::string_view text) {
  static constexpr std::array<std::string_view, 6> bare{"Of ", "Who ", "What ", "Where ", "Whom ", "Whose "};
  while (!text.empty()) {
    text.remove_prefix(std::min(text.find_first_not_of(" *("), text.size()));
    std::size_t end = 0;
    while (end < text.size() && !(std::string_view(".?!").find(text[end]) != std::string_view::npos &&
                                  (end + 1 == text.size() || text[end + 1] == ' ')))
      ++end;
    const bool is_question = end < text.size() && text[end] == '?';
    if (!is_question &&
        std::ranges::any_of(bare, [&](std::string_view one) { return text.starts_with(one); }))
      return std::string(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return "";
}

std::optional<Style> style_of(const fs::path& file) {
  static constexpr std::array<std::string_view, 9> slashes{".cpp", ".hpp", ".idl", ".ts", ".tsx",
                                                           ".mjs", ".js",  ".cjs", ".css"};
  const std::string ending = file.extension().string();
  if (std::ranges::find(slashes, ending) != slashes.end()) return Style::slashes;
  const bool is_script = ending.empty() && file.parent_path().filename() == "scripts";
  const bool has_hashes = ending == ".cmake" || ending == ".in" || ending == ".yaml" || ending == ".sh";
  if (has_hashes || is_script || file.filename() == "CMakeLists.txt") return Style::hash;
  return std::nullopt;
}

/// Not sources: what was built or fetched, and files that programs have written.
bool is_left_out(const fs::path& folder) {
  static constexpr std::array<std::string_view, 5> names{"node_modules", "dist", "golden", "build",
                                                         ".tessera"};
  return std::ranges::find(names, folder.filename().string()) != names.end();
}

TEST(Comments, BeginTheirSentencesWithTheSubject) {
  std::size_t comments = 0;
  for (const char* folder :
       {"benchmarks", "cli", "cmake", "editors", "examples", "executor", "network", "recording", "ros2",
        "runtime", "scripts", "sim", "src", "studio", "tests", "vocabulary"}) {
    const fs::path root = fs::path(TESSERA_SOURCE_DIR) / folder;
    for (auto at = fs::recursive_directory_iterator(root); at != fs::recursive_directory_iterator(); ++at) {
      if (at->is_directory() && is_left_out(at->path())) at.disable_recursion_pending();
      const std::optional<Style> style = style_of(at->path());
      if (!style || !at->is_regular_file()) continue;
      std::ifstream stream(at->path(), std::ios::binary);
      const std::string source{std::istreambuf_iterator<char>(stream), {}};
      for (const Comment& comment : comments_of(source, *style)) {
        ++comments;
        EXPECT_EQ(bare_sentence(comment.text), "") << at->path().string() << ':' << comment.line;
      }
    }
  }
  EXPECT_GT(comments, 5000U);
}

TEST(Comments, OfASourceAreFoundWithTheirSentences) {
  const auto first = [](const std::string& source, Style style = Style::slashes) {
    for (const Comment& comment : comments_of(source, style))
      if (const std::string found = bare_sentence(comment.text); !found.empty())
        return std::to_string(comment.line) + ": " + found;
    return std::string();
  };
  EXPECT_EQ(first("int a;\n/// Of this process.\nint b;"), "2: Of this process");
  EXPECT_EQ(first("int a = 0;  ///< What it is; 0: none"), "1: What it is; 0: none");
  EXPECT_EQ(first("/// Keeps a value. Where there is\n/// none, waits. Never fails."),
            "1: Where there is none, waits");
  EXPECT_EQ(first("/** Who waits. */"), "1: Who waits");
  EXPECT_EQ(first("/**\n * A value.\n *\n * What is left. */"), "4: What is left");
  EXPECT_EQ(first("a: 1  # Of the net", Style::hash), "1: Of the net");
  EXPECT_EQ(first("# Whose turn it is", Style::hash), "1: Whose turn it is");
  EXPECT_EQ(first("/// What comes next? The subject.\n// of a sentence (of course). An Offer. Whatever."),
            "");
  EXPECT_EQ(first("const char* text = \"a // What\";\nf(\"What\");"), "");
}

}  // namespace
}  // namespace tessera::test
