#include "project/build/source_scan.hpp"

#include <algorithm>
#include <cctype>

namespace tessera::project {

namespace {

bool in_name(char character) {
  const auto byte = static_cast<unsigned char>(character);
  return std::isalnum(byte) != 0 || character == '_' || byte >= 0x80;
}

/// Replaces comments and literals by blanks; ends of lines stay, so that positions stay the same.
class Blanker {
 public:
  explicit Blanker(const std::string& text) : in_(text), out_(text) {}

  std::string blanked() {
    while (at_ < in_.size()) {
      if (starts("//"))
        blank_to(end_of_comment_line());
      else if (starts("/*"))
        blank_to(after(in_.find("*/", at_ + 2), 2));
      else if (in_[at_] == '"' && is_raw())
        blank_to(end_of_raw());
      else if (in_[at_] == '"' || (in_[at_] == '\'' && !separates_digits()))
        blank_to(end_of_literal(in_[at_]));
      else
        ++at_;
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool starts(std::string_view what) const { return in_.compare(at_, what.size(), what) == 0; }
  [[nodiscard]] std::size_t after(std::size_t found, std::size_t length) const {
    return found == std::string::npos ? in_.size() : found + length;
  }
  [[nodiscard]] std::size_t end_of_comment_line() const {
    std::size_t end = in_.find('\n', at_);
    while (end != std::string::npos && end > 0 && in_[end - 1] == '\\') end = in_.find('\n', end + 1);
    return std::min(end, in_.size());
  }
  [[nodiscard]] bool is_raw() const {
    if (at_ == 0 || in_[at_ - 1] != 'R') return false;
    std::size_t begin = at_ - 1;
    while (begin > 0 && in_name(in_[begin - 1])) --begin;
    const std::string_view prefix = std::string_view(in_).substr(begin, at_ - begin);
    return prefix == "R" || prefix == "LR" || prefix == "uR" || prefix == "UR" || prefix == "u8R";
  }
  [[nodiscard]] std::size_t end_of_raw() const {
    const std::size_t open = in_.find('(', at_);
    if (open == std::string::npos) return in_.size();
    const std::string end = ")" + in_.substr(at_ + 1, open - at_ - 1) + "\"";
    return after(in_.find(end, open), end.size());
  }
  [[nodiscard]] bool separates_digits() const {
    return at_ > 0 && at_ + 1 < in_.size() && std::isxdigit(static_cast<unsigned char>(in_[at_ - 1])) != 0 &&
           std::isxdigit(static_cast<unsigned char>(in_[at_ + 1])) != 0;
  }
  [[nodiscard]] std::size_t end_of_literal(char quote) const {
    for (std::size_t end = at_ + 1; end < in_.size(); ++end) {
      if (in_[end] == '\\')
        ++end;
      else if (in_[end] == quote)
        return end + 1;
      else if (in_[end] == '\n')
        return end;  // not a literal after all
    }
    return in_.size();
  }
  void blank_to(std::size_t end) {
    for (; at_ < std::min(end, in_.size()); ++at_)
      if (in_[at_] != '\n') out_[at_] = ' ';
  }

  const std::string& in_;
  std::string out_;
  std::size_t at_ = 0;
};

/// Reads the preprocessor directives of a blanked text and replaces them by blanks, too.
class Directives {
 public:
  Directives(const std::string& original, std::string& text, SourceScan& scan)
      : original_(original), text_(text), scan_(scan) {}

  void take_out() {
    for (std::size_t begin = 0; begin < text_.size();) {
      std::size_t end = text_.find('\n', begin);
      while (end != std::string::npos && end > begin && text_[end - 1] == '\\')
        end = text_.find('\n', end + 1);
      end = std::min(end, text_.size());
      const std::size_t first = text_.find_first_not_of(" \t", begin);
      const bool is_directive = first < end && text_[first] == '#';
      if (is_directive) read(first + 1, end);
      if (is_directive || nothing_of_ > 0) blank(begin, end);
      begin = end + 1;
    }
  }

 private:
  void read(std::size_t begin, std::size_t end) {
    const std::string_view line = std::string_view(text_).substr(begin, end - begin);
    const std::string word = word_of(line);
    const bool opens = word == "if" || word == "ifdef" || word == "ifndef";
    if (nothing_of_ > 0) {
      if (opens) ++nothing_of_;
      if (word == "endif") --nothing_of_;
      if (nothing_of_ == 1 && (word == "else" || word == "elif")) nothing_of_ = 0;
      return;
    }
    if (word == "if" && word_of(line.substr(line.find("if") + 2)) == "0") nothing_of_ = 1;
    if (word == "include") add_include(begin, end);
    if (word == "define") add_words(line);
    if (line.find("##") != std::string_view::npos) scan_.makes_names = true;
  }
  static std::string word_of(std::string_view line) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    std::size_t end = begin;
    while (end < line.size() && in_name(line[end])) ++end;
    return std::string(line.substr(begin, end - begin));
  }
  void add_include(std::size_t begin, std::size_t end) {
    const std::size_t open = original_.find('"', begin), close = original_.find('"', open + 1);
    if (open < end && close < end) scan_.includes.push_back(original_.substr(open + 1, close - open - 1));
    const std::size_t name = text_.find_first_not_of(" \t", text_.find("include", begin) + 7);
    if (name < end && in_name(text_[name])) scan_.makes_names = true;  // the name itself is a macro
  }
  void add_words(std::string_view line) {
    for (std::size_t at = 0; at < line.size();) {
      const std::string word = word_of(line.substr(at));
      if (!word.empty()) ++scan_.words[word];
      at = line.find_first_not_of(" \t", at) + std::max<std::size_t>(1, word.size());
      if (line.find_first_not_of(" \t", at) == std::string_view::npos) break;
    }
  }
  void blank(std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin)
      if (text_[begin] != '\n') text_[begin] = ' ';
  }

