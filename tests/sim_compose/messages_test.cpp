#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "files.hpp"
#include "sim/compose/layout.hpp"

namespace tessera::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The problem of a model with this text, without the name of its file.
std::string problem_with(const std::string& mjcf) {
  const std::string file = file_with("tried.xml", mjcf);
  const std::string problem = problem_of({placed("a", file)});
  EXPECT_THAT(problem, StartsWith(file));
  return problem.substr(std::min(problem.size(), file.size()));
}

std::string in_body(const std::string& inside) {
  return "<mujoco>\n<worldbody>\n<body name='b'>\n" + inside + "\n</body></worldbody></mujoco>";
}

TEST(Messages, NameWhatNeedsANewerEngine) {
  const std::string joint = "<joint name='j'/><geom size='1'/>";
  struct Case {
    std::string mjcf, message;
  };
  for (const Case& c : {
           Case{"<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody>\n<actuator>"
                "<position joint='j' kv='1'/></actuator></mujoco>",
                ": needs a newer MuJoCo: `kv` of `position` (line 2)"},
           Case{"<mujoco>\n<option integrator='implicitfast'/></mujoco>",
                ": needs a newer MuJoCo: `implicitfast` in `option` (line 2)"},
           Case{in_body("<frame/>"), ": needs a newer MuJoCo: `frame` (line 4)"},
           Case{in_body("<joint actuatorfrcrange='0 1'/>"),
                ": needs a newer MuJoCo: `actuatorfrcrange` of `joint` (line 4)"},
           Case{"<mujoco>\n\n<size memory='1M'/></mujoco>",
                ": needs a newer MuJoCo: `memory` of `size` (line 3)"},
           Case{"<mujoco><sensor>\n<contact/></sensor></mujoco>",
                ": needs a newer MuJoCo: `contact` (line 2)"},
           Case{"<mujoco><extension/></mujoco>", ": needs a newer MuJoCo: `extension` (line 1)"},
           Case{in_body("<camera resolution='64 48'/>"),
                ": needs a newer MuJoCo: `resolution` of `camera` (line 4)"},
           Case{in_body("<joint colour='red'/>"),
                ": MuJoCo 2.2.2 does not know `colour` of `joint` at this "
                "place (line 4); it is wrong, or needs a newer MuJoCo"},
       })
    EXPECT_EQ(problem_with(c.mjcf), c.message);
}

TEST(Messages, NameTheFileAndTheReason) {
  struct Case {
    std::string mjcf, part;
  };
  for (const Case& c : {
           Case{"", "empty"},
           Case{" \n", "no well-formed XML"},
           Case{"these are no elements", "no well-formed XML"},
           Case{"<mujoco>\n<worldbody>\n</mujoco>", ":3: no well-formed XML"},
           Case{"<robot name='r'/>", "URDF"},
           Case{"<mujocoinclude/>", "part for an <include>"},
           Case{"<scene/>", "begins with <scene>, not with <mujoco>"},
           Case{"<mujoco><include/></mujoco>", "names no file"},
           Case{"<mujoco><include file='nowhere.xml'/></mujoco>", "nowhere.xml: there is no such file"},
           Case{"<mujoco><include file='tried.xml'/></mujoco>", "includes itself"},
           Case{"<mujoco><asset><mesh file='nowhere.stl'/></asset></mujoco>", "nowhere.stl"},
           Case{"<mujoco><compiler coordinate='global'/></mujoco>", "global coordinates"},
           Case{in_body("<joint/>"), "mass"},
           Case{in_body("<geom size='-1'/>"), "size"},
           Case{in_body("<geom type='mesh' mesh='gone'/>"), "gone"},
           Case{in_body("<geom size='1'/><composite type='particle' count='1000 1000 1000' spacing='1'/>"),
                "`count` of `composite` is too large: 1000 1000 1000"},
           Case{"<mujoco><size njmax='2000000000'/></mujoco>", "`njmax` of `size` is too large"},
           Case{"<mujoco><asset><texture type='2d' name='t' builtin='flat' width='1e9' "
                "height='1'/></asset></mujoco>",
                "`width` of `texture` is too large"},
           Case{"<mujoco><size nuserdata='-5'/></mujoco>", "`nuserdata` of `size` is negative"},
           Case{in_body("<joint damping='nan'/><geom size='1'/>"),
                "`damping` of `joint` is no usable number: nan"},
           Case{in_body("<joint damping='1 -inf'/><geom size='1'/>"), "is no usable number"},
           Case{"<mujoco><option timestep='1'/></mujoco>", "time step"},
       })
    EXPECT_THAT(problem_with(c.mjcf), HasSubstr(c.part)) << c.mjcf;
}

