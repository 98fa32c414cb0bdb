#include "project/parameter_file.hpp"

#include <fmt/core.h>
#include <yaml-cpp/yaml.h>

#include <stdexcept>

namespace tessera::project {

namespace {

/// Collects the values of a file.
class ParameterReader {
 public:
  explicit ParameterReader(std::string file) : file_(std::move(file)) {}

  void read(const YAML::Node& node, const std::string& path) {
    if (node.IsMap()) {
      read_map(node, path);
    } else if (path.empty() && !node.IsNull()) {
      throw std::runtime_error(where(node.Mark()) +
                               "the file is no map: write one parameter per line, v: 0.1");
    } else if (node.IsScalar()) {
      given.push_back({path, node.Scalar(), where(node.Mark())});
    } else if (node.IsSequence()) {
      given.push_back({path, list(node, path), where(node.Mark())});
    } else if (!path.empty()) {
      throw std::runtime_error(where(node.Mark()) + path + " has no value");
    }
  }

  std::vector<GivenParameter> given;

 private:
  void read_map(const YAML::Node& node, const std::string& path) {
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) throw std::runtime_error(where(entry.first.Mark()) + "a name is no text");
      const std::string& name = entry.first.Scalar();
      const std::string whole = path.empty() ? name : path + "." + name;
      // A null has no position of its own.
      if (entry.second.IsNull())
        throw std::runtime_error(where(entry.first.Mark()) + whole + " has no value");
      read(entry.second, whole);
    }
  }

  [[nodiscard]] std::string list(const YAML::Node& node, const std::string& path) const {
    std::string text;
    for (const YAML::Node& item : node) {
      if (!item.IsScalar())
        throw std::runtime_error(where(item.Mark()) + path + ": an element is no value: write [1, 2, 3]");
      text += (text.empty() ? "" : ", ") + item.Scalar();
    }
    return "[" + text + "]";
  }

  [[nodiscard]] std::string where(const YAML::Mark& mark) const {
    return fmt::format("{}:{}:{}: ", file_, mark.line + 1, mark.column + 1);
  }

  std::string file_;
};

}  // namespace

std::vector<GivenParameter> read_parameter_file(const std::filesystem::path& file) {
  ParameterReader reader(file.string());
  try {
    reader.read(YAML::LoadFile(file.string()), "");
  } catch (const YAML::BadFile&) {
    throw std::runtime_error(file.string() + ": cannot be read");
  } catch (const YAML::Exception& problem) {
    throw std::runtime_error(fmt::format("{}:{}:{}: {}", file.string(), problem.mark.line + 1,
                                         problem.mark.column + 1, problem.msg));
  }
  return std::move(reader.given);
}

GivenParameter read_assignment(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw std::runtime_error(fmt::format("--set {}: expected PATH=VALUE", assignment));
  return {assignment.substr(0, equals), assignment.substr(equals + 1), ""};
}

}  // namespace tessera::project
