#include "language/text/outline.hpp"

#include <algorithm>
#include <map>

#include "language/text/scalars.hpp"

namespace tessera::language {
namespace {

constexpr std::size_t deepest = 64;
constexpr std::string_view blank = " \t";

const Node no_node{};

/// Reads a text from top to bottom. It never fails: unknown parts become scalars or are left out.
class OutlineReader {
 public:
  OutlineReader(std::string_view text, std::deque<Node>& nodes, std::vector<Anchor>& names)
      : text_(text), nodes_(nodes), names_(names) {}

  const Node* read() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = line_start_ = 3;
    next_content();
    if (text_.substr(at_).starts_with("---")) {
      at_ += 3;
      next_content();
    }
    const Node* root = block(0, 0);
    Node* joined = nullptr;
    // Skips the lines after one that fits nowhere.
    while (!done()) {
      const std::size_t before = at_;
      alias_ = {};
      const Node* more = block(0, 0);
      if (root->is_map() && more->is_map()) {
        if (joined == nullptr) {
          joined = &make(Node::Kind::map, root->extent.begin);
          joined->entries = root->entries;
          joined->column = root->column;
          root = joined;
        }
        joined->entries.insert(joined->entries.end(), more->entries.begin(), more->entries.end());
        joined->extent.end = at_;
        joined->written = {root->extent.begin, more->written.end};
      }
      if (at_ == before) skip_line();
    }
    return root;
  }

 private:
  [[nodiscard]] bool done() const { return at_ >= text_.size(); }
  [[nodiscard]] char here() const { return at_ < text_.size() ? text_[at_] : '\n'; }
  [[nodiscard]] std::size_t column() const { return at_ - line_start_; }
  [[nodiscard]] bool at_line_end() const { return here() == '\n' || here() == '\r'; }

  Node& make(Node::Kind kind, std::size_t begin) {
    Node& node = nodes_.emplace_back();
    node.kind = kind;
    node.extent = {begin, begin};
    return node;
  }

  void skip_blank() {
    while (!done() && (here() == ' ' || here() == '\t')) ++at_;
    if (here() == '#' && (at_ == line_start_ || blank.find(text_[at_ - 1]) != std::string_view::npos))
      while (!done() && !at_line_end()) ++at_;
  }

