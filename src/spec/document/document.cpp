#include "spec/document/document.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <istream>
#include <streambuf>
#include <string_view>
#include <unordered_map>

#include "diagnostics/utf8.hpp"
#include "spec/document/scalar_position.hpp"
#include "spec/document/syntax_errors.hpp"

namespace tessera::spec {
namespace {

/// Thrown to leave yaml-cpp's parser after the mistake has been reported.
struct Abandon {};

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// A stream over the text itself, without a second copy of a large file.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(const std::string& text) {
    char* begin = const_cast<char*>(text.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast): only read
    setg(begin, begin, begin + text.size());
  }
};

}  // namespace

Span Node::part(std::size_t offset, std::size_t length) const {
  if (!verbatim) return span;
  return {span.line, span.column + static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(length)};
}

void Document::shift(std::uint32_t lines) {
  for (Node& node : nodes_) {
    node.span.line += lines;
    for (Entry& entry : node.entries) entry.span.line += lines;
  }
}

/// Builds the tree from yaml-cpp's events.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(Document& document, Diagnostics& out)
      : document_(document),
        out_(out),
        first_line_shift_(out.text().starts_with(byte_order_mark) ? byte_order_mark.size() : 0) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ > 0)
      fail("E006", span(mark), "a second document begins here", "one file holds one system");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node& node = make(Node::Kind::null, mark, anchor);
    const Span at = behind_anchor_and_tag(node.span, out_);
    const bool written = out_.line(at.line)
                             .substr(std::min<std::size_t>(at.column - 1, out_.line(at.line).size()))
                             .find_first_of("~nN") == 0;
    // An empty value has no position of its own (yaml-cpp gives that of the next token): complain about its key.
    if (!written && awaits_value()) {
      node.span = open_.back().pending.span;
    }
    locate(node);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) fail("E005", span(mark), "this alias names no anchor above it");
    Node& node = *found->second;
    for (const Frame& frame : open_) {
      if (frame.node == &node) fail("E008", span(mark), "this alias contains itself");
    }
    if (open_.size() + node.height > deepest) too_deep(span(mark));
    count(node.size, span(mark));
    locate(node);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node& node = make(Node::Kind::scalar, mark, anchor);
    node.text = value;
    node.quoted = tag == "!";
    if (!locate_scalar(node, node.span, out_)) {
      fail("E005", node.span, "the quote that opens here is never closed");
    }
    complain_about_tag(tag, node.span);
    locate(node);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    start(Node::Kind::sequence, mark, tag, anchor);
  }
  void OnSequenceEnd() override { finish(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    start(Node::Kind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { finish(); }

 private:
  /// A collection whose end has not been read yet.
  struct Frame {
    Node* node = nullptr;
    bool key_read = false;  ///< of a map: the next node is the value of `pending`
    bool key_usable = false;
    Entry pending;
    std::unordered_map<std::string, std::uint32_t> lines;  ///< of the keys read so far
  };

  [[noreturn]] void fail(std::string code, Span at, std::string message, std::string hint = {}) {
    out_.error(std::move(code), at, std::move(message), std::move(hint));
    throw Abandon{};
  }

  [[noreturn]] void too_deep(Span at) {
    fail("E007", at, "nested more than " + std::to_string(deepest) + " levels deep");
  }

  [[nodiscard]] Span span(const YAML::Mark& mark) const {
    const auto shift = mark.line == 0 ? first_line_shift_ : 0;
    return {static_cast<std::uint32_t>(mark.line) + 1,
            static_cast<std::uint32_t>(mark.column) + 1 + static_cast<std::uint32_t>(shift), 1};
  }

  [[nodiscard]] bool awaits_value() const {
    return !open_.empty() && open_.back().node->is_map() && open_.back().key_read;
  }

  void count(std::uint64_t nodes, Span at) {
    total_ += nodes;
    if (total_ <= most_nodes) return;
    fail("E008", at, "aliases expand to more than " + std::to_string(most_nodes) + " nodes",
         "write the repeated part as a template of agents");
  }

  void complain_about_tag(const std::string& tag, Span at) {
    if (tag.size() > 1) {
      out_.error("E010", at, "tags such as !!str mean nothing here", "leave the tag out; put text in quotes");
    }
  }

  Node& make(Node::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    Node& node = document_.nodes_.emplace_back();
    node.kind = kind;
    node.span = span(mark);
    if (anchor != 0) anchors_.emplace(anchor, &node);
    if (document_.nodes_.size() > most_nodes) fail("E008", node.span, "the file has more than 2000000 nodes");
    ++total_;
    return node;
  }

  void start(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    Node& node = make(kind, mark, anchor);
    if (open_.size() >= deepest) too_deep(node.span);
    complain_about_tag(tag, node.span);
    open_.push_back({.node = &node, .key_read = false, .key_usable = false, .pending = {}, .lines = {}});
  }

  /// The collection is complete. Only now, its size and height are known to the surrounding one.
  void finish() {
    Node& node = *open_.back().node;
    open_.pop_back();
    locate(node);
  }

  void locate(Node& node) {
    if (open_.empty()) {
      document_.root_ = &node;
      return;
    }
    Frame& frame = open_.back();
    frame.node->size += node.size;
    frame.node->height = std::max(frame.node->height, node.height + 1);
    if (frame.node->is_sequence()) {
      frame.node->items.push_back(&node);
    } else if (frame.key_read) {
      frame.key_read = false;
      frame.pending.value = &node;
      if (frame.key_usable) frame.node->entries.push_back(std::move(frame.pending));
    } else {
      read_key(frame, node);
    }
  }

  void read_key(Frame& frame, const Node& key) {
    frame.key_read = true;
    frame.key_usable = false;
    frame.pending = {key.text, key.span, nullptr};
    if (!key.is_scalar()) {
      out_.error("E010", key.span, "a key must be plain text",
                 key.is_null() ? "YAML reads NULL, null and ~ as nothing: choose another name"
                               : "write { and [ in a value in quotes");
    } else if (const auto [first, added] = frame.lines.emplace(key.text, key.span.line); !added) {
      out_.error("E009", key.span, "duplicate key " + diagnostics::in_quotes(key.text),
                 "the first one is on " + out_.words(first->second) + "; keep one of them");
    } else {
      frame.key_usable = true;
    }
  }

  Document& document_;
  Diagnostics& out_;
  std::size_t first_line_shift_;
  std::vector<Frame> open_;
  std::unordered_map<YAML::anchor_t, Node*> anchors_;
  std::uint64_t total_ = 0;
  int documents_ = 0;
};

namespace {

/// Feeds every document of the text to the builder. false: there was a mistake.
bool feed(TreeBuilder& builder, Diagnostics& out) {
  TextBuffer buffer(out.text());
  std::istream stream(&buffer);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
    return true;
  } catch (const Abandon&) {
    return false;
  } catch (const YAML::Exception& problem) {
    report_syntax_error(problem, out);
    return false;
  }
}

}  // namespace

std::optional<Document> read_document(Diagnostics& out, std::string beginning) {
  Document document;
  TreeBuilder builder(document, out);
  if (!feed(builder, out)) return std::nullopt;
  const std::string& text = out.text();
  const std::size_t first = text.find_first_not_of(" \t\r\n", text.starts_with(byte_order_mark) ? 3 : 0);
  if (document.empty()) {
    out.error("E002", {},
              first == std::string::npos ? "the file is empty" : "the file holds no specification",
              std::move(beginning));
    return std::nullopt;
  }
  return document;
}

}  // namespace tessera::spec
