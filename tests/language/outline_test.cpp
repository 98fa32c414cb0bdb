// The outline of a right text is the tree of the parser; every other text has one too.
#include "../environment.hpp"
#include "examples.hpp"
#include "spec/document/document.hpp"

namespace tessera::language {
namespace {

Extent bytes_of(const Lines& lines, const diagnostics::Span& span) {
  const std::size_t begin = lines.start_of(span.line - 1) + span.column - 1;
  return {begin, begin + span.length};
}

/// "" if both trees are the same.
std::string difference(const Node& mine, const spec::Node& parsed, const Lines& lines,
                       const std::string& path) {
  if (static_cast<int>(mine.kind) != static_cast<int>(parsed.kind) &&
      !(parsed.is_null() && mine.text == "null"))
    return path + ": another kind";
  if (mine.is_scalar() && parsed.verbatim) {
    if (mine.text != parsed.text) return path + ": '" + mine.text + "' for '" + parsed.text + "'";
    if (mine.extent != bytes_of(lines, parsed.span)) return path + ": another place";
  }
  if (mine.entries.size() != parsed.entries.size()) return path + ": another number of keys";
  if (mine.items.size() != parsed.items.size()) return path + ": another number of items";
  for (std::size_t at = 0; at < mine.entries.size(); ++at) {
    const Entry& one = mine.entries[at];
    if (one.key != parsed.entries[at].key)
      return path + ": key " + one.key + " for " + parsed.entries[at].key;
    if (one.extent != bytes_of(lines, parsed.entries[at].span))
      return path + "." + one.key + ": another place";
    if (std::string found = difference(*one.value, *parsed.entries[at].value, lines, path + "." + one.key);
        !found.empty())
      return found;
  }
  for (std::size_t at = 0; at < mine.items.size(); ++at)
    if (std::string found = difference(*mine.items[at].value, *parsed.items[at], lines, path + "[]");
        !found.empty())
      return found;
  return {};
}

std::vector<std::filesystem::path> right_texts() {
  std::vector<std::filesystem::path> all;
  for (const auto& folder : examples()) all.push_back(folder / "spec.yaml");
  for (const auto& file : std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/tests/golden/spec/valid"))
    if (file.path().extension() == ".yaml") all.push_back(file.path());
  return all;
}

TEST(Outline, OfARightTextIsTheTreeOfTheParser) {
  std::size_t compared = 0;
  for (const auto& file : right_texts()) {
    const std::string text = read_text(file);
    diagnostics::Diagnostics out("spec.yaml", text);
    const auto parsed = spec::read_document(out);
    if (!parsed || out.has_errors()) continue;
    const Outline outline(text);
    EXPECT_EQ(difference(outline.root(), parsed->root(), Lines(text), ""), "") << file;
    ++compared;
  }
  EXPECT_GT(compared, 20U);
}

TEST(Outline, OpenBracketsEndWhereTheIndentationDoes) {
  const std::string text = "a:\n  b: { c: 1, d: [x, y\n  e: 2\nf: { g: \"h\ni: 3\n";
  const Outline outline(text);
  EXPECT_EQ(outline.root()["a"]["b"]["d"].items.size(), 2U);
  EXPECT_EQ(outline.root()["a"]["e"].text, "2");
  EXPECT_EQ(outline.root()["f"]["g"].text, "h");
  EXPECT_EQ(outline.root()["i"].text, "3");
}

TEST(Outline, AKeyWithoutAColonIsAnIncompleteEntry) {
  const std::string text = "agents:\n  robot:\n    contr\n  other: {}\n";
  const Outline outline(text);
  const Node& robot = outline.root()["agents"]["robot"];
  EXPECT_EQ(robot.text, "contr");
  EXPECT_NE(outline.root()["agents"].find("other"), nullptr);
}

TEST(Lines, ColumnsCountUtf16) {
  const std::string text = "ä𝄞b\r\nc";
  const Lines lines(text);
  EXPECT_EQ(lines.position(2), (Position{0, 1}));
  EXPECT_EQ(lines.position(6), (Position{0, 3}));
  EXPECT_EQ(lines.offset({0, 3}), 6U);
  EXPECT_EQ(lines.offset({0, 99}), 7U);
  EXPECT_EQ(lines.offset({1, 0}), 9U);
  EXPECT_EQ(lines.offset({7, 0}), text.size());
}

/// Asks everything at the end of a text.
void ask_everything(const std::string& text) {
  const Document document(text, grammar());
  const Position end = document.lines().position(text.size());
  (void)complete(document, end);
  (void)explain(document, end);
  (void)definition(document, end, {});
  (void)references(document, nullptr, end, {}, true);
  (void)renameable(document, nullptr, end);
  (void)fixes(document, {end, end}, {});
  (void)headings(document);
}

TEST(Language, AnswersAtTheEndOfEveryPrefix) {
  for (const auto& folder : examples()) {
    const std::string text = read_text(folder / "spec.yaml");
    // All prefixes of the first example; of the others one in 41, so that all columns are met.
    const std::size_t step = (folder.filename() == "01_line_follower" ? 1U : 41U) * (sanitized ? 11U : 1U);
    for (std::size_t size = 0; size <= text.size(); size += step) ask_everything(text.substr(0, size));
  }
}

TEST(Language, AnswersAboutAnyBytes) {
  std::string text = read_text(example("05_depot") / "spec.yaml");
  std::uint32_t state = 1;
  const std::string signs = "{}[]:,-\"'&*|>#\n \t\\\xff\xc3\r!?.";
  for (int round = 0; round < 300; ++round) {
    state = state * 1664525U + 1013904223U;
    text[state % text.size()] = signs[(state >> 8U) % signs.size()];
    ask_everything(text);
  }
}

}  // namespace
}  // namespace tessera::language