  void new_line() {
    if (done()) return;
    if (here() == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    ++at_;
    line_start_ = at_;
  }

  void skip_line() {
    while (!done() && !at_line_end()) ++at_;
    new_line();
    next_content();
  }

  /// To the next byte that is neither blank nor comment, on this line or a later one.
  void next_content() {
    for (;;) {
      skip_blank();
      if (done() || !at_line_end()) return;
      new_line();
    }
  }

  [[nodiscard]] bool at_dash() const {
    return here() == '-' && (at_ + 1 >= text_.size() ||
                             std::string_view(" \t\r\n").find(text_[at_ + 1]) != std::string_view::npos);
  }

  /// Behind anchors and tags; the last anchor is kept in `anchor_`.
  void skip_properties() {
    anchor_.clear();
    while (here() == '&' || here() == '!') {
      const bool anchor = here() == '&';
      const std::size_t begin = ++at_;
      while (!done() && std::string_view(" \t\r\n,[]{}").find(here()) == std::string_view::npos) ++at_;
      if (anchor) {
        anchor_ = std::string(text_.substr(begin, at_ - begin));
        names_.push_back({anchor_, begin - 1, false});
      }
      skip_blank();
    }
  }

  const Node* anchored(const std::string& anchor, const Node* node) {
    if (!anchor.empty()) anchors_[anchor] = node;
    return node;
  }

  /// The node that begins at the next content, if that is indented by `least` columns or more.
  const Node* block(std::size_t least, std::size_t depth) {
    next_content();
    if (done() || column() < least || depth > deepest) {
      if (depth > deepest) skip_line();
      return &make(Node::Kind::null, at_);
    }
    return content(column(), least, depth);
  }

  /// The node that begins here. indent: the column that entries of a map that begins here have.
  const Node* content(std::size_t indent, std::size_t least, std::size_t depth) {
    if (at_dash()) return sequence(indent, depth);
    const std::size_t begin = at_;
    skip_properties();
    const std::string anchor = anchor_;
    if (at_line_end() && !anchor.empty()) return anchored(anchor, block(least, depth + 1));
    if (begin == at_ && key_here(false)) return map(indent, depth);
    return anchored(anchor, value(least, depth));
  }

  /// Whether a key and its colon begin here.
  bool key_here(bool in_flow) const {
    const std::size_t end = scan_key(text_, at_, in_flow).after;
    return end < text_.size() && text_[end] == ':' && !(here() == '{' || here() == '[');
  }

  const Node* sequence(std::size_t indent, std::size_t depth) {
    Node& node = make(Node::Kind::sequence, at_);
    node.column = indent;
    while (!done() && column() == indent && at_dash()) {
      const std::size_t dash = at_++;
      skip_blank();
      const Node* item = at_line_end()     ? block(indent + 1, depth + 1)
                         : depth < deepest ? content(column(), indent + 1, depth + 1)
                                           : too_deep();
      node.items.push_back(placed({.value = item}, dash, dash + 1));
      node.extent.end = std::max(node.extent.end, item->extent.end);
      next_content();
    }
    node.written = {node.extent.begin, node.items.back().whole.end};
    return &node;
  }

  /// Fills in where an entry or item stands that was read last. begin: its first byte.
  Entry placed(Entry entry, std::size_t begin, std::size_t behind) {
    entry.is_alias = !alias_.empty();
    entry.behind = behind;
    entry.written = entry.is_alias                          ? alias_
                    : entry.value->kind == Node::Kind::null ? Extent{behind, behind}
                                                            : entry.value->written;
    entry.whole = {begin, entry.written.end};
    alias_ = {};
    return entry;
  }

  const Node* too_deep() {
    Node& node = make(Node::Kind::null, at_);
    skip_line();
    return &node;
  }

  const Node* map(std::size_t indent, std::size_t depth) {
    Node& node = make(Node::Kind::map, at_);
    node.column = indent;
    while (!done() && column() >= indent && !(column() == indent && at_dash())) {
      node.entries.push_back(entry(indent, depth));
      node.extent.end = std::max(node.entries.back().extent.end, node.entries.back().value->extent.end);
      next_content();
    }
    node.written = {node.extent.begin, node.entries.back().whole.end};
    return &node;
  }

  Entry entry(std::size_t indent, std::size_t depth) {
    const Key key = scan_key(text_, at_, false);
    Entry entry{.key = key.text, .extent = key.extent};
    const std::size_t begin = at_;
    at_ = key.after;
    if (here() != ':') {
      entry.complete = false;
      // The rest of a line that is no entry: an unfinished key, or a text without a key.
      while (!done() && !at_line_end()) ++at_;
      entry.value = &make(Node::Kind::null, key.extent.end);
      return placed(entry, begin, end_of(key, begin));
    }
    ++at_;
    const std::size_t after_colon = at_;
    skip_blank();
    skip_properties();
    const std::string anchor = anchor_;
    if (at_line_end() || done()) {
      next_content();
      // The items of a list may stand below its key without indentation.
      const bool list = !done() && column() == indent && at_dash();
      if (!done() && (column() > indent || list)) {
        entry.value = anchored(anchor, block(list ? indent : indent + 1, depth + 1));
      } else {
        entry.value = &make(Node::Kind::null, after_colon);
      }
    } else {
      entry.value = anchored(anchor, value(indent + 1, depth));
    }
    return placed(entry, begin, after_colon);
  }

  /// The end of a key that begins there, with its quotes.
  [[nodiscard]] static std::size_t end_of(const Key& key, std::size_t begin) {
    return key.extent.end + (key.extent.begin - begin);
  }

  /// A scalar, an alias or a collection in brackets. least: the indentation of its further lines.
  const Node* value(std::size_t least, std::size_t depth) {
    switch (here()) {
      case '{':
      case '[':
        return flow(least, depth + 1);
      case '*':
        return alias(false);
      case '|':
      case '>':
        return block_text(least);
      case '"':
      case '\'':
        return quoted_text(least);
      default:
        return plain_text(least);
    }
  }

  const Node* alias(bool in_flow) {
    const std::size_t begin = ++at_;
    while (!done() && std::string_view(" \t\r\n").find(here()) == std::string_view::npos &&
           !(in_flow && std::string_view(",[]{}").find(here()) != std::string_view::npos))
      ++at_;
    std::string name(text_.substr(begin, at_ - begin));
    const auto found = anchors_.find(name);
    alias_ = {begin - 1, at_};
    names_.push_back({std::move(name), begin - 1, true});
    return found != anchors_.end() ? found->second : &make(Node::Kind::null, begin);
  }

  const Node* adopt(const ScalarText& scalar) {
    Node& node = make(Node::Kind::scalar, scalar.extent.begin);
    node.extent = scalar.extent;
    const std::size_t last = text_.find_last_not_of(" \t\r\n", scalar.after == 0 ? 0 : scalar.after - 1);
    node.written = {at_, std::max(at_, last == std::string_view::npos ? at_ : last + 1)};
    node.text = scalar.text;
    node.quoted = scalar.quoted;
    node.verbatim = text_.substr(node.extent.begin, node.extent.end - node.extent.begin) == node.text;
    at_ = scalar.after;
    const std::size_t line = text_.find_last_of("\r\n", at_ == 0 ? 0 : at_ - 1);
    if (line != std::string_view::npos && line + 1 > line_start_ && line < at_) line_start_ = line + 1;
    return &node;
  }

  const Node* quoted_text(std::size_t least) { return adopt(scan_quoted(text_, at_, least)); }
  const Node* block_text(std::size_t least) { return adopt(scan_block(text_, at_, least)); }
  const Node* plain_text(std::size_t least) { return adopt(scan_plain(text_, at_, least)); }

  /// To the next content inside brackets. false: the text ends, or a line that is not indented ends them.
  /// first_line: where their line begins.
  bool flow_content(std::size_t least, std::size_t first_line) {
    next_content();
    if (done()) return false;
    if (line_start_ == first_line || column() >= least) return true;
    return here() == '}' || here() == ']';
  }

  const Node* flow(std::size_t least, std::size_t depth) {
    const bool is_map = here() == '{';
    const char close = is_map ? '}' : ']';
    Node& node = make(is_map ? Node::Kind::map : Node::Kind::sequence, at_);
    node.flow = true;
    ++at_;
    const std::size_t first_line = line_start_;
    while (flow_content(least, first_line)) {
      if (here() == close) {
        ++at_;
        break;
      }
      if (here() == '}' || here() == ']') {  // the bracket of a surrounding collection
        if (depth > 1) break;
        ++at_;
        continue;
      }
      if (here() == ',') {
        ++at_;
        continue;
      }
      if (depth > deepest) {
        ++at_;
      } else if (is_map) {
        node.entries.push_back(flow_entry(least, depth));
      } else {
        const std::size_t begin = at_;
        node.items.push_back(placed({.value = flow_item(least, depth)}, begin, begin));
      }
    }
    node.extent.end = at_;
    node.written = node.extent;
    return &node;
  }

  Entry flow_entry(std::size_t least, std::size_t depth) {
    const Key key = scan_key(text_, at_, true);
    Entry entry{.key = key.text, .extent = key.extent};
    const std::size_t begin = at_;
    at_ = std::max(key.after, at_);
    skip_blank();
    if (here() != ':') {
      if (at_ == key.extent.begin && !at_line_end()) ++at_;
      entry.complete = false;
      entry.value = &make(Node::Kind::null, at_);
      return placed(entry, begin, end_of(key, begin));
    }
    ++at_;
    const std::size_t after_colon = at_;
    const std::size_t key_line = line_start_;
    if (!flow_content(least, key_line) || here() == ',' || here() == '}' || here() == ']') {
      entry.value = &make(Node::Kind::null, after_colon);
    } else {
      entry.value = flow_value(least, depth);
    }
    return placed(entry, begin, after_colon);
  }

  const Node* flow_value(std::size_t least, std::size_t depth) {
    skip_properties();
    const std::string anchor = anchor_;
    const char first = here();
    const Node* node = first == '{' || first == '['    ? flow(least, depth + 1)
                       : first == '*'                  ? alias(true)
                       : first == '"' || first == '\'' ? quoted_text(least)
                                                       : adopt(scan_flow_plain(text_, at_, least));
    return anchored(anchor, node);
  }

  /// An item of a list. `a: b` there is a map of one entry.
  const Node* flow_item(std::size_t least, std::size_t depth) {
    const std::size_t before = at_;
    if (here() != '{' && here() != '[' && key_here(true)) {
      Node& map = make(Node::Kind::map, at_);
      map.flow = true;
      map.entries.push_back(flow_entry(least, depth));
      map.extent.end = at_;
      map.written = {map.extent.begin, map.entries.back().whole.end};
      return &map;
    }
    const Node* node = flow_value(least, depth);
    if (at_ == before) ++at_;
    return node;
  }

  std::string_view text_;
  std::deque<Node>& nodes_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  std::string anchor_;
  Extent alias_;  ///< the alias that was read as the value of the present entry; empty: none
  std::map<std::string, const Node*> anchors_;
  std::vector<Anchor>& names_;
};

}  // namespace

const Entry* Node::find(std::string_view key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [key](const Entry& one) { return one.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

const Node& Node::operator[](std::string_view key) const {
  const Entry* entry = find(key);
  return entry == nullptr ? no_node : *entry->value;
}

Outline::Outline(std::string_view text) { root_ = OutlineReader(text, nodes_, anchors_).read(); }

}  // namespace tessera::language
