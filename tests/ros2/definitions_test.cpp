#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "ros2/definitions/resolver.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::ros2 {
namespace {

namespace fs = std::filesystem;

std::string mistakes_of(const std::string& text) {
  std::vector<Mistake> mistakes;
  EXPECT_FALSE(parse_message("pkg/msg/Some", text, "Some.msg", mistakes).has_value()) << text;
  std::string all;
  for (const Mistake& one : mistakes) all += one.shown() + "\n";
  return all;
}

TEST(Definitions, HaveAllThatRos2Permits) {
  std::vector<Mistake> mistakes;
  const auto message = parse_message("pkg/msg/Some", R"(# a comment
bool on true
byte raw 0xff
char letter 65
int8 low -128
uint64 high 18446744073709551615
float32 half .5          # a comment behind
float64[] list [1, -2.5, 3e2]
float64[2] two [1, 2]
int32[<=4] few
string plain hello there
string quoted "a # in \"quotes\""
string<=5 short 'abc'
string[] words ["a, b", 'c']
Other other
geometry_msgs/Point[3] points
geometry_msgs/msg/Point point
uint8 LEFT=1
string NAME = what a name
int16 MASK=0b101
)",
                                     "Some.msg", mistakes);
  for (const Mistake& one : mistakes) ADD_FAILURE() << one.shown();
  ASSERT_TRUE(message.has_value());
  ASSERT_EQ(message->fields.size(), 16U);
  ASSERT_EQ(message->constants.size(), 3U);
  EXPECT_EQ(std::get<std::uint64_t>(message->find("high")->defaults.at(0)), ~std::uint64_t{0});
  EXPECT_EQ(std::get<std::int64_t>(message->find("low")->defaults.at(0)), -128);
  EXPECT_EQ(std::get<double>(message->find("list")->defaults.at(2)), 300);
  EXPECT_EQ(std::get<std::string>(message->find("plain")->defaults.at(0)), "hello there");
  EXPECT_EQ(std::get<std::string>(message->find("quoted")->defaults.at(0)), "a # in \"quotes\"");
  EXPECT_EQ(std::get<std::string>(message->find("words")->defaults.at(0)), "a, b");
  EXPECT_EQ(message->find("words")->defaults.size(), 2U);
  EXPECT_EQ(message->find("short")->type.string_bound, 5U);
  EXPECT_EQ(message->find("other")->type.refers, "pkg/msg/Other");
  EXPECT_EQ(message->find("points")->type.text(), "geometry_msgs/Point[3]");
  EXPECT_EQ(message->find("point")->type.refers, "geometry_msgs/msg/Point");
  EXPECT_EQ(std::get<std::string>(message->constants[1].value), "what a name");
}

TEST(Definitions, MistakesHaveTheirLine) {
  EXPECT_EQ(mistakes_of("int32 a\nflaot64 b\n"),
            "Some.msg:2: unknown type 'flaot64'; did you mean 'float64'?\n");
  EXPECT_EQ(mistakes_of("int8 a 200"), "Some.msg:1: '200' is no value of the type int8\n");
  EXPECT_EQ(mistakes_of("uint8 a -1"), "Some.msg:1: '-1' is no value of the type uint8\n");
  EXPECT_EQ(mistakes_of("int32 Bad"),
            "Some.msg:1: 'Bad' is no name of a field; write it in small letters: bad\n");
  EXPECT_EQ(mistakes_of("time at"),
            "Some.msg:1: unknown type 'time', which only ROS 1 has; a definition of ROS 2 "
            "has builtin_interfaces/Time\n");
  EXPECT_EQ(mistakes_of("int32 a\nint32 a"), "Some.msg:2: there is a 'a' already\n");
  EXPECT_EQ(mistakes_of("int32[] a 3"),
            "Some.msg:1: the default of an array is a list in brackets, not '3'\n");
  EXPECT_EQ(mistakes_of("int32[2] a [1]"), "Some.msg:1: the default has 1 elements\n");
  EXPECT_EQ(mistakes_of("int32[x] a"), "Some.msg:1: '[x]' is no size of an array; write [], [8] or [<=8]\n");
  EXPECT_EQ(mistakes_of("string<=2 a \"abc\""), "Some.msg:1: the default is longer than the string\n");
  EXPECT_EQ(mistakes_of("int32"), "Some.msg:1: a field needs a name: 'int32'\n");
  EXPECT_EQ(mistakes_of("int32 low=3"),
            "Some.msg:1: 'low' is no name of a constant; write it in capital letters: TO_THE_LEFT\n");
}

