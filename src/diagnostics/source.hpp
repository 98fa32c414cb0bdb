#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace tessera::diagnostics {

inline constexpr std::uintmax_t largest_source = std::uintmax_t{64} * 1024 * 1024;

/// Reads a source file from disk. A file that cannot be read gives an empty text and one error.
///
/// Errors: E001 the file does not exist, is a directory or a device, must not be read, or is larger
///         than largest_source bytes.
[[nodiscard]] Diagnostics load(const std::filesystem::path& path);

/// Whether a text is XML, whatever its file is called: it begins with "<?", "<!" or an element. "<<:", a key of YAML,
/// is none of them.
[[nodiscard]] bool is_xml(std::string_view text);

/// The same of a file on disk. false: it cannot be read, or is no regular file.
[[nodiscard]] bool is_xml_file(const std::filesystem::path& path);

}  // namespace tessera::diagnostics
