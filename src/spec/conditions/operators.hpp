#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "spec/conditions/names.hpp"

namespace tessera::spec {

/// Checks whether the operators of a condition fit their operands, as far as their types are known. C++ that
/// it does not understand (casts, templates, assignments to unknown things) is left to the compiler.
///
/// Errors: E209 an operator is missing or misspelt; E212 operands that do not go together, a condition that
///         is neither true nor false; E263 a memory cell with values that is not compared with one of them;
///         E264 a counter that is compared with a number that it never has. Warnings: W325 numbers of different units,
///         W326 a number as true or false.
class ConditionOperators {
 public:
  ConditionOperators(const std::vector<Token>& tokens, const Positions& positions,
                     const ConditionScope& scope, const ConditionNames& names, std::string_view text,
                     Diagnostics& out);

  void check();
  /// The numbers that are durations where they stand.
  [[nodiscard]] std::vector<Expression::TimeNumber> times() const;

 private:
  struct Mistake {
    bool warning = false;
    std::string code;
    Span span;
    std::string message, hint;
  };

  [[nodiscard]] const Token& token() const { return tokens_[at_]; }
  /// The rest is not understood.
  Value give_up();
  Value read(int least);
  Value read_operand();
  Value read_prefix();
  Value read_brackets();
  Value read_name();
  Value read_postfix(Value value);
  void read_arguments();
  [[nodiscard]] int binding() const;
  Value choose(const Value& condition);
  Value combine(const Token& mark, const Value& left, const Value& right);
  Value combine_logical(const Token& mark, const Value& left, const Value& right);
  Value compare(const Token& mark, const Value& left, const Value& right);
  void compare_choice(const Token& mark, const Value& left, const Value& right);
  void check_count(const Token& mark, const Value& left, const Value& right);
  void check_bits(const Token& mark, const Value& left, const Value& right);
  Value add(const Token& mark, const Value& left, const Value& right);
  Value multiply(const Token& mark, const Value& left, const Value& right);
  bool check_signs(const Token& mark, const Value& left, const Value& right);
  void as_duration(const Value& number);
  [[nodiscard]] std::string hint_for_duration(const Value& duration, const Value& number) const;
  void hint_at_minutes(const Value& left, const Value& right);
  void warn_of_truth(const Value& value, std::string message, std::string hint);
  bool check_units(const Token& mark, const Value& left, const Value& right);
  void misspelt();
  void need_truth(const Value& value, const std::string& where);

  void mistake(std::string code, const Value& value, std::string message, std::string hint = {});
  void mistake_at(const Token& mark, std::string code, std::string message, std::string hint = {});
  [[nodiscard]] std::string text_of(const Value& value) const;
  [[nodiscard]] std::string described(const Value& value) const;

  const std::vector<Token>& tokens_;
  const Positions& positions_;
  const ConditionScope& scope_;
  const ConditionNames& names_;
  std::string_view text_;
  Diagnostics& out_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool given_up_ = false;
  std::vector<Mistake> mistakes_;
  std::vector<Expression::TimeNumber> times_;
};

}  // namespace tessera::spec
