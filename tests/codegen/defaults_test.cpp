#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "generated.hpp"
#include "language/language.hpp"

/// Defaults of the specification are defaults of its reading alone: net and controller are those of the same
/// specification with everything written out. The writer below draws specifications, and writes each in both ways.
namespace tessera::test {
namespace {

using Names = std::vector<std::string>;

std::string list_text(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return "[" + text + "]";
}

struct Pair {
  std::string shorter, longer;
};

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  Pair write() {
    count_ = 2 + draw(4);
    failures_ = draw(4) == 0 ? "" : behaviour(draw(count_));
    level_ = draw(3);
    has_send_ = draw(3) != 0;
    has_receive_ = draw(3) != 0;
    if (has_send_) send_ = some({"x", "y", "z"});
    if (has_receive_) receive_ = some({"i", "j"});
    first_ = draw(2) == 0;
    for (std::size_t at = 0; at < count_; ++at) add(at);
    return {whole(true), whole(false)};
  }

 private:
  std::size_t draw(std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random_);
  }
  static std::string behaviour(std::size_t at) { return "b" + std::to_string(at); }

  Names some(Names names) {
    std::shuffle(names.begin(), names.end(), random_);
    names.resize(draw(names.size() + 1));
    return names;
  }

  /// A list of a behaviour in both ways.
  Pair list(const char* key, bool has_around, const Names& around, const Names& all) {
    const std::string begin = std::string(key) + ": ";
    const std::size_t kind = draw(3);
    if (kind == 0) return {"", has_around ? begin + list_text(around) + ", " : ""};
    if (kind == 1) {
      const std::string text = begin + list_text(some(all)) + ", ";
      return {text, text};
    }
    Names now = has_around ? around : all, changes;
    for (const std::string& name : some(all)) {
      const auto found = std::find(now.begin(), now.end(), name);
      changes.push_back((found == now.end() ? "+" : "-") + name);
      if (found == now.end())
        now.push_back(name);
      else
        now.erase(found);
    }
    if (changes.empty()) return {"", has_around ? begin + list_text(around) + ", " : ""};
    return {begin + list_text(changes) + ", ", begin + list_text(now) + ", "};
  }

  /// A condition of shared and own expressions in both ways; its names.
  Pair condition(const char* key, const Names& shared, const Names& own, Names& names) {
    if (shared.empty() && own.empty()) return {};
    Pair text;
    for (const std::string& name : shared) {
      text.shorter += (text.shorter.empty() ? "" : ", ") + name;
      text.longer += (text.longer.empty() ? "" : ", ") + name + ": " + expression(name);
      names.push_back(name);
    }
    for (const std::string& name : own) {
      const std::string one = name + ": in.j";
      text.shorter += (text.shorter.empty() ? "" : ", ") + one;
      text.longer += (text.longer.empty() ? "" : ", ") + one;
      names.push_back(name);
    }
    const bool alone = shared.size() == 1 && own.empty() && draw(2) == 0;
    const std::string begin = std::string(key) + ": ";
    return {begin + (alone ? shared.front() : "{ " + text.shorter + " }") + ", ",
            begin + "{ " + text.longer + " }, "};
  }

  static std::string expression(const std::string& name) {
    static const std::map<std::string, std::string> all{
        {"c0", "in.i"}, {"c1", "elapsed > 2 s"}, {"c2", "\"!in.j\""}};
    return all.at(name);
  }

  struct Entry {
    std::string text;
    bool names_error = false;
  };

  /// `next` in both ways. The rule of `on_error` stands here a second time, in the words of the reference.
  Pair next(std::size_t own, const Names& terminal, const Names& error) {
    std::vector<Entry> entries;
    bool takes_failures = false;
    const std::size_t size = draw(4);
    for (std::size_t at = 0; at < size; ++at) {
      const std::string to = draw(5) == 0 ? "end" : behaviour(draw(count_));
      const auto when = [&](const std::string& what) { return "{ to: " + to + ", when: " + what + " }"; };
      const std::size_t kind = draw(6);
      if (kind == 0) {
        entries.push_back({when("error"), true});
        takes_failures = true;
      } else if (kind == 1 && !error.empty()) {
        entries.push_back({when(error[draw(error.size())]), true});
      } else if (kind == 2 && !terminal.empty()) {
        entries.push_back({when(terminal[draw(terminal.size())]), false});
      } else if (kind == 3) {
        entries.push_back({when("in.i"), false});
      } else {
        entries.push_back({to, false});
      }
    }
    const auto text = [](const std::vector<Entry>& all) {
      Names names;
      for (const Entry& one : all) names.push_back(one.text);
      return names.empty() ? "" : "next: " + list_text(names) + ", ";
    };
    Pair both{text(entries), text(entries)};
    if (failures_.empty() || failures_ == behaviour(own) || takes_failures) return both;
    const auto last =
        std::find_if(entries.rbegin(), entries.rend(), [](const Entry& one) { return one.names_error; });
    const std::ptrdiff_t at = last == entries.rend() ? 0 : entries.rend() - last;
    if (entries.empty() && !terminal.empty()) entries.push_back({"end", false});
    entries.insert(entries.begin() + at, {"{ to: " + failures_ + ", when: error }", true});
    both.longer = text(entries);
    return both;
  }

