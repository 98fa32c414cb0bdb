#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "spec/model/model.hpp"

/// C++ as text, laid out as .clang-format of the generated folder asks for, so that no formatter has to run.
namespace tessera::codegen {

/// Columns of a generated line.
inline constexpr std::size_t column_limit = 110;

/// "std::array<Velocity, 3>". Structures in `hidden` are qualified by the namespace `system`, because
/// something nearer has the same name.
[[nodiscard]] std::string type_name(const spec::Model& model, const spec::Type& type,
                                    const std::set<std::string_view>& hidden = {});

/// Adds the headers that `type` needs: "<array>", "<cstdint>", "<tessera/bounded_string.hpp>".
void add_headers(const spec::Type& type, std::set<std::string>& headers);

/// #include lines of one block, sorted, and the empty line behind them; nothing for an empty set.
[[nodiscard]] std::string include_block(const std::set<std::string>& headers);

/// "200ms": the largest unit that keeps the value whole.
[[nodiscard]] std::string duration(spec::Duration value);

/// "\"text\"", escaped.
[[nodiscard]] std::string string_literal(std::string_view text);

/// The expression of a condition in C++, line by line as in the file: durations have no blank, and a number in a
/// unit of time that stands beside a duration is a duration of floating-point numbers.
[[nodiscard]] std::string condition_text(const spec::Expression& expression);

/// `text` as it may stand in a one-line comment.
[[nodiscard]] std::string comment_text(std::string_view text);

/// A declaration with an optional comment behind it.
struct Declaration {
  std::string code;
  std::string comment;
};

/// One line each; the comments of neighbours are aligned.
[[nodiscard]] std::string declarations(const std::vector<Declaration>& lines, std::size_t indent = 2);

/// "struct NAME {...};" with the declarations, "struct NAME {};" without.
[[nodiscard]] std::string structure(std::string_view name, const std::vector<Declaration>& members,
                                    std::string_view tail = {});

/// "PREFIX { a, b };", or one name per line where that is too long for one.
[[nodiscard]] std::string enumeration(std::string_view prefix, const std::vector<std::string_view>& names);

/// A member function whose body is `statements`, each without indentation: on one line where it fits.
[[nodiscard]] std::string member_function(std::string_view head, const std::vector<std::string>& statements);

/// Returns the file unchanged, unless a line exceeds the column limit because of long names. Then
/// clang-format is switched off for the whole file.
[[nodiscard]] std::string keep_formatter_off_long_lines(std::string text);

}  // namespace tessera::codegen
