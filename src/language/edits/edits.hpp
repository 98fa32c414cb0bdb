#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "language/edits/text_editor.hpp"
#include "language/language.hpp"

/// Edits of a specification: what a form, a drawing or a command does with one of its parts.
namespace tessera::language {

struct Edit {
  enum class Kind : std::uint8_t {
    set,      ///< `key` of the map `at` to `text`; an empty text removes it
    insert,   ///< `key: value` into the map `at`
    append,   ///< `value` to the list `at`
    replace,  ///< the value `at` by `value`, in one line
    remove,   ///< what is `at`, and what needs it
    rename,   ///< what is `at` to `text`
    connect,  ///< a channel with `fields`: from, to, send, receive, timeout
    channel,  ///< some of the same fields, or model, of the channel `at`
    next,     ///< `fields` to, when and sets of the entry `key` of the behaviour `at`; no key: a new one
    make_template,  ///< of the agent `at`
    move,           ///< the behaviour `at` to the group `text`, "charge.dock"; empty: to the subsystem itself
    copy,           ///< what is `at`, behind it, under the name `key`
    paste,          ///< the one entry of the text `text`, into the map `at`, under the name `key`
  } kind = Kind::set;
  Path at;
  std::string key;
  std::string text;
  Writing as = Writing::scalar;
  Value value;
  std::map<std::string, std::string> fields;
};

/// Does the edits one after the other. Comments, order and style of everything else stay, and so do aliases: a rename
/// changes what they stand for. A rename also changes `sources`.
///
/// Shape:  linear in the text for each edit; a removal for each part that goes.
/// Errors: `problem` says why it cannot be done; then there are no edits. An edit is refused if an alias would lose its
///         anchor, if a text that can be read could not be read any more, and if a rename would bring a new error.
/// Threads: pure.
[[nodiscard]] Renaming edit(const Document& document, std::span<const Edit> edits,
                            std::span<const Source> sources);

/// The path of a name in words: "robot.control.follow", "input:robot.control.line" (or output, real, memory, parameter,
/// type, template, model) if others have the same. Its position; or why there is none.
struct Named {
  std::optional<Position> position;
  std::string problem;
};
[[nodiscard]] Named find_name(const Document& document, std::string_view name);

}  // namespace tessera::language
