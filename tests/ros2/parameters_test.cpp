// The parameters of a node of ROS 2 and its diagnostics as messages, without DDS.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ros2/codec/cdr.hpp"
#include "ros2/definitions/resolver.hpp"
#include "ros2/parameters/node_parameters.hpp"

namespace tessera::ros2 {
namespace {

using Bytes = std::vector<std::byte>;
using ParameterKind = Ros2Parameter::Kind;

class Robots final : public Ros2Host {
 public:
  [[nodiscard]] std::vector<Ros2Parameter> parameters() const override { return all; }
  [[nodiscard]] std::optional<std::string> set(std::span<const Change> changes) override {
    for (const auto& [path, value] : changes)
      if (value == "11.5") return path + " is out of range";
    for (const auto& [path, value] : changes)
      for (Ros2Parameter& one : all)
        if (one.path == path) one.value = value;
    return std::nullopt;
  }
  [[nodiscard]] std::vector<Ros2Status> statuses() override { return {}; }
  [[nodiscard]] std::string system() const override { return "depot"; }

  std::vector<Ros2Parameter> all{
      {"robot.control.gain", ParameterKind::real, "0.5", "m/s", 0, 10},
      {"robot.control.level", ParameterKind::integer, "-3", "", -8, 8},
      {"robot.control.label", ParameterKind::text, "red, [1]", "", 0, 0, 16},
      {"robot.arm.points", ParameterKind::reals, "[0.5, 2, -1e-05]", "m", -5, 5, 0, 3},
      {"robot.arm.on", ParameterKind::boolean, "true"},
      {"robot.arm.used", ParameterKind::booleans, "[true, false]", "", 0, 0, 0, 2},
      {"robot.arm.steps", ParameterKind::integers, "[1, -2]", "", -9, std::numeric_limits<double>::infinity(),
       0, 2},
      {"robot.arm.beyond", ParameterKind::integer, "18446744073709551615"},
      {"cart.drive.gain", ParameterKind::real, "1"}};
};

/// A message in words: "names: [a, b]". It is walked over by the definition that is shipped, an independent judge of
/// what was written. "?": it has another form.
class Words {
 public:
  static std::string of(const Bytes& message, const Structure& type) {
    auto reader = CdrReader::open(message);
    if (!reader) return "?";
    Words words(*reader);
    const std::string text = words.structure(type);
    return reader->ok() && reader->left() <= 3 ? text : "?";
  }

