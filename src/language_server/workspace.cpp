#include "language_server/workspace.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "project/build/user_sources.hpp"
#include "project/files/file_names.hpp"
#include "project/files/files.hpp"

namespace tessera::language_server {

namespace fs = std::filesystem;

fs::path path_of(const std::string& uri) {
  constexpr std::string_view scheme = "file://";
  if (!uri.starts_with(scheme)) return {};
  std::string path;
  std::size_t at = std::min(uri.find('/', scheme.size()), uri.size());
  for (; at < uri.size(); ++at) {
    int code = 0;
    const bool escaped =
        uri[at] == '%' && at + 2 < uri.size() &&
        std::from_chars(uri.data() + at + 1, uri.data() + at + 3, code, 16).ptr == uri.data() + at + 3;
    path += escaped ? static_cast<char>(code) : uri[at];
    if (escaped) at += 2;
  }
  return path;
}

std::string escaped(std::string_view text) {
  std::string uri;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("/-._~").find(c) != std::string_view::npos;
    if (plain) {
      uri += c;
      continue;
    }
    constexpr std::string_view digits = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    uri += {'%', digits[byte >> 4U], digits[byte & 15U]};
  }
  return uri;
}

std::string uri_of(const fs::path& path) { return "file://" + escaped(path.string()); }

namespace {

bool has_key(const std::string& text, std::string_view key) {
  const std::string line = std::string(key) + ":";
  return text.starts_with(line) || text.find("\n" + line) != std::string::npos;
}

/// A file that specifications include says nothing of agents. It is checked with them, not alone.
bool is_included_part(const fs::path& file, const std::string& text) {
  return file.filename() != project::file_names::specification &&
         (has_key(text, "types") || has_key(text, "templates")) && !has_key(text, "system") &&
         !has_key(text, "agents");
}

}  // namespace

bool Workspace::is_specification(const fs::path& file, const std::string& text) const {
  if (project::is_code(file)) return false;
  if (is_included_part(file, text)) return false;
  std::string first;
  std::size_t at = 0;
  for (int line = 0; line < 50 && at < text.size(); ++line) {
    if (text.compare(at, 8, "tessera:") == 0) return true;
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (first.empty() && text[at] != '#' && text[at] != '-' && text[at] != '%') {
      first = text.substr(at, std::min(text.find(':', at), end) - at);
      first.erase(first.find_last_not_of(" \t\r") + 1);
    }
    at = std::min(end, text.size() - 1) + 1;
  }
  if (file.filename() != project::file_names::specification) return false;
  const std::vector<language::Grammar::Key> keys = grammar_.keys({});
  return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return key.name.starts_with(first); });
}

void Workspace::open(Open document) {
  const std::string uri = document.uri;
  open_[uri] = std::move(document);
}

Workspace::Open* Workspace::find(const std::string& uri) {
  const auto found = open_.find(uri);
  return found == open_.end() ? nullptr : &found->second;
}

std::string Workspace::text_of(const fs::path& file) const {
  for (const auto& [uri, document] : open_)
    if (path_of(uri) == file) return document.text;
  return project::content_of(file);
}

std::shared_ptr<const language::Document> Workspace::analysed(const std::string& uri, std::string text) {
  auto& kept = analysed_[uri];
  if (kept == nullptr || kept->text() != text)
    kept = std::make_shared<const language::Document>(std::move(text), grammar_, path_of(uri).parent_path());
  return kept;
}

std::optional<Workspace::Specification> Workspace::specification_of(const std::string& uri) {
  const fs::path file = path_of(uri);
  if (const Open* document = find(uri); document != nullptr && !project::is_code(file)) {
    if (!is_specification(file, document->text)) return std::nullopt;
    return Specification{uri, file.parent_path(), analysed(uri, document->text)};
  }
  fs::path folder = file.parent_path();
  for (int level = 0; level < 32 && !folder.empty(); ++level) {
    const fs::path candidate = folder / project::file_names::specification;
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) {
      std::string known = uri_of(candidate);
      for (const auto& [open, document] : open_)
        if (path_of(open) == candidate) known = open;
      return Specification{known, folder, analysed(known, text_of(candidate))};
    }
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  return std::nullopt;
}

std::vector<language::Source> Workspace::sources_of(const fs::path& folder) const {
  std::vector<language::Source> sources;
  for (const fs::path& file : project::files_with_names(folder)) {
    std::string uri = uri_of(file);
    for (const auto& [open, document] : open_)
      if (path_of(open) == file) uri = open;
    sources.push_back({std::move(uri), text_of(file)});
  }
  return sources;
}

}  // namespace tessera::language_server