TEST(Definitions, OfAServiceAreTwo) {
  std::vector<Mistake> mistakes;
  const auto service =
      parse_service("pkg/srv/Add", "int64 a\nint64 b\n---  # and back\nint64 sum\n", "Add.srv", mistakes);
  ASSERT_TRUE(service.has_value());
  EXPECT_EQ(service->request.name, "pkg/srv/Add_Request");
  EXPECT_EQ(service->request.fields.size(), 2U);
  EXPECT_EQ(service->response.fields.size(), 1U);
  EXPECT_FALSE(parse_service("pkg/srv/Add", "int64 a\n---\nint64", "Add.srv", mistakes).has_value());
  EXPECT_EQ(mistakes.back().shown(), "Add.srv:3: a field needs a name: 'int64'");
  EXPECT_FALSE(parse_service("pkg/srv/Add", "int64 a\n", "Add.srv", mistakes).has_value());
}

TEST(Definitions, ThatComeWithTesseraAreWhole) {
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  const auto names = folders.names();
  EXPECT_GT(names.size(), 80U);
  for (const std::string& name : names) {
    std::vector<Mistake> mistakes;
    if (is_service_type(name)) {
      EXPECT_TRUE(resolve_service(name, folders, mistakes).has_value()) << name;
      continue;
    }
    if (is_action_type(name)) {
      EXPECT_TRUE(resolve_action(name, folders, mistakes).has_value()) << name;
      continue;
    }
    const auto message = resolve(name, folders, mistakes);
    for (const Mistake& one : mistakes) ADD_FAILURE() << one.shown();
    ASSERT_NE(message, nullptr) << name;
    const auto again = resolve(name, DefinitionBundle(name, bundle_of(*message)), mistakes);
    ASSERT_NE(again, nullptr) << name << "\n" << bundle_of(*message);
    EXPECT_EQ(bundle_of(*again), bundle_of(*message));
  }
}

TEST(Definitions, ThatDoNotExistOrContainThemselvesAreRefused) {
  std::vector<Mistake> mistakes;
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  EXPECT_EQ(resolve("geometry_msgs/msg/Twits", folders, mistakes), nullptr);
  EXPECT_EQ(mistakes.back().shown(),
            "there is no message 'geometry_msgs/Twits'; did you mean 'geometry_msgs/Twist'?");
  EXPECT_FALSE(resolve_service("std_srvs/srv/Triger", folders, mistakes).has_value());
  EXPECT_EQ(mistakes.back().shown(),
            "there is no service 'std_srvs/srv/Triger'; did you mean 'std_srvs/srv/Trigger'?");
  const DefinitionBundle loop("a/msg/A", "B b\n" + std::string(80, '=') + "\nMSG: a/B\nA[] a\n");
  EXPECT_EQ(resolve("a/msg/A", loop, mistakes), nullptr);
  EXPECT_EQ(mistakes.back().shown(), "a/A contains itself");
}

TEST(Definitions, OfInstallationsAreFoundByTheirPrefixes) {
  const fs::path scratch = fs::temp_directory_path() / ("tessera-prefixes-" + std::to_string(getpid()));
  const fs::path one = scratch / "one", two = scratch / "two";
  fs::create_directories(one / "share");
  fs::create_directories(two / "share");
  const auto prefixes = [](const auto&... parts) { return ((std::string(parts) + ":") + ...); };
  using Folders = std::vector<fs::path>;
  EXPECT_EQ(folders_of_installations(""), Folders{});
  EXPECT_EQ(folders_of_installations(
                prefixes("", two.string(), "relative", "/nowhere", one.string(), two.string())),
            (Folders{two / "share", one / "share"}))
      << "in their order, once";
  fs::remove_all(scratch);
  std::vector<Mistake> mistakes;
  EXPECT_EQ(resolve("a/msg/B",
                    DefinitionFolders({"/p/msg", "/x/share", "/y/share", "/z/share", "/w/share", "/own"}),
                    mistakes),
            nullptr);
  EXPECT_EQ(mistakes.back().hint.text,
            "write its definition into msg/a/msg/B.msg beside the specification, or source a ROS 2 "
            "installation that "
            "has it; looked in msg, /x/share, /y/share, /z/share and 1 more, and Tessera's own");
}

