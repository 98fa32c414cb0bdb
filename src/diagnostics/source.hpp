#pragma once

#include <cstdint>
#include <filesystem>

#include "diagnostics/diagnostics.hpp"

namespace tessera::diagnostics {

inline constexpr std::uintmax_t largest_source = std::uintmax_t{64} * 1024 * 1024;

/// Reads a source file from disk. A file that cannot be read gives an empty text and one error.
///
/// Errors: E001 the file does not exist, is a directory or a device, must not be read, or is larger
///         than largest_source bytes.
[[nodiscard]] Diagnostics load(const std::filesystem::path& path);

}  // namespace tessera::diagnostics
