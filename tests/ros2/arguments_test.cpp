// The arguments that launch files of ROS 2 give to a program.
#include "ros2/arguments/arguments.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace tessera::ros2 {
namespace {

using GivenWords = std::vector<std::string>;

/// A robot with its own node, and one of a fleet whose names are relative.
Ros2Arguments two_robots(GivenWords words) {
  return {.words = std::move(words),
          .uses = {{"robot.base.velocity", "/cmd_vel", "geometry_msgs/msg/Twist", "", ""},
                   {"robot.laser.scan", "scan", "sensor_msgs/msg/LaserScan", "", ""},
                   {"robot.legs.goal", "/go", "nav2_msgs/action/NavigateToPose", "client", ""},
                   {"robot.eyes.progress", "/go", "nav2_msgs/action/NavigateToPose", "client", ""},
                   {"cart[3].switch.order", "/on", "std_srvs/srv/SetBool", "client", ""}},
          .parameters = {{"robot.control.kp", Ros2Parameter::Kind::real, "0.5"},
                         {"robot.control.steps", Ros2Parameter::Kind::integer, "3"},
                         {"robot.control.gains", Ros2Parameter::Kind::reals, "[1, 2]"},
                         {"robot.control.label", Ros2Parameter::Kind::text, "a"},
                         {"robot.control.on", Ros2Parameter::Kind::boolean, "true"},
                         {"cart[3].control.kp", Ros2Parameter::Kind::real, "0.5"}}};
}

std::string problem_of(GivenWords words) {
  Ros2Arguments arguments = two_robots(std::move(words));
  const auto problem = apply_arguments(arguments);
  set_rules_of_process({});
  return problem ? problem->text : "";
}

std::string file_with(const std::string& text) {
  std::string file = testing::TempDir() + "params_" + std::to_string(getpid()) + ".yaml";
  std::ofstream(file) << text;
  return file;
}

/// "PATH=VALUE PATH=VALUE"
std::string values_of(GivenWords words) {
  Ros2Arguments arguments = two_robots(std::move(words));
  const auto problem = apply_arguments(arguments);
  EXPECT_FALSE(problem) << problem->text;
  set_rules_of_process({});
  std::string text;
  for (const auto& [path, value] : arguments.values) text += (text.empty() ? "" : " ") + path + "=" + value;
  return text;
}

Rules rules_of(const GivenWords& written) {
  std::vector<Rule> rules;
  for (const std::string& one : written) {
    const Result<Rule> rule = parse_rule(one);
    EXPECT_TRUE(rule) << rule.problem();
    if (rule) rules.push_back(*rule);
  }
  return Rules(std::move(rules));
}

TEST(RulesOfRos2, NameTopicsInTheirNamespace) {
  struct Case {
    GivenWords rules;
    const char* written;
    const char* final_name;
  };
  for (const Case& one :
       std::vector<Case>{{{}, "/cmd_vel", "/cmd_vel"},
                         {{}, "scan", "/scan"},
                         {{"__ns:=/left"}, "scan", "/left/scan"},
                         {{"__ns:=/left"}, "/cmd_vel", "/cmd_vel"},
                         {{"__ns:=/left/"}, "a/scan", "/left/a/scan"},
                         {{"/cmd_vel:=/base/cmd_vel"}, "/cmd_vel", "/base/cmd_vel"},
                         {{"cmd_vel:=/base/cmd_vel"}, "/cmd_vel", "/base/cmd_vel"},
                         {{"__ns:=/left", "cmd_vel:=/base/cmd_vel"}, "/cmd_vel", "/cmd_vel"},
                         {{"__ns:=/left", "scan:=front"}, "scan", "/left/front"},
                         {{"__ns:=/left", "/left/scan:=/front"}, "scan", "/front"},
                         {{"__ns:=/left", "/scan:=/front"}, "scan", "/left/scan"},
                         {{"__ns:=/left", "/scan:=scan"}, "/scan", "/left/scan"},
                         {{"__ns:=/left", "__node:=base", "scan:=~/scan"}, "scan", "/left/base/scan"},
                         {{"~/scan:=/x"}, "/robot/scan", "/x"},
                         {{"/scan:=/a", "/scan:=/b"}, "/scan", "/a"},
                         {{"/scan:=/a", "/a:=/b"}, "/scan", "/a"},
                         {{"cart:/scan:=/a", "robot:/scan:=/b"}, "/scan", "/b"},
                         {{"rosservice:///scan:=/a", "rostopic:///scan:=/b"}, "/scan", "/b"},
                         {{"robot:rostopic:///scan:=/c"}, "/scan", "/c"},
                         {{"/scanner:=/a"}, "/scan", "/scan"}}) {
    const Rules rules = rules_of(one.rules);
    EXPECT_EQ(rules.name(Rules::Kind::topic, one.written, rules.node("robot")), one.final_name)
        << testing::PrintToString(one.rules);
  }
  const Rules rules = rules_of({"rostopic:///on:=/a", "rosservice:///on:=/b"});
  EXPECT_EQ(rules.name(Rules::Kind::service, "/on", rules.node("robot")), "/b");
}

TEST(RulesOfRos2, NameNodes) {
  EXPECT_EQ(rules_of({}).node("robot").full(), "/robot");
  EXPECT_EQ(rules_of({"__node:=base", "__ns:=/left/arm"}).node("robot").full(), "/left/arm/base");
  EXPECT_EQ(rules_of({"__name:=base"}).node("robot").full(), "/base");
  EXPECT_EQ(rules_of({"cart:__node:=base", "cart:__ns:=/left"}).node("robot").full(), "/robot");
  // The prefix of a rule for the namespace is the new name, as in rcl.
  EXPECT_EQ(rules_of({"robot:__node:=base", "base:__ns:=/left"}).node("robot").full(), "/left/base");
  EXPECT_EQ(node_name_in("/left/arm/base"), (NodeName{"base", "/left/arm"}));
  EXPECT_EQ(node_name_in("/base"), (NodeName{"base", "/"}));
}

TEST(RulesOfRos2, OfAnotherFormAreRefusedWithTheReason) {
  for (const auto& [rule, why] : std::vector<std::pair<const char*, const char*>>{
           {"/cmd_vel", "it has no ':='"},
           {"/cmd_vel=/x", "it has no ':='"},
           {":=/x", "nothing is no name of a topic or service"},
           {"/cmd_vel:=", "nothing is no name of a topic or service"},
           {"/cmd vel:=/x", "'/cmd vel' is no name"},
           {"/cmd_vel:=/2x", "'/2x' is no name"},
           {"/cmd_vel:=/x/", "'/x/' is no name"},
           {"/a/*:=/x", "no wildcards"},
           {"__nod:=x", "'__nod' is unknown"},
           {"__node:=/x", "'/x' is no name of a node"},
           {"__node:=", "nothing is no name of a node"},
           {"__ns:=left", "'left' is no namespace, which begins with a slash"},
           {"__ns:=/2", "'/2' is no namespace"},
           {"robot::/a:=/b", "':/a' is no name"}}) {
    const Result<Rule> parsed = parse_rule(rule);
    EXPECT_FALSE(parsed) << rule;
    EXPECT_NE(parsed.problem().find(why), std::string::npos) << parsed.problem();
  }
}

TEST(ArgumentsOfRos2, AreThoseOfALaunchFile) {
  const std::string file = file_with("/**:\n  ros__parameters:\n    use_sim_time: false\n");
  Ros2Arguments arguments = two_robots({"-r", "robot:__node:=base", "-r", "__ns:=/left", "--params-file",
                                        file, "--remap", "/cmd_vel:=cmd", "--log-level", "info", "--enclave",
                                        "/", "--disable-rosout-logs", "--ros-args", "-r", "/go:=/far/go"});
  const auto problem = apply_arguments(arguments);
  ASSERT_FALSE(problem) << problem->text;
  EXPECT_EQ(arguments.warnings, GivenWords{});
  EXPECT_EQ(arguments.notes,
            (GivenWords{"the node /robot is /left/base", "/cmd_vel is /left/cmd", "/scan is /left/scan",
                        "/go is /far/go", "the node /cart_3 is /left/cart_3",
                        "without effect: --disable-rosout-logs, --log-level"}));
  const Rules rules = rules_of_process();
  EXPECT_EQ(rules.name(Rules::Kind::service, "/go", rules.node("robot")), "/far/go");
  set_rules_of_process({});
}

TEST(ArgumentsOfRos2, NameWhatIsWrong) {
  for (const auto& [words, why] : std::vector<std::pair<GivenWords, const char*>>{
           {{"--remapp", "a:=b"},
            "'--remapp' is unknown; behind -- come arguments of the controller; did you "
            "mean '--remap'?"},
           {{"-r"}, "-r has no value"},
           {{"-r", "a"}, "it has no ':='"},
           {{"-p", "kp"}, "it has no ':='"},
           {{"--enclave", "/robot"}, "DDS security is not supported"},
           {{"--params-file", "/nowhere.yaml"}, "cannot read the parameters in '/nowhere.yaml'"},
           {{"-r", "__node:=base"},
            "the nodes robot and cart_3 would both be /base; write the node before the rule, such as "
            "robot:__node:=NAME"},
           {{"-p", "boat:control.kp:=1.0"}, "there is no such node"},
           {{"-p", "control.kq:=1.0"}, "no parameter 'control.kq' in the nodes, with "},
           {{"-p", "robot:control.kq:=1.0"}, "no parameter 'control.kq' in the node /robot"},
           {{"-p", "robot:control.kq:=1.0"}, "did you mean 'control.kp'?"},
           {{"-p", "control.kp:=1"}, "parameter robot.control.kp is of type double, not integer: write 1.0"},
           {{"-p", "control.label:=yes"}, "is of type string, not bool"},
           {{"-p", "control.gains:=[1.0, 2]"}, "different types"},
           {{"-p", "use_sim_time:=true"}, "use_sim_time: a run keeps the steady clock of the machine"},
           {{"-p", "control.kp:=~"}, "a parameter has no value"}})
    EXPECT_NE(problem_of(words).find(why), std::string::npos) << problem_of(words) << "\n" << why;
}

TEST(ArgumentsOfRos2, WarnOfRulesThatNameNothing) {
  Ros2Arguments arguments = two_robots({"-r", "/cmd_vell:=/x", "-r", "boat:__node:=y", "-r", "/tf:=tf", "-r",
                                        "/diagnostics:=/d", "-r", "~/set_parameters:=/s"});
  ASSERT_FALSE(apply_arguments(arguments));
  set_rules_of_process({});
  ASSERT_EQ(arguments.warnings.size(), 2U);
  EXPECT_EQ(
      arguments.warnings[0],
      "--ros-args: nothing here has the name in '/cmd_vell:=/x', or an earlier rule came first; did you "
      "mean '/cmd_vel'?");
  EXPECT_EQ(
      arguments.warnings[1],
      "--ros-args: nothing here has the name in 'boat:__node:=y', or an earlier rule came first; the nodes "
      "are /cart_3, /robot");
}

TEST(ArgumentsOfRos2, KeepTheTwoDriversOfAnActionTogether) {
  Ros2Arguments arguments = two_robots({"-r", "__ns:=/left"});
  arguments.uses[3].topic = "go";  // the same name as /go, until there is a namespace
  const auto problem = apply_arguments(arguments);
  ASSERT_TRUE(problem);
  EXPECT_EQ(
      problem->text,
      "--ros-args: the effector and the receptor of /go in robot would have the names /go and /left/go");
}

TEST(ParametersOfRos2, ComeFromTheCommandLine) {
  EXPECT_EQ(values_of({"-p", "control.kp:=0.8"}), "cart[3].control.kp=0.8 robot.control.kp=0.8");
  EXPECT_EQ(values_of({"-p", "robot:control.kp:=8e-1"}), "robot.control.kp=0.8");
  EXPECT_EQ(values_of({"-p", "control.steps:=0x10"}), "robot.control.steps=16");
  EXPECT_EQ(values_of({"-p", "control.on:=off"}), "robot.control.on=false");
  EXPECT_EQ(values_of({"-p", "control.gains:=[1.5, .5]"}), "robot.control.gains=[1.5, 0.5]");
  EXPECT_EQ(values_of({"-p", "control.label:='yes'"}), "robot.control.label=yes");
  EXPECT_EQ(values_of({"-p", "control.label:=a b"}), "robot.control.label=a b");
  EXPECT_EQ(values_of({"-r", "robot:__node:=base", "-p", "base:control.steps:=4"}), "robot.control.steps=4");
}

TEST(ParametersOfRos2, ComeFromFiles) {
  struct Case {
    const char* text;
    const char* values;
  };
  for (const Case& one : std::vector<Case>{
           {"/**:\n  ros__parameters:\n    control.steps: 4\n", "robot.control.steps=4"},
           {"/*:\n  ros__parameters: {control: {steps: 4, on: no}}  # short\n",
            "robot.control.steps=4 robot.control.on=false"},
           {"---\nrobot:\n  ros__parameters:\n    control:\n      gains:\n      - 1.0\n      - 2.5\n      "
            "steps: 5\n",
            "robot.control.gains=[1, 2.5] robot.control.steps=5"},
           {"/robot:\n    ros__parameters:\n        control: { gains: [1.0,\n           2.0] }\n"
            "/cart_3:\n    ros__parameters:\n        control: { kp: 2.0 }\n",
            "robot.control.gains=[1, 2] cart[3].control.kp=2"},
           {"\"/rob\\\"ot\":\n  ros__parameters: {x: 1}\nrobot:\n  ros__parameters:\n    control.label: \"a: "
            "#b\"\n",
            "robot.control.label=a: #b"},
           {"/robot:\n  ros__parameters:\n    control.kp: 1.0\n/**:\n  ros__parameters:\n    control.kp: "
            "2.0\n",
            "robot.control.kp=1 cart[3].control.kp=2 robot.control.kp=2"},
           {"# nothing\n", ""},
           {"controller_server:\n  ros__parameters:\n    kp: 1\nrobot:\n  ros__parameters:\n    "
            "control.steps: 1\n",
            "robot.control.steps=1"}})
    EXPECT_EQ(values_of({"--params-file", file_with(one.text)}), one.values) << one.text;
  EXPECT_EQ(values_of({"-r", "__ns:=/left", "--params-file",
                       file_with("left:\n  robot:\n    ros__parameters:\n      control.steps: 4\n")}),
            "robot.control.steps=4");
}

TEST(ParametersOfRos2, InFilesOfAnotherFormAreRefusedWithTheLine) {
  for (const auto& [text, why] : std::vector<std::pair<const char*, const char*>>{
           {"robot:\n  control.kp: 1.0\n", ":2: 'robot/control.kp' is no map; parameters stand below NODE:"},
           {"ros__parameters:\n  a: 1\n", "'ros__parameters' stands below the name of a node"},
           {"- a\n", ":1: the file is no map"},
           {"boat:\n  ros__parameters:\n    a: 1\n",
            "it has parameters of boat, and the nodes here are /cart_3, /robot"},
           {"/**:\n  ros__parameters:\n    control.kp: 1\n",
            ":3: parameter robot.control.kp is of type double, not"},
           {"/**:\n  ros__parameters:\n    control.kp:\n    control.on: true\n",
            ":3: 'control.kp' has no value"},
           {"/**:\n  ros__parameters:\n    control.kp: 1.0\n    control.kp: 2.0\n",
            ":4: 'control.kp' comes twice"},
           {"/**:\n  ros__parameters:\n\tcontrol.kp: 1.0\n", ":3: a line is indented by a tab"},
           {"/**:\n  ros__parameters:\n    a: &x 1\n", ":3: values that begin with '&'"},
           {"**:\n  ros__parameters:\n    a: 1\n", ":1: values that begin with '*'"},
           {"/**:\n  ros__parameters:\n    a: |\n      b\n", ":3: values that begin with '|'"},
           {"/**:\n  ros__parameters:\n    a: b\n      c\n", ":4: a value of several lines"},
           {"/**:\n  ros__parameters:\n    a: b: c\n", ":3: a second ':'"},
           {"/**:\n  ros__parameters:\n    a: 'b\n", ":3: a quotation mark is missing"},
           {"/**:\n  ros__parameters:\n    a: [1, 2\n", ":3: a ']' is missing"},
           {"/**:\n  ros__parameters:\n    a: []\n", ":3: a: an empty list has no type"},
           {"/**:\n  ros__parameters:\n    a: 1\n   b: 2\n", ":4: this is indented otherwise"},
           {"/**:\n  ros__parameters:\n    a: 1\n---\nb: 2\n", ":4: a second document"}}) {
    const std::string problem = problem_of({"--params-file", file_with(text)});
    EXPECT_NE(problem.find(why), std::string::npos) << text << problem;
  }
}

TEST(ParametersOfRos2, AreForTheNodesThatAreMeant) {
  const NodeName left{"robot", "/left"}, root{"robot", "/"};
  for (const char* pattern :
       {"/**", "/*/robot", "/left/*", "/left/robot", "left/robot", "/**/robot", "/left/**"})
    EXPECT_TRUE(is_meant(pattern, left)) << pattern;
  for (const char* pattern : {"/*", "/robot", "robot", "/right/robot", "/left", "/left/robot/x"})
    EXPECT_FALSE(is_meant(pattern, left)) << pattern;
  for (const char* pattern : {"/**", "/*", "robot", "/robot", "/**/robot"})
    EXPECT_TRUE(is_meant(pattern, root)) << pattern;
}

/// No text makes the reader crash or go on for ever.
TEST(ParametersOfRos2, AnyBytesAreReadOrRefused) {
  const std::string whole =
      "/**:\n  ros__parameters: {a: [1, \"b\\n\"], c: 'd'}\nrobot:\n- x: 1\n- [2,\n 3] # e\n? f\n";
  for (std::size_t length = 0; length <= whole.size(); ++length)
    for (const char wild : std::string("\n\t {}[]:,-#\"'\\?&\0x", 17)) {
      std::string text = whole.substr(0, length) + wild + whole.substr(length);
      static_cast<void>(overrides_in(text, "f"));
      static_cast<void>(overrides_in(text.substr(0, length + 1), "f"));
    }
  EXPECT_FALSE(read_yaml(std::string(100'000, '[')));
  std::string deep;
  for (int level = 0; level < 50; ++level) deep += std::string(static_cast<std::size_t>(level), ' ') + "a:\n";
  EXPECT_FALSE(read_yaml(deep));
}

}  // namespace
}  // namespace tessera::ros2
