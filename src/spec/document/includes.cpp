#include "spec/document/includes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "diagnostics/source.hpp"
#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/document/text_checks.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

namespace fs = std::filesystem;
using diagnostics::in_quotes;

constexpr std::array sections = std::to_array<std::string_view>({"types", "templates"});
constexpr const char* file_hint =
    "name a file in the folder of the specification, relative to this one: include: parts/docking.yaml";

const Entry* entry_in(const Node& map, std::string_view key) {
  const auto found = std::ranges::find(map.entries, key, &Entry::key);
  return found == map.entries.end() ? nullptr : &*found;
}

bool is_section(std::string_view key) { return std::ranges::find(sections, key) != sections.end(); }

/// "type" or "template"
std::string one_of(const std::string& section) { return section.substr(0, section.size() - 1); }

void refuse_key(const Entry& entry, const std::string& main, Diagnostics& out) {
  Hint hint = did_you_mean(entry.key, {"tessera", "types", "templates", "include"});
  if (hint.empty())
    hint = "an included file holds 'types', 'templates' and 'include'; write " + in_quotes(entry.key) +
           " in " + main;
  out.error("E359", entry.span, in_quotes(entry.key) + " does not belong in an included file",
            std::move(hint));
}

}  // namespace

void check_version(const Entry& version, Diagnostics& out) {
  const Node* text = text_of(*version.value, version.span, "'tessera'", out, "write tessera: 1");
  if (text != nullptr && (text->text != "1" || text->quoted)) {
    out.error("E108", text->span, "version " + in_quotes(text->text) + " of the format is unknown",
              "this program reads version 1: write tessera: 1");
  }
}

const Node& Includes::whole(const Document& main, Diagnostics& out) {
  const Node& root = main.root();
  const Entry* include = root.is_map() ? entry_in(root, "include") : nullptr;
  if (include == nullptr) return root;
  if (out.folder().empty()) {
    refuse("E361", include->span, "this text has no folder in which the included files could be found",
           "save it in a file", out);
    return root;
  }
  const fs::path own = fs::path(out.file()).filename();
  chain_.push_back(own.string());
  read_list(*include, own, out);
  Node& made = nodes_.emplace_back(root);
  for (const std::string_view key : sections) {
    const Entry* section = entry_in(root, key);
    const auto found = collected_.find(std::string(key));
    if (found == collected_.end()) continue;
    const bool is_wrong = section != nullptr && !section->value->is_map() && !section->value->is_null();
    if (is_wrong) continue;  // whoever reads the section says so
    if (section != nullptr) collect(*section, out);
    Node& all = nodes_.emplace_back();
    all.kind = Node::Kind::map;
    all.span = section != nullptr ? section->value->span : include->span;
    all.entries = found->second.entries;
    if (section == nullptr) {
      made.entries.push_back({std::string(key), include->span, &all});
    } else {
      std::ranges::find(made.entries, key, &Entry::key)->value = &all;
    }
  }
  return made;
}

void Includes::refuse(std::string code, Span at, std::string message, Hint hint, Diagnostics& out) {
  complete_ = false;
  out.error(std::move(code), at, std::move(message), std::move(hint));
}

void Includes::read_list(const Entry& include, const Path& from, Diagnostics& out) {
  const Node& value = *include.value;
  if (value.is_sequence()) {
    for (const Node* name : value.items)
      if (const Node* text = text_of(*name, name->span, "an included file", out, file_hint))
        read_file(*text, from, out);
  } else if (const Node* text = text_of(value, include.span, "'include'", out, file_hint)) {
    read_file(*text, from, out);
  }
}

void Includes::read_file(const Node& name, const Path& from, Diagnostics& out) {
  const fs::path written = name.text;
  const fs::path file = (from.parent_path() / written).lexically_normal();
  const bool leaves = !file.empty() && *file.begin() == "..";
  if (written.is_absolute() || leaves || !file.has_filename() || name.text.find('\0') != std::string::npos) {
    refuse("E356", name.span,
           written.is_absolute() ? in_quotes(name.text) + " is an absolute path"
           : leaves              ? in_quotes(name.text) + " is outside the folder of the specification"
                                 : in_quotes(name.text) + " names no file",
           file_hint, out);
    return;
  }
  const std::string shown = file.generic_string();
  if (const auto first = std::ranges::find(chain_, shown); first != chain_.end()) {
    std::string circle;
    for (auto one = first; one != chain_.end(); ++one) circle += *one + " -> ";
    refuse("E358", name.span, "files include each other in a circle: " + circle + shown,
           "leave out one of these; move what both need into a file of its own", out);
    return;
  }
  if (!read_.insert(file).second) return;
  // A file that cannot be read is one of the source, too: its meaning changes once it can.
  const auto refuse_unread = [&](const std::string& message, Hint hint) {
    out.include(shown, "");
    refuse("E357", name.span, message, std::move(hint), out);
  };
  std::error_code ignored;
  const fs::path path = out.folder() / file;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    refuse_unread("the included file " + in_quotes(shown) + " is no file", file_hint);
    return;
  }
  diagnostics::Diagnostics part = diagnostics::load(path);
  if (part.has_errors()) {
    const diagnostics::Diagnostic why = part.sorted().front();
    refuse_unread("the included file " + in_quotes(shown) + " cannot be read: " + why.message,
                  why.hint.empty() ? "the path is relative to " + chain_.back() : Hint(why.hint));
    return;
  }
  bytes_ += part.text().size();
  if (bytes_ > diagnostics::largest_source) {
    refuse_unread("the included files are larger than 64 MB together", {});
    return;
  }
  std::optional<Document> document;
  if (check_text(part)) document = read_document(part, "write 'types' or 'templates' in it");
  const std::uint32_t before = out.include(shown, part.text());
  out.adopt(part, before);
  if (!document) complete_ = false;
  if (!document) return;
  Document& kept = documents_.emplace_back(std::move(*document));
  kept.shift(before);
  chain_.push_back(shown);
  read_part(kept.root(), file, out);
  chain_.pop_back();
}

void Includes::read_part(const Node& root, const Path& file, Diagnostics& out) {
  for (const Entry& entry : entries_of(root, root.span, "an included file", out)) {
    if (entry.key == "tessera") {
      check_version(entry, out);
    } else if (entry.key == "include") {
      read_list(entry, file, out);
    } else if (is_section(entry.key)) {
      collect(entry, out);
    } else {
      refuse_key(entry, chain_.front(), out);
    }
  }
}

void Includes::collect(const Entry& section, Diagnostics& out) {
  Collected& all = collected_[section.key];
  for (const Entry& entry : entries_of(*section.value, section.span, section.key, out)) {
    const auto [first, added] = all.spans.emplace(entry.key, entry.span);
    if (added) {
      all.entries.push_back(entry);
      continue;
    }
    out.error("E360", entry.span,
              one_of(section.key) + " " + in_quotes(entry.key) + " is defined in two files",
              "the first is on " + out.words(first->second) + "; keep one of them");
  }
}

}  // namespace tessera::spec