  void add(std::size_t at) {
    Names shared = some({"c0", "c1", "c2"});
    const std::size_t split = draw(shared.size() + 1);
    const Names for_error(shared.begin() + static_cast<std::ptrdiff_t>(split), shared.end());
    shared.resize(split);
    Names terminal_names, error_names;
    const Pair terminal =
        condition("terminal", shared, draw(3) == 0 ? Names{"own"} : Names{}, terminal_names);
    const Pair error = condition("error", for_error, draw(3) == 0 ? Names{"jam"} : Names{}, error_names);
    const Pair follows = next(at, terminal_names, error_names);
    const Pair sends = list("send", has_send_, send_, {"x", "y", "z"});
    const Pair receives = list("receive", has_receive_, receive_, {"i", "j"});
    const std::string begin = "        " + behaviour(at) + ": { ";
    shorter_ +=
        begin + terminal.shorter + error.shorter + follows.shorter + sends.shorter + receives.shorter + "}\n";
    longer_ +=
        begin + terminal.longer + error.longer + follows.longer + sends.longer + receives.longer + "}\n";
  }

  [[nodiscard]] std::string on_error(std::size_t level, bool shorter) const {
    if (!shorter) return "";
    std::string text(level * 2 + (level == 2 ? 2 : level == 1 ? 2 : 0), ' ');
    if (level == level_ && !failures_.empty()) return text + "on_error: " + failures_ + "\n";
    return level < level_ && level % 2 == 0 ? text + "on_error: stop\n" : "";
  }

  [[nodiscard]] std::string whole(bool shorter) const {
    std::string control =
        "    control:\n      rate: 10 Hz\n      inputs: { i: bool, j: bool }\n"
        "      outputs: { x: bool, y: bool, z: bool }\n" +
        on_error(2, shorter);
    if (!shorter) {
      control += first_ ? "      receive: first\n" : "";
    } else {
      if (has_send_) control += "      send: " + list_text(send_) + "\n";
      if (has_receive_)
        control +=
            "      receive: " + (first_ ? "{ first: " + list_text(receive_) + " }" : list_text(receive_)) +
            "\n";
      else if (first_)
        control += "      receive: first\n";
      control += "      conditions: { c0: in.i, c1: elapsed > 2 s, c2: \"!in.j\" }\n";
    }
    control += "      behaviours:\n" + (shorter ? shorter_ : longer_);
    const std::string desk =
        "  desk:\n    control: { " +
        std::string(shorter && !failures_.empty() && level_ == 0 ? "on_error: stop, " : "") +
        "rate: 5 Hz, inputs: { x: bool, y: bool }, outputs: { i: bool, j: bool }, behaviours: { run: {} } "
        "}\n";
    const bool fleet = count_ % 2 == 1;
    const std::string head = "tessera: 1\nsystem: s\n" + on_error(0, shorter);
    const std::string body = "  robot:\n" + on_error(1, shorter) + control;
    const std::string index = fleet ? "[0]" : "";
    const std::string channels = "channels:\n  - { from: \"robot" + index +
                                 ".control.x\", to: desk.control.x, receive: blocking, timeout: 1 s }\n"
                                 "  - robot" +
                                 index +
                                 ".control.y -> desk.control.y\n"
                                 "  - { from: desk.control.i, to: \"robot" +
                                 (fleet ? "[*]" : "") +
                                 ".control.i\", receive: blocking, timeout: 1 s }\n"
                                 "  - \"desk.control.j -> robot" +
                                 (fleet ? "[*]" : "") + ".control.j\"\n";
    const std::string deploy = count_ == 4 ? "deploy: { processes: { p: [robot], q: [desk] } }\n" : "";
    if (!fleet) return head + "agents:\n" + body + desk + channels + deploy;
    std::string tail = body;
    tail.replace(0, std::string("  robot:").size(), "  kind:");
    return head + "templates:\n" + tail + "agents:\n  robot: { use: kind, count: 2 }\n" + desk + channels;
  }