TEST(Messages, DampingThatDrivesIsRefused) {
  std::string arm = text_of(model("arm.xml"));
  const std::string damping = "damping=\"0.4\"";
  arm.replace(arm.find(damping), damping.size(), "damping=\"-1\"");
  EXPECT_THAT(problem_with(arm), HasSubstr("`damping` of `joint` is no usable number: -1"));
}

TEST(Messages, DeepNestingIsRefused) {
  std::string deep = "<mujoco><worldbody>";
  for (int i = 0; i < 100'000; ++i) deep += "<body>";
  for (int i = 0; i < 100'000; ++i) deep += "</body>";
  EXPECT_THAT(problem_with(deep + "</worldbody></mujoco>"), HasSubstr("more than 200 deep"));
}

TEST(Messages, IncludesThatGoInCirclesAreNamed) {
  static_cast<void>(file_with("one.xml", "<mujoco><include file='two.xml'/></mujoco>"));
  static_cast<void>(file_with("two.xml", "<mujoco><include file='one.xml'/></mujoco>"));
  EXPECT_THAT(problem_with("<mujoco><include file='one.xml'/></mujoco>"), HasSubstr("included twice"));
}

TEST(Messages, FilesThatAreNoFilesAreRefused) {
  EXPECT_EQ(problem_of({placed("a", "/nowhere/rover.xml")}), "/nowhere/rover.xml: there is no such file");
  EXPECT_EQ(problem_of({placed("a", "/tmp")}), "/tmp: is not a file");
  EXPECT_EQ(problem_of({placed("a", "")}).substr(0, 2), ": ");
  EXPECT_EQ(problem_of({}, "/nowhere/hall.xml"), "/nowhere/hall.xml: there is no such file");
}

TEST(Messages, BadPlacementsAreRefused) {
  const std::string box = model("box.xml");
  const auto problem_of_name = [&](const std::string& name) { return problem_of({placed(name, box)}); };
  EXPECT_EQ(problem_of_name(""), "a placement has no name");
  EXPECT_EQ(problem_of_name("world"), "'world': only the world itself has that name");
  for (const char* name : {"a/b", "a b", "<a>", "a\"", "a\n", "\xc3\xa4", "'"})
    EXPECT_THAT(problem_of_name(name), HasSubstr("letters, digits"));
  EXPECT_THAT(problem_of_name(std::string(1000, 'a')), HasSubstr("too long"));
  EXPECT_EQ(problem_of({placed("a", box), placed("a", box, 1)}), "a: is placed twice");
  EXPECT_EQ(problem_of({placed("door", box)}),
            "door: " + model("world.xml") + " has an element 'door'; the placement needs another name");
  EXPECT_THAT(problem_of({placed("a", box, std::nan(""))}), HasSubstr("its place is no number"));
  EXPECT_THAT(problem_of({placed("a", box, std::numeric_limits<double>::infinity())}), HasSubstr("place"));
  EXPECT_THAT(problem_of(std::vector<sim::Placement>(10'001, placed("a", box))), HasSubstr("10000"));
  const std::string taken =
      file_with("taken.xml", "<mujoco><worldbody><site name='a/box'/></worldbody></mujoco>");
  EXPECT_THAT(problem_of({placed("a", box)}, taken), HasSubstr("has an element 'a/box'"));
}

TEST(Messages, MoreBodiesThanTheEngineCanTellApartAreRefused) {
  std::string many = "<mujoco><worldbody>";
  for (int i = 0; i < 400; ++i) many += "<body/>";
  const std::string file = file_with("many.xml", many + "</worldbody></mujoco>");
  std::vector<sim::Placement> placements;
  for (int i = 0; i < 100; ++i) placements.push_back(placed("a[" + std::to_string(i) + "]", file));
  EXPECT_THAT(problem_of(placements), HasSubstr("bodies; MuJoCo 2.2.2 can have 32000"));
}

TEST(Messages, TwoWaysToWeighMeshesAreRefused) {
  const std::string other =
      file_with("other/plain.xml",
                "<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset>"
                "<worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>");
  EXPECT_THAT(problem_of({placed("a", model("meshes.xml")), placed("b", other)}),
              HasSubstr("exactmeshinertia"));
}

}  // namespace
}  // namespace tessera::testing
