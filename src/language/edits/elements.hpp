#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "language/edits/text_editor.hpp"
#include "language/language.hpp"

/// Edits of the parts of a specification that consist of more than one entry.
namespace tessera::language {

using Fields = std::map<std::string, std::string>;

/// Removes the element at a path, and the channels, drivers, placed models and processes that cannot be without it.
/// Properties and checks stay, for the user to judge. editor: has the text of the document.
bool remove_with_uses(const Document& document, TextEditor& editor, const Path& at);

/// Why the element at a path has to stay: an `on_error` of the agent or of the system names this behaviour. nullopt: it
/// may go.
[[nodiscard]] std::optional<std::string> needed_by(const Document& document, const TextEditor& editor,
                                                   const Path& at);

/// A channel as an item of `channels`: in short form if that can express it.
[[nodiscard]] std::string channel_text(const Fields& fields);
/// Changes some fields of the channel `at`.
bool change_channel(TextEditor& editor, const Path& at, Fields change);

/// The entries of `next` of a behaviour, which is one entry or a list of them.
[[nodiscard]] std::vector<Path> next_entries(const TextEditor& editor, const Path& behaviour);
/// Adds an entry to `next` of a behaviour, which is one entry or a list of them.
bool add_next(TextEditor& editor, const Path& behaviour, const Fields& entry);
/// Changes fields of an entry; an empty `when` removes its condition, an empty `to` the entry.
bool change_next(TextEditor& editor, const Path& behaviour, std::size_t at, const Fields& change);

/// Moves the subsystems of an agent to a template of the same name. false: the text would have to be laid out anew, or
/// has anchors and aliases, whose order counts.
bool make_template(TextEditor& editor, const Path& agent);

/// Moves a behaviour or group to another group of its subsystem, with its comments. group: its path, "charge.dock";
/// empty: the subsystem itself. The names of it elsewhere stay, for the user to judge.
///
/// Returns why it cannot be done; nullopt: it is moved.
std::optional<std::string> move_to_group(TextEditor& editor, const Path& behaviour, const std::string& group);

/// Copies what is `at`, with its comments, to the lines behind it, under a new name. A copy that names itself (a
/// behaviour in its own `next`) has the new name there. Anchors in it get new names. With an agent, the channels between
/// its own subsystems are copied; those to other agents, drivers and placed models are not.
///
/// Returns why it cannot be done; nullopt: it is copied.
std::optional<std::string> copy_element(const Document& document, TextEditor& editor, const Path& at,
                                        const std::string& name);

/// Adds the one entry of a text, with the comments above it, to the end of the map `map`, under a new name. The map is
/// made if it is not there.
///
/// Returns why it cannot be done; nullopt: it is added.
std::optional<std::string> paste_element(TextEditor& editor, const Path& map, const std::string& name,
                                         const std::string& text);

}  // namespace tessera::language