 private:
  explicit Words(CdrReader& reader) : reader_(reader) {}
  std::string structure(const Structure& type) {
    std::string text;
    for (const Field& field : type.fields) {
      std::string value = any(field.type);
      if (value.empty() || value == "0" || value == "[]" || value == "{}") continue;
      text += (text.empty() ? "" : " ") + field.name + "=" + value;
    }
    return "{" + text + "}";
  }
  std::string any(const Type& type) {
    if (type.repeat == Type::Repeat::once) return one(type);
    const std::uint32_t count = type.repeat == Type::Repeat::array ? type.count : reader_.length();
    std::string text = "[";
    for (std::uint32_t index = 0; index < count && reader_.ok(); ++index)
      text += (index == 0 ? "" : ", ") + one(type);
    return text + "]";
  }
  std::string one(const Type& type) {
    if (type.primitive == Primitive::structure) return structure(*type.structure);
    if (type.primitive == Primitive::string) return std::string(reader_.text());
    const auto bytes = reader_.numbers(size_of(type.primitive), 1);
    if (bytes.empty()) return "?";
    double real = 0;
    std::int64_t whole = 0;
    if (type.primitive == Primitive::float64 || type.primitive == Primitive::float32) {
      static_cast<void>(convert(type.primitive, bytes.data(), false, Primitive::float64,
                                reinterpret_cast<std::byte*>(&real), 1));
      std::string text = std::to_string(real);
      while (text.ends_with('0')) text.pop_back();
      if (text.ends_with('.')) text.pop_back();
      return text;
    }
    const Primitive from = type.primitive == Primitive::boolean ? Primitive::uint8 : type.primitive;
    static_cast<void>(
        convert(from, bytes.data(), false, Primitive::int64, reinterpret_cast<std::byte*>(&whole), 1));
    return std::to_string(whole);
  }
  CdrReader& reader_;
};

class ParametersOfANode : public testing::Test {
 protected:
  const DefinitionFolders folders{{std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"}};
  Robots robots;
  NodeParameters node{robots, "/robot", {"robot"}};

  std::string reply(ParameterService service, const Bytes& request) {
    const auto bytes = node.answer(service, request);
    if (!bytes) return "no reply";
    std::vector<Mistake> mistakes;
    const auto type =
        resolve_service(parameter_services[static_cast<std::size_t>(service)].type, folders, mistakes);
    return type ? Words::of(*bytes, *type->response) : mistakes.front().shown();
  }
  std::string message(const Bytes& bytes, const std::string& name) {
    std::vector<Mistake> mistakes;
    const auto type = resolve(name, folders, mistakes);
    return type == nullptr ? mistakes.front().shown() : Words::of(bytes, *type);
  }
  static Bytes names(const std::vector<std::string>& all, std::optional<std::uint64_t> depth = {}) {
    Bytes bytes;
    CdrWriter writer(bytes);
    writer.length(static_cast<std::uint32_t>(all.size()));
    for (const std::string& one : all) writer.text(one);
    if (depth) writer.number(&*depth, sizeof *depth);
    writer.finish();
    return bytes;
  }
  /// The fields behind the type, of which one is given by `put` at its place.
  template <class Put>
  static void value(CdrWriter& writer, std::uint8_t type, Put put) {
    writer.number(&type, 1);
    constexpr std::array<std::size_t, 4> sizes{1, 8, 8, 0};
    for (std::uint8_t field = 1; field <= 9; ++field) {
      if (field == type)
        put();
      else if (field == 4)
        writer.text("");
      else if (field > 4)
        writer.length(0);
      else
        writer.numbers(sizes[field - 1U], 1);
    }
  }
  template <class Number>
  static Bytes set_number(const std::vector<std::pair<std::string, Number>>& all, std::uint8_t type) {
    Bytes bytes;
    CdrWriter writer(bytes);
    writer.length(static_cast<std::uint32_t>(all.size()));
    for (const auto& [name, number] : all) {
      writer.text(name);
      value(writer, type, [&, one = number] { writer.number(&one, sizeof one); });
    }
    writer.finish();
    return bytes;
  }
  static Bytes set_reals(const std::vector<std::pair<std::string, double>>& all) {
    return set_number(all, 3);
  }
};

TEST_F(ParametersOfANode, AreListedByTheRuleOfRclcpp) {
  EXPECT_EQ(
      reply(ParameterService::list, names({}, 0)),
      "{result={names=[control.gain, control.level, control.label, arm.points, arm.on, arm.used, arm.steps, "
      "arm.beyond] prefixes=[control, arm]}}");
  EXPECT_EQ(reply(ParameterService::list, names({"arm"}, 1)),
            "{result={names=[arm.points, arm.on, arm.used, arm.steps, arm.beyond] prefixes=[arm]}}");
  EXPECT_EQ(reply(ParameterService::list, names({"control.gain", "ar"}, 0)),
            "{result={names=[control.gain] prefixes=[control]}}");
  EXPECT_EQ(reply(ParameterService::list, names({}, 1)), "{}");
  EXPECT_EQ(reply(ParameterService::list, names({})), "no reply");
}

TEST_F(ParametersOfANode, HaveValuesAndTypes) {
  const Bytes all = names({"control.gain", "control.level", "control.label", "arm.points", "arm.on",
                           "arm.used", "arm.steps", "arm.beyond", "drive.gain"});
  EXPECT_EQ(reply(ParameterService::types, all), "{types=[3, 2, 4, 8, 1, 6, 7, 0, 0]}");
  EXPECT_EQ(reply(ParameterService::get, all),
            "{values=[{type=3 double_value=0.5}, {type=2 integer_value=-3}, {type=4 string_value=red, [1]}, "
            "{type=8 "
            "double_array_value=[0.5, 2, -0.00001]}, {type=1 bool_value=1}, {type=6 bool_array_value=[1, "
            "0]}, {type=7 "
            "integer_array_value=[1, -2]}, {}, {}]}");
}

TEST_F(ParametersOfANode, HaveRangesAsDescriptors) {
  EXPECT_EQ(
      reply(ParameterService::describe,
            names({"control.gain", "control.level", "control.label", "arm.steps", "arm.on", "other"})),
      "{descriptors=[{name=control.gain type=3 description=in m/s floating_point_range=[{to_value=10}]}, "
      "{name=control.level type=2 integer_range=[{from_value=-8 to_value=8 step=1}]}, {name=control.label "
      "type=4 "
      "additional_constraints=at most 16 bytes}, {name=arm.steps type=7 additional_constraints=2 elements, "
      "each "
      "at least -9}, {name=arm.on type=1}, {name=other}]}");
}

TEST_F(ParametersOfANode, AreSetOneByOneOrRefusedWithTheReason) {
  EXPECT_EQ(
      reply(ParameterService::set,
            set_reals({{"control.gain", 0.1}, {"control.gain", 11.5}, {"control.level", 2}, {"gain", 1}})),
      "{results=[{successful=1}, {reason=robot.control.gain is out of range}, {reason=parameter "
      "robot.control.level is of type integer, not double}, {reason=the node /robot has no parameter "
      "gain}]}");
  EXPECT_EQ(robots.all[0].value, "0.1");
  EXPECT_EQ(robots.all[1].value, "-3");
  EXPECT_EQ(
      reply(ParameterService::set, set_number<std::int64_t>({{"control.gain", 1}, {"control.level", 7}}, 2)),
      "{results=[{reason=parameter robot.control.gain is of type double, not integer: write 1.0}, "
      "{successful=1}]}");
  EXPECT_EQ(robots.all[1].value, "7");
}

TEST_F(ParametersOfANode, AreSetTogetherOrNotAtAll) {
  EXPECT_EQ(reply(ParameterService::set_all, set_reals({{"control.gain", 2}, {"control.gain", 11.5}})),
            "{result={reason=robot.control.gain is out of range}}");
  EXPECT_EQ(reply(ParameterService::set_all, set_reals({{"control.gain", 2}, {"nothing", 3}})),
            "{result={reason=the node /robot has no parameter nothing}}");
  EXPECT_EQ(robots.all[0].value, "0.5");
  EXPECT_EQ(reply(ParameterService::set_all, set_reals({{"control.gain", 2}})), "{result={successful=1}}");
  EXPECT_EQ(robots.all[0].value, "2");
}

TEST_F(ParametersOfANode, ArraysAndTextsAreSet) {
  Bytes bytes;
  CdrWriter writer(bytes);
  writer.length(3);
  writer.text("arm.points");
  value(writer, 8, [&] {
    writer.length(3);
    for (const double number : {1.5, -2.0, 0.25}) writer.number(&number, sizeof number);
  });
  writer.text("control.label");
  value(writer, 4, [&] { writer.text("a, b"); });
  writer.text("arm.used");
  value(writer, 6, [&] {
    writer.length(2);
    for (const std::uint8_t flag : std::array<std::uint8_t, 2>{0, 1}) writer.number(&flag, 1);
  });
  writer.finish();
  EXPECT_EQ(reply(ParameterService::set_all, bytes), "{result={successful=1}}");
  EXPECT_EQ(robots.all[3].value, "[1.5, -2, 0.25]");
  EXPECT_EQ(robots.all[2].value, "a, b");
  EXPECT_EQ(robots.all[5].value, "[false, true]");
}

TEST_F(ParametersOfANode, EventsTellOfEachChangeOnce) {
  const std::string event = "rcl_interfaces/msg/ParameterEvent";
  NodeParameters carts{robots, "/carts", {"cart", "tug"}};
  ASSERT_EQ(message(carts.event({3, 4}).value(), event),
            "{stamp={sec=3 nanosec=4} node=/carts new_parameters=[{name=cart.drive.gain value={type=3 "
            "double_value=1}}]}");
  EXPECT_FALSE(carts.event({5, 6}));
  robots.all.back().value = "2.5";
  EXPECT_EQ(message(carts.event({7, 0}).value(), event),
            "{stamp={sec=7} node=/carts changed_parameters=[{name=cart.drive.gain value={type=3 "
            "double_value=2.5}}]}");
  EXPECT_FALSE(carts.event({8, 0}));
}

TEST_F(ParametersOfANode, DiagnosticsAreAMessage) {
  const std::vector<Ros2Status> all{
      {"control", Ros2Status::Level::warn, "2 new overruns", {{"overruns", "2"}}},
      {"arm", Ros2Status::Level::ok, "rest", {}}};
  EXPECT_EQ(
      message(diagnostics_message({1, 2}, "robot", "depot", all), "diagnostic_msgs/msg/DiagnosticArray"),
      "{header={stamp={sec=1 nanosec=2}} status=[{level=1 name=robot: control message=2 new overruns "
      "hardware_id=depot values=[{key=overruns value=2}]}, {name=robot: arm message=rest "
      "hardware_id=depot}]}");
}

TEST_F(ParametersOfANode, RequestsOfAnyBytesAreNoHarm) {
  std::mt19937 random(7);
  const Bytes good = set_reals({{"control.gain", 0.1}, {"control.level", 2}});
  std::size_t answered = 0;
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = good;
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes)
      bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    if (random() % 2 == 0) bytes.resize(random() % (bytes.size() + 1));
    const auto service = static_cast<ParameterService>(random() % parameter_services.size());
    if (node.answer(service, bytes)) ++answered;
    for (const Ros2Parameter& one : robots.all) ASSERT_LE(one.value.size(), 400U);
  }
  EXPECT_GT(answered, 0U);
}

}  // namespace
}  // namespace tessera::ros2
