#include "spec/properties/property_text.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/text_checks.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* formula_hint = "combine paths by and, or, not, (...): robot.control.follow and not ...";
constexpr const char* element_hint =
    "for example robot.control.follow, or robot[i].control.follow in a fleet";
constexpr std::uint32_t deepest_formula = 64;

bool is_word(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= '0' && letter <= '9') || letter == '_';
}

/// A recursive descent parser. It stops at the first mistake.
class PropertyTextReader {
 public:
  PropertyTextReader(const Node& text, std::size_t offset, std::size_t length, Diagnostics& out)
      : text_(text), end_(offset + length), at_(offset), out_(out) {}

  std::optional<Formula> read() {
    std::optional<Formula> formula = disjunction(0);
    if (formula && at_ < end_) return complain_here();
    return formula;
  }

 private:
  [[nodiscard]] std::string_view rest() {
    while (at_ < end_ && is_blank(text_.text[at_])) ++at_;
    return std::string_view(text_.text).substr(at_, end_ - at_);
  }

  /// The next letters, digits and underscores.
  [[nodiscard]] std::string_view word() {
    const std::string_view left = rest();
    std::size_t length = 0;
    while (length < left.size() && is_word(left[length])) ++length;
    return left.substr(0, length);
  }

  bool take(std::string_view symbol) {
    if (!rest().starts_with(symbol)) return false;
    at_ += symbol.size();
    return true;
  }

  /// Words such as `any` may also begin a path.
  bool take_word(std::string_view wanted) {
    if (word() != wanted) return false;
    const std::size_t before = at_;
    at_ += wanted.size();
    if (at_ < end_ && (text_.text[at_] == '.' || text_.text[at_] == '[')) {
      at_ = before;
      return false;
    }
    return true;
  }

  std::nullopt_t fail(const char* code, std::size_t from, std::size_t length, const std::string& message,
                      const std::string& hint) {
    out_.error(code, text_.part(from, std::max<std::size_t>(length, 1)), message, hint);
    return std::nullopt;
  }

  std::nullopt_t complain_here() {
    const std::string_view left = rest();
    if (left.empty())
      return fail("E114", end_ > 0 ? end_ - 1 : 0, 1, "the property ends where a path should follow",
                  element_hint);
    for (const auto& [symbol, meant] :
         {std::pair{"&&", "and"}, {"||", "or"}, {"!", "not"}, {"&", "and"}, {"|", "or"}, {"=", "=="}})
      if (left.starts_with(symbol) && !left.starts_with("=="))
        return fail("E114", at_, std::string_view(symbol).size(), in_quotes(symbol) + " is not known here",
                    std::string("write ") + meant);
    const std::string_view found = word().empty() ? left.substr(0, 1) : word();
    return fail("E114", at_, found.size(), "unexpected " + in_quotes(found), formula_hint);
  }

  using Rule = std::optional<Formula> (PropertyTextReader::*)(std::uint32_t);

  /// Parts joined by one word.
  std::optional<Formula> joined(std::string_view by, Formula::Kind kind, Rule rule, std::uint32_t depth) {
    std::optional<Formula> first = (this->*rule)(depth);
    if (!first || word() != by) return first;
    Formula all;
    all.kind = kind;
    all.span = first->span;
    all.parts.push_back(std::move(*first));
    while (take_word(by)) {
      std::optional<Formula> next = (this->*rule)(depth);
      if (!next) return std::nullopt;
      all.parts.push_back(std::move(*next));
    }
    return all;
  }

  std::optional<Formula> disjunction(std::uint32_t depth) {
    return joined("or", Formula::Kind::either, &PropertyTextReader::conjunction, depth);
  }

  std::optional<Formula> conjunction(std::uint32_t depth) {
    return joined("and", Formula::Kind::both, &PropertyTextReader::negation, depth);
  }

  std::optional<Formula> negation(std::uint32_t depth) {
    if (depth >= deepest_formula)
      return fail("E114", at_, 1, "the property is nested too deeply", "use fewer brackets");
    const std::string_view next = word();
    const std::size_t from = at_;
    if (take_word("not")) return around(Formula::Kind::negation, from, negation(depth + 1));
    for (const auto& [quantifier, kind] :
         {std::pair{"any", Formula::Kind::some}, {"all", Formula::Kind::every}})
      if (take_word(quantifier)) {
        if (!take("("))
          return fail("E114", from, 3, in_quotes(next) + " needs brackets",
                      std::string(quantifier) + "(robot[*].control.follow)");
        return around(kind, from, bracketed(depth + 1));
      }
    if (take("(")) return bracketed(depth + 1);
    if (next.empty() || next == "and" || next == "or") return complain_here();
    return atom();
  }

  std::optional<Formula> around(Formula::Kind kind, std::size_t from, std::optional<Formula> part) {
    if (!part) return std::nullopt;
    Formula formula;
    formula.kind = kind;
    formula.span = text_.part(from, 3);
    formula.parts.push_back(std::move(*part));
    return formula;
  }

