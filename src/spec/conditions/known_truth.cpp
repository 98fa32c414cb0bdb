#include "spec/conditions/known_truth.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tessera::spec {
namespace {

using Tokens = std::span<const Token>;

Truth negation(Truth truth) {
  if (truth == Truth::free) return Truth::free;
  return truth == Truth::always ? Truth::never : Truth::always;
}

bool opens(const Token& token) { return token.is_one_of({"(", "[", "{"}); }
bool closes(const Token& token) { return token.is_one_of({")", "]", "}"}); }

class Evaluation {
 public:
  explicit Evaluation(const PartTruth& part) : part_(part) {}

  Truth whole(Tokens tokens) {
    if (has_outside(tokens, [](const Token& token) {
          return token.is_one_of(
              {"?", ",", "=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="});
        }))
      return Truth::free;
    return joined(tokens, {"||", "or"}, Truth::always, [this](Tokens part) {
      return joined(part, {"&&", "and"}, Truth::never, [this](Tokens operand) { return single(operand); });
    });
  }

 private:
  /// Whether a token outside all brackets is such a one.
  template <class Asked>
  static bool has_outside(Tokens tokens, Asked asked) {
    int depth = 0;
    for (const Token& token : tokens) {
      if (closes(token)) --depth;
      if (depth == 0 && asked(token)) return true;
      if (opens(token)) ++depth;
    }
    return false;
  }

  /// decides: the truth of one operand that is the truth of the whole.
  template <class Operand>
  static Truth joined(Tokens tokens, std::initializer_list<std::string_view> marks, Truth decides,
                      Operand operand) {
    Truth all = negation(decides);
    const auto add = [&](Tokens part) {
      const Truth one = operand(part);
      if (one == decides || all == decides)
        all = decides;
      else if (one == Truth::free)
        all = Truth::free;
    };
    std::size_t begin = 0;
    int depth = 0;
    for (std::size_t at = 0; at < tokens.size(); ++at) {
      if (closes(tokens[at])) --depth;
      if (depth == 0 && tokens[at].is_one_of(marks)) {
        add(tokens.subspan(begin, at - begin));
        begin = at + 1;
      }
      if (opens(tokens[at])) ++depth;
    }
    add(tokens.subspan(begin));
    return all;
  }

  /// An operand without logical operators outside brackets.
  Truth single(Tokens tokens) {
    if (tokens.empty()) return Truth::free;
    if (tokens.front().is_one_of({"!", "not"})) {
      const Tokens operand = tokens.subspan(1);
      return binds_to_all(operand) ? negation(single(operand)) : Truth::free;
    }
    if (is_bracketed(tokens)) return whole(tokens.subspan(1, tokens.size() - 2));
    if (tokens.size() == 1 && tokens.front().is("true")) return Truth::always;
    if (tokens.size() == 1 && tokens.front().is("false")) return Truth::never;
    return part_(tokens);
  }

  /// One pair of round brackets encloses all.
  static bool is_bracketed(Tokens tokens) {
    if (tokens.size() < 3 || !tokens.front().is("(") || !tokens.back().is(")")) return false;
    int depth = 0;
    for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
      depth += static_cast<int>(opens(tokens[at])) - static_cast<int>(closes(tokens[at]));
      if (depth == 0) return false;
    }
    return true;
  }

  /// Whether a negation in front is that of all tokens, and not of the first operand of a comparison.
  static bool binds_to_all(Tokens tokens) {
    while (!tokens.empty() && tokens.front().is_one_of({"!", "not"})) tokens = tokens.subspan(1);
    return !tokens.empty() && !has_outside(tokens, [](const Token& token) {
      return token.kind == Token::Kind::mark && !opens(token) && !closes(token) &&
             !token.is_one_of({".", "::", "->"});
    }) && !has_outside(tokens, [](const Token& token) {
      return token.is_one_of({"bitor", "bitand", "xor", "not_eq", "compl"});
    });
  }

  const PartTruth& part_;
};

}  // namespace

Truth truth_of(std::string_view expression, const PartTruth& part) {
  const std::vector<Token> tokens = tokens_of(expression);
  return Evaluation(part).whole(Tokens(tokens).first(tokens.size() - 1));
}

}  // namespace tessera::spec