  std::mt19937_64 random_;
  std::size_t count_ = 0, level_ = 0;
  std::string failures_;
  bool has_send_ = false, has_receive_ = false, first_ = false;
  Names send_, receive_;
  std::string shorter_, longer_;
};

void expect_same(const std::string& first, const std::string& second) {
  const Generated one = generate(first, "spec.yaml", codegen::Lines::listed);
  const Generated other = generate(second, "spec.yaml", codegen::Lines::listed);
  ASSERT_EQ(one.net_hash, other.net_hash);
  ASSERT_EQ(one.files.size(), other.files.size());
  for (std::size_t at = 0; at < one.files.size(); ++at) {
    ASSERT_EQ(one.files[at].path, other.files[at].path);
    if (one.files[at].path != "system.lines.cpp") {
      ASSERT_EQ(one.files[at].text, other.files[at].text) << one.files[at].path;
    }
  }
}

TEST(Defaults, GiveTheNetAndTheControllerOfWhatIsWrittenOut) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const Pair pair = Writer(seed).write();
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + pair.shorter + "\n" + pair.longer);
    ASSERT_NO_FATAL_FAILURE(expect_same(pair.shorter, pair.longer));
  }
}

TEST(Defaults, ThatAreWrittenForWhatIsRepeatedKeepNetAndController) {
  std::size_t shorter = 0;
  for (std::uint64_t seed = 1000; seed < 1150; ++seed) {
    const std::string longer = Writer(seed).write().longer;
    const std::optional<language::Shortened> found = language::shortened(longer);
    ASSERT_TRUE(found);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + longer + "\n" + found->text);
    ASSERT_EQ(found->text == longer, found->done.empty());
    if (found->done.empty()) continue;
    ++shorter;
    ASSERT_LT(found->text.size(), longer.size());
    ASSERT_NO_FATAL_FAILURE(expect_same(longer, found->text));
    ASSERT_TRUE(language::shortened(found->text)->done.empty()) << "once is enough";
  }
  EXPECT_GT(shorter, 30U);
}

/// Behaviours in a group have lists and failures of their own; a group among the behaviours is one of them.
TEST(Defaults, OfASubsystemWithGroupsKeepTheGroups) {
  const std::string longer = R"(tessera: 1
system: s
agents:
  robot:
    control:
      rate: 10 Hz
      memory: { low: bool }
      behaviours:
        work: { terminal: { low: memory.low }, next: [{ to: safe, when: error }, charge] }
        charge:
          until: memory.low
          start: dock
          next: [{ to: safe, when: error }, { to: rest, when: until }, work]
          behaviours:
            ask: { terminal: { low: memory.low }, next: [{ to: dock, when: error }, dock] }
            dock: { terminal: { low: memory.low }, next: end }
        rest: { terminal: { low: memory.low }, next: [{ to: safe, when: error }, work] }
        safe: { terminal: true, next: work }
)";
  const std::optional<language::Shortened> found = language::shortened(longer);
  ASSERT_TRUE(found);
  EXPECT_NE(found->text.find("on_error: safe\n"), std::string::npos) << found->text;
  EXPECT_NE(found->text.find("next: [{ to: rest, when: until }, work]"), std::string::npos) << found->text;
  ASSERT_NO_FATAL_FAILURE(expect_same(longer, found->text));
}

TEST(Defaults, OfEveryExampleKeepItsNetAndController) {
  for (const auto& folder : std::filesystem::directory_iterator(source_folder / "examples")) {
    if (!std::filesystem::exists(folder.path() / "spec.yaml")) continue;
    const std::string text = read_file(folder.path() / "spec.yaml");
    const std::optional<language::Shortened> found = language::shortened(text);
    SCOPED_TRACE(folder.path().string() + "\n" + (found ? found->text : ""));
    ASSERT_TRUE(found);
    if (!found->done.empty()) {
      ASSERT_NO_FATAL_FAILURE(expect_same(text, found->text));
    }
  }
}

}  // namespace
}  // namespace tessera::test