  const std::string& original_;
  std::string& text_;
  SourceScan& scan_;
  int nothing_of_ = 0;  // depth within #if 0
};

struct Token {
  std::string_view text;
  std::size_t at = 0;
};

std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> tokens;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    if (in_name(text[at]))
      while (end < text.size() && in_name(text[end])) ++end;
    else if (text.substr(at, 2) == "::")
      ++end;
    if (std::isspace(static_cast<unsigned char>(text[at])) == 0)
      tokens.push_back({text.substr(at, end - at), at});
    at = end;
  }
  return tokens;
}

std::string joined(const std::string& outer, const std::string& inner) {
  return outer.empty() || inner.empty() ? outer + inner : outer + "::" + inner;
}

/// Finds namespaces, and the functions in them.
class Walk {
 public:
  Walk(const std::string& text, SourceScan& scan) : text_(text), scan_(scan), tokens_(tokens_of(text)) {}

  void walk() {
    for (at_ = 0; at_ < tokens_.size(); ++at_) {
      const std::string_view token = tokens_[at_].text;
      if (in_name(token.front()) && only_namespaces()) ++scan_.words[std::string(token)];
      if (token == "namespace")
        enter_namespace();
      else if (token == "{")
        enter();
      else if (token == "}")
        leave();
      else if ((token == "void" || token == "auto") && only_namespaces())
        look_for_function();
    }
    if (!only_namespaces()) scan_.bodies.back().last = line_of(text_.size());
  }

 private:
  struct Scope {
    std::string name;
    bool is_namespace = false;
  };

  [[nodiscard]] std::string_view token(std::size_t index) const {
    return index < tokens_.size() ? tokens_[index].text : std::string_view();
  }
  [[nodiscard]] bool only_namespaces() const {
    return std::ranges::all_of(scopes_, [](const Scope& scope) { return scope.is_namespace; });
  }
  [[nodiscard]] std::string space() const {
    std::string all;
    for (const Scope& scope : scopes_) all = joined(all, scope.name);
    return all;
  }
  void enter_namespace() {
    std::string name;
    std::size_t next = at_ + 1;
    for (; next < tokens_.size() && token(next) != "{"; ++next) {
      if (token(next) == ";" || token(next) == "=") return;  // an alias, or using namespace
      if (in_name(token(next).front()) && token(next) != "inline")
        name = joined(name, std::string(token(next)));
    }
    scopes_.push_back({name.empty() ? "(unnamed)" : name, true});
    at_ = next;
  }
  void enter() {
    const bool is_linkage = at_ > 0 && tokens_[at_ - 1].text == "extern";
    if (!is_linkage && only_namespaces()) scan_.bodies.push_back({line_of(tokens_[at_].at), 0});
    scopes_.push_back({"", is_linkage});
  }
  void leave() {
    if (scopes_.empty()) return;
    if (scopes_.back().is_namespace) scan_.ends[space()] = tokens_[at_].at;
    const bool was_inside = !only_namespaces();
    scopes_.pop_back();
    if (was_inside && only_namespaces()) scan_.bodies.back().last = line_of(tokens_[at_].at);
  }
  [[nodiscard]] std::uint32_t line_of(std::size_t position) const {
    return static_cast<std::uint32_t>(
        1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(position), '\n'));
  }
  /// The index after `)` at `index` and its specifiers.
  [[nodiscard]] std::size_t after_parentheses(std::size_t index) const {
    std::size_t depth = 0;
    for (; index < tokens_.size(); ++index) {
      if (token(index) == "(") ++depth;
      if (token(index) == ")" && --depth == 0) return index + 1;
    }
    return index;
  }
  void look_for_function() {
    std::size_t next = at_ + 1;
    std::string path, name;
    for (; in_name(token(next).empty() ? ' ' : token(next).front()) || token(next) == "::"; ++next) {
      if (token(next) == "::") continue;
      path = joined(path, name);
      name = token(next);
    }
    if (name.empty() || token(next) != "(") return;
    std::size_t end = after_parentheses(next);
    while (end < tokens_.size() && token(end) != "{" && token(end) != ";" && token(end) != "}" &&
           token(end) != "=")
      ++end;
    if (token(end) != "{") return;
    (takes_context(next + 1) ? scan_.functions : scan_.others)
        .push_back({name, joined(space(), path), line_of(tokens_[next - 1].at), in_one_line(at_, end)});
  }
  /// The text of the tokens from `begin` to before `end`.
  [[nodiscard]] std::string in_one_line(std::size_t begin, std::size_t end) const {
    std::string line;
    for (std::size_t index = begin; index < end; ++index) {
      const Token& one = tokens_[index];
      const bool touches = index == begin || tokens_[index - 1].at + tokens_[index - 1].text.size() == one.at;
      line += (touches ? "" : " ") + std::string(one.text);
    }
    return line;
  }
  [[nodiscard]] bool takes_context(std::size_t index) const {
    std::string_view last;
    for (; token(index) == "::" || (!token(index).empty() && in_name(token(index).front())); ++index)
      if (token(index) != "::" && token(index) != "const" && last != "Context") last = token(index);
    return last == "Context" && token(index) == "&";
  }

  const std::string& text_;
  SourceScan& scan_;
  std::vector<Token> tokens_;
  std::vector<Scope> scopes_;
  std::size_t at_ = 0;
};

}  // namespace

SourceScan scan_source(const std::string& text) {
  SourceScan scan;
  std::string blanked = Blanker(text).blanked();
  Directives(text, blanked, scan).take_out();
  Walk(blanked, scan).walk();
  return scan;
}

}  // namespace tessera::project
