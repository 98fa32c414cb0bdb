#include "ros2/arguments/yaml.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tessera::ros2 {
namespace {

constexpr std::size_t deepest = 32;

[[noreturn]] void refuse(std::size_t line, const std::string& why) {
  throw std::runtime_error(std::to_string(line) + ": " + why);
}

YamlNode empty_node(YamlNode::Kind kind, std::size_t line) {
  YamlNode node;
  node.kind = kind;
  node.line = line;
  return node;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

class YamlReader {
 public:
  explicit YamlReader(std::string_view text) : text_(text) {}

  YamlNode read() {
    skip();
    if (rest().starts_with("---") && (at_ + 3 == text_.size() || is_blank(text_[at_ + 3]))) {
      at_ += 3;
      skip();
    }
    YamlNode node = empty_node(YamlNode::Kind::map, 1);
    if (!ended()) node = value(0, 0);
    skip();
    if (!ended()) refuse_rest();
    return node;
  }

 private:
  [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }
  [[nodiscard]] bool ended() const { return at_ == text_.size(); }
  [[nodiscard]] char here() const { return ended() ? '\0' : text_[at_]; }
  [[nodiscard]] char next() const { return at_ + 1 < text_.size() ? text_[at_ + 1] : '\0'; }
  [[nodiscard]] std::size_t column() const {
    const std::size_t begin = at_ == 0 ? std::string_view::npos : text_.rfind('\n', at_ - 1);
    return begin == std::string_view::npos ? at_ : at_ - begin - 1;
  }

  void step() {
    if (here() == '\n') ++line_;
    ++at_;
  }

  [[noreturn]] void refuse_rest() const {
    if (rest().starts_with("---")) refuse(line_, "a second document is not read");
    refuse(line_, "this is indented otherwise than the lines before, or belongs to no value");
  }

  /// Moves over blanks, ends of lines and comments.
  void skip() {
    bool begins_line = column() == 0;
    while (!ended()) {
      if (here() == '#' && (at_ == 0 || is_blank(text_[at_ - 1]))) {
        while (!ended() && here() != '\n') ++at_;
        continue;
      }
      if (!is_blank(here())) return;
      if (here() == '\t' && begins_line) refuse(line_, "a line is indented by a tab; use spaces");
      begins_line = here() == '\n' || (begins_line && here() == ' ');
      step();
    }
  }

  /// A value that begins here, at a column of at least `least`.
  YamlNode value(std::size_t least, std::size_t depth) {
    if (depth > deepest) refuse(line_, "values are nested more than " + std::to_string(deepest) + " deep");
    const std::size_t line = line_;
    YamlNode node;
    if (here() == '[' || here() == '{') {
      node = bracket(depth);
    } else if (here() == '-' && (is_blank(next()) || at_ + 1 == text_.size())) {
      node = block_list(column(), depth);
    } else if (is_key()) {
      node = block_map(column(), depth);
    } else {
      node = scalar(/*in_bracket=*/false);
      refuse_second_line(least);
    }
    node.line = line;
    return node;
  }

  /// A text in YAML may go on in the next line. Whoever writes that in parameters has forgotten something.
  void refuse_second_line(std::size_t least) {
    const std::size_t line = line_;
    skip();
    if (!ended() && line_ > line && column() > least && !is_key() && here() != '-')
      refuse(line_, "a value of several lines is not read");
    if (!ended() && line_ == line) refuse(line_, "something follows a value");
  }

  /// Whether the line has a key here.
  bool is_key() {
    const std::size_t at = at_, line = line_;
    bool found = false;
    if (here() == '"' || here() == '\'') {
      static_cast<void>(quoted());
      while (here() == ' ') ++at_;
      found = here() == ':';
    } else {
      for (std::size_t to = at_; to < text_.size() && text_[to] != '\n' && !found; ++to) {
        if (text_[to] == '#' && to > at_ && is_blank(text_[to - 1])) break;
        found = text_[to] == ':' && (to + 1 == text_.size() || is_blank(text_[to + 1]));
      }
    }
    at_ = at;
    line_ = line;
    return found;
  }

  std::string key(bool in_bracket) {
    if (here() == '?') refuse(line_, "keys with '?' are not read");
    if (here() == '"' || here() == '\'') {
      std::string text = quoted();
      while (here() == ' ') ++at_;
      if (here() != ':') refuse(line_, "a ':' is missing behind the key");
      ++at_;
      return text;
    }
    refuse_special();
    const std::size_t begin = at_;
    const auto ends = [&] {
      if (here() == ':') return next() == '\0' || is_blank(next()) || in_bracket;
      return ended() || here() == '\n' || (in_bracket && (here() == ',' || here() == '}'));
    };
    while (!ends()) ++at_;
    if (here() != ':') refuse(line_, "a ':' is missing behind the key");
    std::string text(text_.substr(begin, at_ - begin));
    while (text.ends_with(' ')) text.pop_back();
    ++at_;
    if (text.empty()) refuse(line_, "a key is missing");
    return text;
  }

  void add(YamlNode& map, std::string name, YamlNode node, std::size_t line) {
    if (std::ranges::find(map.entries, name, &YamlEntry::key) != map.entries.end())
      refuse(line, "'" + name + "' comes twice");
    map.entries.push_back({std::move(name), std::move(node)});
  }

  YamlNode block_map(std::size_t own, std::size_t depth) {
    YamlNode map = empty_node(YamlNode::Kind::map, line_);
    while (!ended() && column() == own && is_key()) {
      const std::size_t line = line_;
      std::string name = key(/*in_bracket=*/false);
      skip();
      const bool is_list = here() == '-' && is_blank(next());
      const bool has_value = !ended() && (line_ == line || column() > own || (is_list && column() == own));
      if (!has_value) refuse(line, "'" + name + "' has no value");
      if (line_ == line && here() != '[' && here() != '{' && is_key())
        refuse(line, "a second ':' in one line");
      add(map, std::move(name), value(own, depth + 1), line);
      skip();
    }
    if (!ended() && column() > own) refuse_rest();
    return map;
  }

  YamlNode block_list(std::size_t own, std::size_t depth) {
    YamlNode list = empty_node(YamlNode::Kind::list, line_);
    while (!ended() && column() == own && here() == '-' && is_blank(next())) {
      const std::size_t line = line_;
      ++at_;
      skip();
      if (ended() || (line_ != line && column() <= own)) refuse(line, "an element of the list is missing");
      list.items.push_back(value(own, depth + 1));
      skip();
    }
    if (!ended() && column() > own) refuse_rest();
    return list;
  }

  YamlNode bracket(std::size_t depth) {
    if (depth > deepest) refuse(line_, "values are nested more than " + std::to_string(deepest) + " deep");
    const bool is_map = here() == '{';
    const char end = is_map ? '}' : ']';
    const std::size_t begin = line_;
    YamlNode node = empty_node(is_map ? YamlNode::Kind::map : YamlNode::Kind::list, begin);
    ++at_;
    for (skip(); here() != end; skip()) {
      if (ended()) refuse(begin, std::string("a '") + end + "' is missing");
      if (is_map) {
        const std::size_t line = line_;
        std::string name = key(/*in_bracket=*/true);
        skip();
        add(node, std::move(name), in_bracket(depth), line);
      } else {
        node.items.push_back(in_bracket(depth));
      }
      skip();
      if (here() == ',')
        ++at_;
      else if (!ended() && here() != end)
        refuse(line_, std::string("a ',' or '") + end + "' is missing");
    }
    ++at_;
    if (!within_bracket_) refuse_second_line(0);
    return node;
  }

  YamlNode in_bracket(std::size_t depth) {
    const bool outer = std::exchange(within_bracket_, true);
    const std::size_t line = line_;
    YamlNode node = here() == '[' || here() == '{' ? bracket(depth + 1) : scalar(/*in_bracket=*/true);
    node.line = line;
    within_bracket_ = outer;
    return node;
  }

  void refuse_special() const {
    static constexpr std::string_view special = "&*!|>%@`";
    if (special.find(here()) == std::string_view::npos) return;
    refuse(line_, std::string("values that begin with '") + here() +
                      "' are not read here; if it is a text, write it in quotes");
  }

  YamlNode scalar(bool in_bracket) {
    if (here() == '"' || here() == '\'') {
      YamlNode node;
      node.quoted = true;
      node.text = quoted();
      return node;
    }
    refuse_special();
    const std::size_t begin = at_;
    static constexpr std::string_view ends_in_bracket = ",[]{}";
    while (!ended() && here() != '\n') {
      if (here() == '#' && at_ > begin && is_blank(text_[at_ - 1])) break;
      if (in_bracket && ends_in_bracket.find(here()) != std::string_view::npos) break;
      if (here() == ':' && (next() == '\0' || is_blank(next()))) refuse(line_, "a second ':' in one line");
      ++at_;
    }
    std::string_view text = text_.substr(begin, at_ - begin);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    if (text.empty()) refuse(line_, "a value is missing");
    YamlNode node;
    node.text = text;
    return node;
  }

  std::string quoted() {
    const char quote = here();
    const std::size_t begin = line_;
    std::string text;
    for (++at_;; ++at_) {
      if (ended() || here() == '\n') refuse(begin, "a quotation mark is missing at the end of a text");
      if (here() == quote && quote == '\'' && next() == quote) {
        ++at_;
      } else if (here() == quote) {
        break;
      } else if (here() == '\\' && quote == '"') {
        ++at_;
        text += escaped();
        continue;
      }
      text += here();
    }
    ++at_;
    return text;
  }

  [[nodiscard]] char escaped() const {
    switch (here()) {
      case 'n':
        return '\n';
      case 't':
        return '\t';
      case '"':
      case '\\':
      case '/':
        return here();
      default:
        refuse(line_, "of characters with a backslash, only \\n, \\t, \\\" and \\\\ are read");
    }
  }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
  bool within_bracket_ = false;
};

}  // namespace

Result<YamlNode> read_yaml(std::string_view text) {
  try {
    return YamlReader(text).read();
  } catch (const std::runtime_error& problem) {
    return Problem{problem.what()};
  }
}

}  // namespace tessera::ros2
