// Random texts in all styles of YAML. The parser of the specification judges what an edit has made of them.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "examples.hpp"
#include "language/edits/edits.hpp"
#include "language/edits/text_editor.hpp"
#include "spec/document/document.hpp"

namespace tessera::language {
namespace {

using Json = nlohmann::ordered_json;

class RandomText {
 public:
  explicit RandomText(std::uint32_t seed) : random_(seed) {}

  std::size_t below(std::size_t limit) { return random_() % limit; }

  /// The lines of a map; the first begins where the text before ends.
  std::string map(int depth, std::size_t indent) {
    const std::string start = "\n" + std::string(indent, ' ');
    std::string all = entry(depth, indent);
    for (std::size_t more = below(3); more > 0; --more) {
      const std::size_t between = below(5);
      all += (between == 3   ? start + "# of the next"
              : between == 4 ? "\n"
                             : "") +
             start + entry(depth, indent);
    }
    return all;
  }

 private:
  std::string name() { return "k" + std::to_string(++names_); }
  std::string entry(int depth, std::size_t indent) { return name() + ":" + after(depth, indent); }

  std::string scalar() {
    constexpr const char* all[] = {"5",       "word", "two words", "\"quoted: # text\"",
                                   "'it''s'", "",     "true",      "1.5 m/s"};
    return all[below(8)];
  }

  std::string flow(int depth) {
    const std::string gap(below(3), ' ');
    if (depth == 0 || below(3) == 0) {
      constexpr const char* all[] = {"5", "word", "\"a, b\"", "'}'"};
      return all[below(4)];
    }
    const bool list = below(2) == 0;
    std::string inside;
    for (std::size_t more = below(4); more > 0; --more)
      inside += (inside.empty() ? ""
                 : list         ? "," + gap
                                : ", ") +
                (list ? "" : name() + ": ") + flow(depth - 1);
    return list ? "[" + gap + inside + gap + "]" : "{" + gap + inside + gap + "}";
  }

  /// The text after a colon or a dash, without the end of its last line.
  std::string after(int depth, std::size_t indent) {
    const std::string start = "\n" + std::string(indent + 2, ' ');
    const std::size_t style = below(depth == 0 ? 4 : 8);
    if (style < 2) {
      const std::string text = scalar();
      return text.empty() ? "" : " " + text;
    }
    if (style == 2) {
      constexpr const char* all[] = {"|", ">", "|-"};
      return std::string(" ") + all[below(3)] + start + "first line" + start + "  second line";
    }
    if (style == 3) return " " + flow(2) + (below(2) == 0 ? "  # flow" : "");
    if (style == 4) {
      std::string items;
      for (std::size_t more = 1 + below(3); more > 0; --more)
        items += start + "-" + item(depth - 1, indent + 2);
      return items;
    }
    return (below(3) == 0 ? "  # below" : "") + start + map(depth - 1, indent + 2);
  }

  std::string item(int depth, std::size_t indent) {
    return depth > 0 && below(2) == 0 ? " " + map(depth - 1, indent + 2) : after(depth, indent);
  }

