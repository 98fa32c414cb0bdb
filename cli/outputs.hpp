#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Checks the files that a command is to write. An existing file is replaced only if it looks like an earlier
/// output of the same kind: `--json spec.yaml` must not destroy a specification. Devices and pipes accept
/// everything. All functions throw std::runtime_error that names the file.
namespace tessera::cli {

/// text: the text that is to be written, or its beginning.
void check_replaceable(const std::string& file, std::string_view text);
/// Checks `--record`: empty (no such option), a new file, or a recording.
void check_recording(const std::string& file);
/// Checks `--report`: empty (no such option), a new folder, or one whose index.html
/// and path.png are a report.
void check_report(const std::string& folder);

}  // namespace tessera::cli
