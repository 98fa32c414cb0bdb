#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "language/edits/text_editor.hpp"
#include "language/language.hpp"

/// Edits of the parts of a specification that consist of more than one entry.
namespace tessera::language {

using Fields = std::map<std::string, std::string>;

/// The element at a path, and the channels, drivers, placed models and processes that cannot be without it. Properties
/// and checks stay, for the user to judge.
[[nodiscard]] std::vector<Path> to_remove(const Document& document, const TextEditor& editor, const Path& at);

/// A channel as an item of `channels`: in short form if that can express it.
[[nodiscard]] std::string channel_text(const Fields& fields);
/// Changes some fields of the channel `at`.
[[nodiscard]] Changes change_channel(const TextEditor& editor, const Path& at, const Fields& change);

/// The entries of `next` of a behaviour: it is one entry, or a list of them.
[[nodiscard]] std::vector<Path> next_entries(const TextEditor& editor, const Path& behaviour);
/// Adds an entry after the others.
[[nodiscard]] std::string with_next(const TextEditor& editor, const Path& behaviour, const Fields& entry);
/// Changes fields of an entry; an empty `when` removes its condition, an empty `to` the entry.
[[nodiscard]] std::string changed_next(const TextEditor& editor, const Path& behaviour, std::size_t at,
                                       const Fields& change);

/// Moves the subsystems of an agent to a template of the same name. nullopt: the text would have to be laid
/// out anew, or has anchors and aliases, whose order counts.
[[nodiscard]] std::optional<std::string> with_template(const TextEditor& editor, const Path& agent);

}  // namespace tessera::language
