#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/definitions/message_parser.hpp"
#include "ros2/definitions/type.hpp"

namespace tessera::ros2 {

/// A source of definitions.
class Definitions {
 public:
  struct Text {
    std::string text, file;
  };
  virtual ~Definitions() = default;
  /// name: "geometry_msgs/msg/Twist", "std_srvs/srv/SetBool", "nav2_msgs/action/NavigateToPose". nullopt: there
  /// is no such definition.
  [[nodiscard]] virtual std::optional<Text> find(const std::string& name) const = 0;
  /// All names, for hints.
  [[nodiscard]] virtual std::vector<std::string> names() const = 0;
  /// How a definition comes here that is missing, for hints. file: "nav2_msgs/action/NavigateToPose.action".
  [[nodiscard]] virtual std::string remedy(const std::string& file) const;
};

/// Folders with PACKAGE/msg/NAME.msg, PACKAGE/srv/NAME.srv and PACKAGE/action/NAME.action; the first folder
/// that has a file wins: that of a project, those of installations of ROS 2, that of Tessera. A single folder is
/// that of Tessera. In an installation, packages count that its index lists: definitions of ROS 1 may lie beside
/// them.
class DefinitionFolders : public Definitions {
 public:
  explicit DefinitionFolders(const std::vector<std::filesystem::path>& folders);
  [[nodiscard]] std::optional<Text> find(const std::string& name) const override;
  [[nodiscard]] std::vector<std::string> names() const override;
  [[nodiscard]] std::string remedy(const std::string& file) const override;
  /// Those of installations alone.
  [[nodiscard]] DefinitionFolders of_installations() const;
  [[nodiscard]] bool empty() const { return folders_.empty(); }

 private:
  struct Folder {
    std::filesystem::path path;
    bool is_installation = false;
    [[nodiscard]] bool has(const std::string& package) const;
  };
  std::vector<Folder> folders_;
};

/// One text with a message and everything that it uses, in the form of ROS 2 recordings: the definition of
/// the message, then for each other one a line of 80 '=', a line "MSG: geometry_msgs/Vector3" and its
/// definition.
class DefinitionBundle : public Definitions {
 public:
  DefinitionBundle(std::string name, std::string_view text);
  [[nodiscard]] std::optional<Text> find(const std::string& name) const override;
  [[nodiscard]] std::vector<std::string> names() const override;

 private:
  std::vector<std::pair<std::string, std::string>> messages_;
};

/// The folders with definitions of the installations of ROS 2 that a value of AMENT_PREFIX_PATH names, the setup
/// files of which set it: "/opt/ros/jazzy:/home/me/ws/install/my_msgs".
[[nodiscard]] std::vector<std::filesystem::path> folders_of_installations(std::string_view ament_prefix_path);

/// Whether two definitions have the same fields, and so the same bytes. Constants and defaults do not count.
[[nodiscard]] bool have_same_bytes(const Structure& a, const Structure& b);

/// Reads a message and everything that it uses. nullptr after mistakes: unknown messages, wrong definitions,
/// a message that contains itself.
[[nodiscard]] std::shared_ptr<const Structure> resolve(const std::string& name,
                                                       const Definitions& definitions,
                                                       std::vector<Mistake>& mistakes);

/// Both messages of a service.
struct ResolvedService {
  std::shared_ptr<const Structure> request, response;
};
/// The same for a service, "std_srvs/srv/SetBool".
[[nodiscard]] std::optional<ResolvedService> resolve_service(const std::string& name,
                                                             const Definitions& definitions,
                                                             std::vector<Mistake>& mistakes);

/// The messages of an action, "nav2_msgs/action/NavigateToPose", as buffers have them.
struct ResolvedAction {
  std::shared_ptr<const Structure> goal;
  /// Two fields, `feedback` and `result`, because one buffer takes both. Such a message exists nowhere else.
  std::shared_ptr<const Structure> progress;
};
[[nodiscard]] std::optional<ResolvedAction> resolve_action(const std::string& name,
                                                           const Definitions& definitions,
                                                           std::vector<Mistake>& mistakes);

/// The text of DefinitionBundle.
[[nodiscard]] std::string bundle_of(const Structure& message);

}  // namespace tessera::ros2
