#include "sim/mjcf/document.hpp"

#include <strings.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "sim/mjcf/limits.hpp"

namespace tessera::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_bytes = 64 << 20;
/// The engine reads elements recursively.
constexpr int deepest_element = 200;

Result<std::string> content_of(const fs::path& file) {
  std::error_code none;
  if (!fs::exists(file, none)) return Problem{file.string() + ": there is no such file"};
  if (!fs::is_regular_file(file, none)) return Problem{file.string() + ": is not a file"};
  if (fs::file_size(file, none) > most_bytes) return Problem{file.string() + ": is larger than 64 MB"};
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Problem{file.string() + ": cannot be read"};
  if (text.view().empty()) return Problem{file.string() + ": is empty"};
  return std::move(text).str();
}

Result<DocumentPtr> parsed(const fs::path& file) {
  const Result<std::string> text = content_of(file);
  if (!text) return Problem{text.problem()};
  auto document = std::make_unique<pugi::xml_document>();
  const pugi::xml_parse_result result =
      document->load_buffer(text->data(), text->size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    const auto end = text->begin() + std::min<std::ptrdiff_t>(result.offset, std::ssize(*text));
    return Problem{file.string() + ":" + std::to_string(1 + std::count(text->begin(), end, '\n')) +
                   ": no well-formed XML: " + result.description()};
  }
  return document;
}

class Includer {
 public:
  explicit Includer(fs::path file) : file_(std::move(file)) {}

  [[nodiscard]] std::optional<Problem> resolve(pugi::xml_node parent, int depth) {
    if (depth > deepest_element)
      return Problem{file_.string() + ": elements stand in one another more than " +
                     std::to_string(deepest_element) + " deep"};
    for (pugi::xml_node child = parent.first_child(); child;) {
      // The engine ignores the case of this one name.
      if (strcasecmp(child.name(), "include") == 0) {
        const pugi::xml_node first = replace(child);
        if (!problem_.text.empty()) return problem_;
        child = first;
        continue;
      }
      if (auto problem = resolve(child, depth + 1)) return problem;
      child = child.next_sibling();
    }
    return std::nullopt;
  }

 private:
  /// Returns the first element that replaces the include.
  pugi::xml_node replace(pugi::xml_node include) {
    const std::string name = include.attribute("file").value();
    if (name.empty()) return fail("an <include> names no file");
    const fs::path file = file_.parent_path() / name;
    if (!included_.insert(file.lexically_normal().string()).second || file.lexically_normal() == file_)
      return fail("the file '" + name + "' is included twice, or includes itself");
    const Result<DocumentPtr> document = parsed(file);
    if (!document) return fail("an <include> fails: " + document.problem());
    pugi::xml_node parent = include.parent(), first;
    for (const pugi::xml_node element : (*document)->document_element().children()) {
      const pugi::xml_node copy = parent.insert_copy_before(element, include);
      if (!first) first = copy;
    }
    if (!first) return fail("the included file '" + name + "' has no elements");
    parent.remove_child(include);
    return first;
  }
  pugi::xml_node fail(const std::string& why) {
    problem_ = Problem{file_.string() + ": " + why};
    return {};
  }

  fs::path file_;
  std::set<std::string> included_;
  Problem problem_;
};

std::optional<Problem> wrong_root(const std::string& file, std::string_view root) {
  if (root == "mujoco") return std::nullopt;
  if (root == "robot") return Problem{file + ": is a URDF file; it must be converted to MJCF first"};
  if (root == "mujocoinclude") return Problem{file + ": is a part for an <include>, no model of its own"};
  return Problem{file + ": is no MJCF file: it begins with <" + std::string(root) + ">, not with <mujoco>"};
}

}  // namespace

Result<DocumentPtr> read_document(const std::string& file) {
  Result<DocumentPtr> document = parsed(fs::path(file).lexically_normal());
  if (!document) return document;
  const pugi::xml_node root = (*document)->document_element();
  if (auto problem = wrong_root(file, root.name())) return *std::move(problem);
  if (auto problem = Includer(fs::path(file).lexically_normal()).resolve(root, 1)) return *std::move(problem);
  if (auto problem = unusable_number(root)) return Problem{file + ": " + problem->text};
  return document;
}

}  // namespace tessera::sim
