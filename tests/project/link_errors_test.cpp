#include "folder.hpp"
#include "project/build/transition_functions.hpp"

namespace tessera::project_test {
namespace {

using LinkErrors = Folder;
using project::TransitionFunctions;
using Presence = TransitionFunctions::Presence;

codegen::Stub stub(const std::string& subsystem, const std::string& function) {
  const std::string space = "rover::robot::" + subsystem;
  return {.file = "src/" + subsystem + ".cpp",
          .function = function,
          .subsystem = "robot." + subsystem,
          .space = space,
          .signature = "void " + function + "(Context& context)",
          .preamble = "#include \"robot/" + subsystem + ".hpp\"\n\nnamespace " + space + " {\n",
          .body = "void " + function + "(Context& context) {}\n",
          .closing = "}  // namespace " + space + "\n"};
}

const std::vector<codegen::Stub> wanted{stub("control", "init"), stub("control", "follow"),
                                        stub("motor", "init")};

TEST_F(LinkErrors, WhereAFunctionIs) {
  EXPECT_EQ(TransitionFunctions(folder_, wanted).presence(wanted[0]), Presence::missing);
  write("src/a/any.cc", "namespace rover::robot::control { void init(Context& c) {} }\n");
  const TransitionFunctions functions(folder_, wanted);
  EXPECT_EQ(functions.presence(wanted[0]), Presence::defined);
  EXPECT_EQ(functions.presence(wanted[1]), Presence::missing);
  EXPECT_EQ(functions.presence(wanted[2]), Presence::missing);  // that of another subsystem is not it
  EXPECT_EQ(functions.file_for(wanted[1]), "src/a/any.cc");
  EXPECT_EQ(functions.file_for(wanted[2]), "src/motor.cpp");
  write("src/old.cpp", "namespace rover::car::motor { void init(Context&) {} }\n");
  EXPECT_EQ(TransitionFunctions(folder_, wanted).presence(wanted[2]), Presence::missing);
  EXPECT_EQ(TransitionFunctions(folder_, wanted).definitions_elsewhere(wanted[2]).size(), 1U);
  write("src/macro.hpp", "#define FOLLOW void follow(Context&)\n");
  EXPECT_EQ(TransitionFunctions(folder_, wanted).presence(wanted[1]), Presence::unclear);
  write("shared/motor.inc", "void rover::robot::motor::init(Context& c) {}\n");
  write("src/motor.cpp", "#include \"../shared/motor.inc\"\n");
  EXPECT_EQ(TransitionFunctions(folder_, wanted).presence(wanted[2]), Presence::defined);
}

TEST_F(LinkErrors, AFunctionIsAddedWhereItsSubsystemIs) {
  write("src/all.cpp",
        "namespace rover::robot::motor {\nvoid init(Context& c) {}\n}\n"
        "namespace rover::robot::control {\nvoid init(Context& c) {}\n\n}\nint last() { return 1; }\n");
  TransitionFunctions functions(folder_, wanted);
  EXPECT_EQ(functions.add(wanted[1]), folder_ / "src/all.cpp");
  EXPECT_EQ(functions.presence(wanted[1]), Presence::defined);
  EXPECT_EQ(content_of(folder_ / "src/all.cpp"),
            "namespace rover::robot::motor {\nvoid init(Context& c) {}\n}\n"
            "namespace rover::robot::control {\nvoid init(Context& c) {}\n\n"
            "void follow(Context& context) {}\n\n}\nint last() { return 1; }\n");
  fs::remove(folder_ / "src/all.cpp");
  TransitionFunctions none(folder_, wanted);
  for (const codegen::Stub& one : wanted) none.add(one);
  for (const codegen::Stub& one : wanted)
    EXPECT_EQ(TransitionFunctions(folder_, wanted).presence(one), Presence::defined);
  EXPECT_EQ(files(), (std::set<std::string>{"src/control.cpp", "src/motor.cpp"}));
}

TEST_F(LinkErrors, AFunctionWithNearlyItsNameIsShown) {
  write("src/robot.cpp",
        "namespace rover::robot::control {\nvoid helper(int n) {}\nvoid folow(Context& c) {}\n"
        "void init(Context& c) {}\n}\nvoid rover::robot::motor::int1(Context c) {}\n");
  const TransitionFunctions functions(folder_, wanted);
  EXPECT_EQ(functions.presence(wanted[1]), Presence::missing);
  const std::string told = missing_text(wanted[1], functions);
  EXPECT_TRUE(told.starts_with(
      "src/robot.cpp:3: error: robot.control has no function 'follow'\n"
      "hint: did you mean 'folow' at src/robot.cpp:3? Then call it 'follow'; else add it (or run "
      "`tessera generate --stubs`):\n\nvoid follow(Context& context) {}\n"))
      << told;
  // Also if its arguments are wrong too.
  EXPECT_TRUE(missing_text(wanted[2], functions).starts_with("src/robot.cpp:6: error: robot.motor has no "));
}

TEST_F(LinkErrors, LinkersAreExplained) {
  write("src/one.cpp", "namespace rover::robot::control {\nvoid follow(Context& c) {}\n}\n");
  write("src/two.cpp", "\n\nvoid rover::robot::control::follow(Context& c) {}\n");
  write("src/moved.cpp", "namespace rover::car::motor { void init(Context& c) {} }\n");
  const TransitionFunctions functions(folder_, wanted);
  for (const char* twice :
       {"/usr/bin/ld: two.o: in function `rover::robot::control::follow(Context&)':\ntwo.cpp:3: multiple "
        "definition "
        "of `rover::robot::control::follow(Context&)'; one.o:one.cpp:2: first defined here\ncollect2: error: "
        "ld "
        "returned 1 exit status\n",
        "ld.lld: error: duplicate symbol: rover::robot::control::follow(Context&)\n",
        "mold: error: duplicate symbol: one.o: two.o: rover::robot::control::follow(Context&)\n"}) {
    EXPECT_EQ(explain_build_errors(twice, functions),
              "src/one.cpp:2: error: the function 'follow' of robot.control is defined more than once\n"
              "src/two.cpp:3: note: here too\n"
              "hint: keep one of them; every source in src/ is part of the controller\n")
        << twice;
  }
  for (const char* missing :
       {"/usr/bin/ld: x.o: undefined reference to `rover::robot::motor::init(Context&)'\n",
        "ld.lld: error: undefined symbol: rover::robot::motor::init(Context&)\n"}) {
    const std::string told = explain_build_errors(missing, functions);
    EXPECT_TRUE(
        told.starts_with("src/motor.cpp: error: robot.motor has no function 'init'\n"
                         "src/moved.cpp:1: note: a function 'init' is here in the namespace "
                         "rover::car::motor; that of robot.motor belongs in the namespace "
                         "rover::robot::motor\n"))
        << told;
    EXPECT_NE(told.find("#include \"robot/motor.hpp\""), std::string::npos) << told;
  }
  // Other lines stay.
  const std::string other = "undefined reference to `helper()'\n";
  EXPECT_NE(explain_build_errors("undefined reference to `rover::robot::motor::init(Context&)'\n" + other,
                                 functions)
                .find(other),
            std::string::npos);
  EXPECT_TRUE(explain_build_errors(other, functions).starts_with(other));
}

}  // namespace
}  // namespace tessera::project_test
