#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Files that a user names for what a command writes. What is there already is replaced only if it looks like
/// an earlier output of the same kind: `--json spec.yaml` must not cost anybody a specification. Devices and
/// pipes take everything. All throw std::runtime_error that names the file.
namespace tessera::cli {

/// text: what is to be written, or how it begins.
void check_replaceable(const std::string& file, std::string_view text);
/// Of `--record`: empty (no such option), a new file, or a recording.
void check_recording(const std::string& file);
/// Of `--report`: empty (no such option), a new folder, or one whose index.html and path.png are of a report.
void check_report(const std::string& folder);

}  // namespace tessera::cli