  std::mt19937 random_;
  int names_ = 0;
};

Json data_of(const spec::Node& node) {
  if (node.is_null()) return nullptr;
  if (node.is_scalar()) return node.text;
  Json all = node.is_map() ? Json::object() : Json::array();
  for (const spec::Entry& entry : node.entries) all[entry.key] = data_of(*entry.value);
  for (const spec::Node* item : node.items) all.push_back(data_of(*item));
  return all;
}
Json read(const std::string& text) {
  diagnostics::Diagnostics out("", text);
  const std::optional<spec::Document> document = spec::read_document(out);
  EXPECT_TRUE(document && !out.has_errors()) << text;
  return document ? data_of(document->root()) : Json();
}

Json& inside(Json& data, const Path& path) {
  Json* now = &data;
  for (const Step& step : path)
    now = key_of(step) != nullptr ? &(*now)[*key_of(step)] : &(*now)[std::get<std::size_t>(step)];
  return *now;
}

/// Each path of a document.
void visit(const Json& data, const Path& at, const std::function<void(const Path&)>& each) {
  if (!at.empty()) each(at);
  if (data.is_array())
    for (std::size_t item = 0; item < data.size(); ++item) visit(data[item], at / item, each);
  if (data.is_object())
    for (const auto& [key, value] : data.items()) visit(value, at / key, each);
}

/// A map or list in lines of its own goes with its last entry.
void remove_from(Json& data, const Path& path, const TextEditor& editor) {
  const Path above = without_last(path);
  Json& parent = inside(data, above);
  if (const Node* node = editor.node(above); parent.size() == 1 && !node->flow) {
    if (path.size() > 1) remove_from(data, above, editor);
  } else if (key_of(path.back()) != nullptr) {
    parent.erase(*key_of(path.back()));
  } else {
    parent.erase(std::get<std::size_t>(path.back()));
  }
}

std::size_t comments(const std::string& text) {
  std::size_t count = 0;
  for (const char* comment : {"# of the next", "# flow", "# below"})
    for (std::size_t at = text.find(comment); at != std::string::npos; at = text.find(comment, at + 1))
      ++count;
  return count;
}

TEST(Edits, ChangeWhatTheyNameAndNothingElseInEveryStyle) {
  std::map<std::string, int> tried;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    const std::string text = RandomText(seed).map(3, 0) + "\n";
    const TextEditor editor(text);
    const Json data = read(text);
    const auto check = [&](const char* name, const Path& path, auto do_edit, auto change) {
      Json expected = data;
      change(expected);
      const std::string after = do_edit();
      SCOPED_TRACE(std::string(name) + " of seed " + std::to_string(seed) + ":\n" + text + "--- is now:\n" +
                   after);
      EXPECT_TRUE(read(after) == expected || (expected.empty() && after == text)) << path.size();
      if (std::string(name) != "remove") EXPECT_EQ(comments(after), comments(text));
      ++tried[name];
    };
    visit(data, {}, [&](const Path& path) {
      if (testing::Test::HasFailure()) return;
      Json copy = data;
      const Json value = inside(copy, path);
      const Path above = without_last(path);
      const auto edited_by = [&](auto change) {
        return [&text, change] {
          TextEditor now(text);
          change(now);
          return now.text();
        };
      };
      check("remove", path, edited_by([&](TextEditor& now) { now.remove(path); }),
            [&](Json& all) { remove_from(all, path, editor); });
      if (const std::string* key = key_of(path.back())) {
        const auto renamed = [&] {
          const Document document(text, grammar());
          Edit rename;
          rename.kind = Edit::Kind::rename;
          rename.at = path;
          rename.text = "renamed";
          return edited(document, edit(document, {{rename}}, {}).edits);
        };
        check("rename", path, renamed, [&](Json& all) {
          Json& parent = inside(all, above);
          Json fresh = Json::object();
          for (const auto& [name, one] : parent.items()) fresh[name == *key ? "renamed" : name] = one;
          parent = fresh;
        });
        if (!value.is_structured())
          check("set", path, edited_by([&](TextEditor& now) { now.set(above, *key, "7", Writing::scalar); }),
                [&](Json& all) { inside(all, path) = "7"; });
      }
      if (value.is_object() || value.is_null())
        check("insert", path, edited_by([&](TextEditor& now) {
                now.insert(path, "fresh", Value::map("a", Value::scalar("1")));
              }),
              [&](Json& all) {
                Json& into = inside(all, path);
                if (into.is_null()) into = Json::object();
                into["fresh"]["a"] = "1";
              });
      if (value.is_array())
        check("append", path, edited_by([&](TextEditor& now) { now.append(path, "more"); }),
              [&](Json& all) { inside(all, path).push_back("more"); });
    });
  }
  for (const char* name : {"remove", "rename", "set", "insert", "append"}) EXPECT_GT(tried[name], 40) << name;
}

}  // namespace
}  // namespace tessera::language
