#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Reads and writes whole files.
namespace tessera::project {

/// Empty if the file cannot be read.
[[nodiscard]] std::string content_of(const std::filesystem::path& file);

/// Replaces a file as a whole, and makes its folder. A reader sees either the old text or the new one. If
/// the disk is full, the old text stays. Follows a symbolic link; keeps the mode of a file that exists.
///
/// Errors:  throws std::runtime_error with the path and the reason.
/// Threads: any.
void write_file(const std::filesystem::path& file, std::string_view text);

/// Copies bytes and mode. Replaces `to`, which is removed again if it cannot be written whole.
///
/// Errors:  throws std::runtime_error with the path and the reason, such as a full disk.
/// Threads: any.
void copy_whole(const std::filesystem::path& from, const std::filesystem::path& to);

/// All of it. false: errno says why.
[[nodiscard]] bool write_all(int descriptor, std::string_view text);

/// The identity of a text: 32 hexadecimal digits.
[[nodiscard]] std::string hash_of(std::string_view text);

/// Whether no part of the path is a symbolic link: from `folder`, which may be
/// one, down to folder/relative.
[[nodiscard]] bool is_inside(const std::filesystem::path& folder, const std::filesystem::path& relative);

/// Whether `path` is that folder or in it, once symbolic links are followed. Neither has to exist.
[[nodiscard]] bool contains(const std::filesystem::path& folder, const std::filesystem::path& path);

}  // namespace tessera::project