  std::optional<Formula> bracketed(std::uint32_t depth) {
    const std::size_t opened = at_ - 1;
    std::optional<Formula> inside = disjunction(depth);
    if (!inside || take(")")) return inside;
    if (rest().empty()) return fail("E114", opened, 1, "'(' is not closed", formula_hint);
    return complain_here();
  }

  std::optional<Formula> atom() {
    Formula formula;
    std::optional<WrittenPath> from = path();
    if (!from) return std::nullopt;
    formula.path = std::move(*from);
    formula.span = formula.path.whole;
    if (!compare(formula)) return std::nullopt;
    if (formula.compared || !take("->")) return formula;
    if (word().empty()) return complain_here();
    formula.to = path();
    if (!formula.to) return std::nullopt;
    return formula;
  }

  /// "== nobody" behind a path; false: a comparison without a value.
  bool compare(Formula& formula) {
    using Kind = Comparison::Kind;
    constexpr std::array<std::pair<std::string_view, Kind>, 6> operators{{{"==", Kind::equal},
                                                                          {"!=", Kind::unequal},
                                                                          {"<=", Kind::less_equal},
                                                                          {">=", Kind::greater_equal},
                                                                          {"<", Kind::less},
                                                                          {">", Kind::greater}}};
    for (const auto& [mark, kind] : operators) {
      if (!take(mark)) continue;
      const diagnostics::Span at = text_.part(at_ - mark.size(), mark.size());
      const std::string_view value = word();
      if (value.empty()) {
        const bool is_text = rest().starts_with('"') || rest().starts_with('\'');
        fail("E114", std::min(at_, end_ - 1), 1, "a value should follow " + in_quotes(mark),
             is_text ? "write it without quotes" : "for example dock.control.memory.lent_to == nobody");
        return false;
      }
      if (const std::size_t behind = at_ + value.size(); behind < end_ && text_.text[behind] == '.') {
        const bool is_number = value.find_first_not_of("0123456789") == std::string_view::npos;
        fail("E114", at_, value.size() + 1,
             is_number ? "counts are whole numbers"
                       : "a value should follow " + in_quotes(mark) + ", not a path",
             is_number ? "for example dock.control.memory.served >= 2"
                       : "write the path first: dock.control.memory.lent_to == nobody");
        return false;
      }
      formula.compared = {kind, {std::string(value), text_.part(at_, value.size())}, at};
      at_ += value.size();
      return index(formula.compared_index.selector, formula.compared_index.span);
    }
    return true;
  }

  std::optional<WrittenPath> path() {
    WrittenPath path;
    const std::string_view agent = word();
    const std::size_t from = at_;
    path.agent = agent;
    path.agent_span = text_.part(from, agent.size());
    if (!is_identifier(agent))
      return fail("E112", from, agent.size(), in_quotes(agent) + " does not name an agent", element_hint);
    at_ += agent.size();
    if (!index(path.selector, path.index_span)) return std::nullopt;
    while (at_ < end_ && text_.text[at_] == '.') {
      ++at_;
      std::size_t length = 0;
      // The blocks of an output that feeds several channels are numbered: motion#2.
      const auto of_name = [&](char c) { return is_word(c) || (length > 0 && c == '#'); };
      while (at_ + length < end_ && of_name(text_.text[at_ + length])) ++length;
      if (length == 0) return fail("E112", at_ - 1, 1, "a name should follow the '.'", element_hint);
      path.parts.push_back({text_.text.substr(at_, length), text_.part(at_, length)});
      at_ += length;
      WrittenIndex& its = path.indices.emplace_back();
      if (!index(its.selector, its.span)) return std::nullopt;
    }
    path.whole = text_.part(from, at_ - from);
    return path;
  }

  /// The index that may stand here.
  bool index(Selector& into, Span& span) {
    if (at_ >= end_ || text_.text[at_] != '[') return true;
    const std::size_t close = text_.text.find(']', at_);
    if (close == std::string::npos || close >= end_)
      return fail("E112", at_, 1, "'[' is not closed", index_hint), false;
    const std::string_view inside = std::string_view(text_.text).substr(at_ + 1, close - at_ - 1);
    span = text_.part(at_ + 1, std::max<std::size_t>(inside.size(), 1));
    const std::optional<Selector> selector = read_index(inside);
    if (!selector)
      return fail("E112", at_ + 1, inside.size(), in_quotes(inside) + " is not an index", index_hint), false;
    into = *selector;
    at_ = close + 1;
    return true;
  }

  const Node& text_;
  std::size_t end_, at_;
  Diagnostics& out_;
};

}  // namespace

std::optional<Formula> read_formula(const Node& text, std::size_t offset, std::size_t length,
                                    Diagnostics& out) {
  return PropertyTextReader(text, offset, length, out).read();
}

}  // namespace tessera::spec