TEST(Names, AreThoseOfRos2) {
  std::string error;
  EXPECT_EQ(full_topic_name("cmd_vel", error), "/cmd_vel");
  EXPECT_EQ(full_topic_name("/a/b2/c_d", error), "/a/b2/c_d");
  for (const char* wrong : {"", "/", "a//b", "/a/", "/1a", "a b", "a__b", "~x", "a-b"})
    EXPECT_EQ(full_topic_name(wrong, error), "") << wrong;
  EXPECT_EQ(full_topic_name("/" + std::string(254, 'a'), error), "");
  EXPECT_EQ(dds_topic_name("/a/b"), "rt/a/b");
  EXPECT_EQ(dds_type_name("geometry_msgs/msg/Twist"), "geometry_msgs::msg::dds_::Twist_");
  EXPECT_EQ(node_name_of("robot[3]"), "robot_3");
  EXPECT_EQ(dds_request_name("/a/enable"), "rq/a/enableRequest");
  EXPECT_EQ(dds_reply_name("/a/enable"), "rr/a/enableReply");
  EXPECT_EQ(dds_type_name(request_type("std_srvs/srv/SetBool")), "std_srvs::srv::dds_::SetBool_Request_");
  EXPECT_EQ(dds_type_name(response_type("std_srvs/srv/SetBool")), "std_srvs::srv::dds_::SetBool_Response_");
  EXPECT_TRUE(full_service_name("std_srvs/srv/SetBool").has_value());
  for (const char* wrong : {"std_srvs/SetBool", "/srv/SetBool", "std_srvs/srv/", "a/msg/B", "a/srv/B/c"})
    EXPECT_FALSE(full_service_name(wrong).has_value()) << wrong;
  const auto qos = parse_qos("sensor, depth 2, transient_local", error);
  ASSERT_TRUE(qos.has_value());
  EXPECT_FALSE(qos->reliable);
  EXPECT_TRUE(qos->transient_local);
  EXPECT_EQ(qos->depth, 2);
  EXPECT_FALSE(parse_qos("sensors", error).has_value());
  EXPECT_FALSE(parse_qos("depth 0", error).has_value());
}

TEST(Definitions, ActionsHaveThreeParts) {
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  std::vector<Mistake> mistakes;
  const auto action = resolve_action("nav2_msgs/action/NavigateToPose", folders, mistakes);
  for (const Mistake& one : mistakes) ADD_FAILURE() << one.shown();
  ASSERT_TRUE(action.has_value());
  EXPECT_EQ(action->goal->name, "nav2_msgs/action/NavigateToPose_Goal");
  EXPECT_EQ(action->goal->find("pose")->type.refers, "geometry_msgs/msg/PoseStamped");
  ASSERT_EQ(action->progress->fields.size(), 2U);
  EXPECT_NE(action->progress->find("feedback")->type.structure->find("distance_remaining"), nullptr);
  EXPECT_EQ(action->progress->find("result")->type.structure->fields.size(), 2U);
  // A bundle of it is read as it was written.
  const std::string text = bundle_of(*action->progress);
  const std::string name = "nav2_msgs/action/NavigateToPose";
  const auto again = resolve(name, DefinitionBundle(name, text), mistakes);
  ASSERT_NE(again, nullptr) << (mistakes.empty() ? "" : mistakes.front().shown());
  EXPECT_EQ(bundle_of(*again), text);
}

TEST(Definitions, MistakesInActionsHaveTheirLine) {
  std::vector<Mistake> mistakes;
  EXPECT_FALSE(parse_action("pkg/action/Go", "int32 a\n---\nint32 b\n", "Go.action", mistakes));
  EXPECT_FALSE(parse_action("pkg/action/Go", "int32 a\n---\nint3 b\n---\nint32 c\n", "Go.action", mistakes));
  EXPECT_FALSE(parse_action("pkg/action/Go", "---\n---\n---\n", "Go.action", mistakes));
  EXPECT_TRUE(parse_action("pkg/action/Go", "# nothing\n---\n--- # nor here\n", "Go.action", mistakes));
  std::string all;
  for (const Mistake& one : mistakes) all += one.shown() + "\n";
  EXPECT_EQ(all,
            "Go.action: an action needs two lines ---: behind the goal, and behind the result\n"
            "Go.action:3: unknown type 'int3'; did you mean 'int8'?\n"
            "Go.action:3: a field needs a name: '---'\n");
}

TEST(Definitions, ActionsHaveThreeServicesAndTwoTopics) {
  const ActionNames names = names_of_action("/go", "pkg/action/Go");
  EXPECT_EQ(dds_request_name(names.send_goal), "rq/go/_action/send_goalRequest");
  EXPECT_EQ(dds_type_name(request_type(names.send_goal_type)), "pkg::action::dds_::Go_SendGoal_Request_");
  EXPECT_EQ(dds_reply_name(names.get_result), "rr/go/_action/get_resultReply");
  EXPECT_EQ(dds_type_name(response_type(names.cancel_goal_type)),
            "action_msgs::srv::dds_::CancelGoal_Response_");
  EXPECT_EQ(dds_topic_name(names.feedback), "rt/go/_action/feedback");
  EXPECT_EQ(dds_type_name(names.feedback_type), "pkg::action::dds_::Go_FeedbackMessage_");
  EXPECT_EQ(dds_topic_name(names.status), "rt/go/_action/status");
  EXPECT_EQ(dds_type_name(names.status_type), "action_msgs::msg::dds_::GoalStatusArray_");
}

}  // namespace
}  // namespace tessera::ros2
