#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spec/conditions/positions.hpp"
#include "spec/conditions/scope.hpp"
#include "spec/conditions/tokens.hpp"
#include "spec/conditions/value.hpp"

namespace tessera::spec {

/// The names of a condition: what they stand for, and what is wrong with them.
class ConditionNames {
 public:
  /// others: names that have no meaning inside of an expression but elsewhere, for a better hint.
  ConditionNames(const std::vector<Token>& tokens, const Positions& positions, const ConditionScope& scope,
                 const std::vector<std::string>& others, Diagnostics& out);

  /// A name with its members and subscripts, which begins at a token.
  struct Chain {
    Value value;
    std::size_t end = 0;  ///< the token behind it
  };
  /// nullptr: the token begins no chain.
  [[nodiscard]] const Chain* chain_at(std::size_t token) const;

  /// In the order of the text.
  [[nodiscard]] const std::vector<Reference>& references() const { return references_; }
  /// Whether the text declares names of its own (a lambda), so that nothing in it is certain.
  [[nodiscard]] bool declares_names() const { return declares_names_; }

 private:
  using Status = std::pair<std::string_view, Value::Kind>;
  struct Root;

  void read();
  void read_word(std::size_t at);
  void read_root(std::size_t at);
  [[nodiscard]] bool follows_member_mark(std::size_t at) const;
  [[nodiscard]] bool member_follows(std::size_t at) const;
  [[nodiscard]] bool is_behind_operand(std::size_t at) const;
  [[nodiscard]] bool is_template(std::size_t at) const;
  [[nodiscard]] Hint hint_for_word(std::string_view word) const;

  /// The members behind a buffer, memory cell or parameter of that type, from token `at`.
  Chain read_members(std::size_t begin, std::size_t at, Value value, std::string path,
                     const std::vector<Status>* statuses);
  bool read_member(std::size_t at, Value& value, std::string& path, const std::vector<Status>*& statuses);
  bool read_subscript(std::size_t& at, Value& value, const std::string& path);
  void unknown_member(const Token& member, const Value& value, const std::string& path,
                      const std::vector<Status>* statuses);
  /// Skips what follows something that is not known.
  [[nodiscard]] std::size_t skip_chain(std::size_t at) const;
  [[nodiscard]] std::size_t behind_bracket(std::size_t at) const;
  void unknown_name(const Token& name, const Root& root);
  [[nodiscard]] std::string other_home(std::string_view name) const;
  [[nodiscard]] bool holds_real(bool in) const;

  /// `in.request` of which there is one for each member of a fleet: what follows the name, from token `at`.
  Chain read_family(std::size_t begin, const Field& first, const std::vector<Status>* statuses);
  bool read_family_at(std::size_t at, const std::vector<Status>* statuses);
  bool read_member_number(std::size_t at);
  /// The index in brackets at a token, of a family; false: a mistake, which has been reported.
  bool check_index(std::size_t open, const Member& family, const std::string& path);
  /// any(in.request.fresh), all(...), count(...), which(...); false: the word begins none.
  bool read_quantifier(std::size_t at);
  [[nodiscard]] bool is_quantified(std::size_t at) const;
  /// Whether the subsystem has something of which there is one for each member of a fleet.
  [[nodiscard]] bool has_families() const;

  /// A value of a memory cell with few values; false: the word is none.
  bool read_value(std::size_t at);
  [[nodiscard]] const Field* cell_at(std::size_t at) const;
  [[nodiscard]] const Field* compared_cell(std::size_t at) const;
  [[nodiscard]] const Field* cell_with_value(std::string_view name) const;

  [[nodiscard]] Value value_of(const Type& type) const;
  [[nodiscard]] Value value_of(const Field& data) const;
  [[nodiscard]] Value value_of(const Parameter& parameter) const { return value_of(parameter.type); }
  void refer(Reference::Kind kind, std::string path, std::optional<std::uint32_t> target, const Token& at,
             StructureId structure = {});
  [[nodiscard]] Span span_of(const Token& token) const {
    return positions_.part(token.position, token.text.size());
  }

  const std::vector<Token>& tokens_;
  const Positions& positions_;
  const ConditionScope& scope_;
  const std::vector<std::string>& others_;
  Diagnostics& out_;
  std::map<std::size_t, Chain> chains_;
  std::vector<Reference> references_;
  bool declares_names_ = false;
};

}  // namespace tessera::spec
