// The effect of a failure, as `check`, `verify` and `migrate` tell it.

#include "command.hpp"

namespace tessera::cli_test {
namespace {

using Failures = Command;

/// A gripper that may lose its air while it closes.
constexpr const char* gripper =
    "tessera: 1\nsystem: cell\nagents:\n  arm:\n    control:\n      rate: 10 Hz\n"
    "      memory: { closed: bool }\n      behaviours:\n"
    "        grab: { terminal: { done: memory.closed }, next: lift }  # the box\n"
    "        lift: { terminal: elapsed > 300 ms, next: end }\n";

TEST_F(Failures, AreNotedByCheckAndRoutedByMigrate) {
  write(folder_ / "spec.yaml", gripper);
  const project::Exit noted = tessera("check");
  EXPECT_EQ(noted.code, 0) << noted.text;
  for (const char* part : {"spec.yaml:9:58: note N330: after a failure 'grab' does not go on to 'lift'",
                           "add { to: lift, when: error }", "1 note"})
    EXPECT_NE(noted.text.find(part), std::string::npos) << part << "\n" << noted.text;
  const project::Exit judged = tessera("verify");
  EXPECT_EQ(judged.text.find("N330"), std::string::npos) << "only `check` notes it\n" << judged.text;

  const project::Exit shown = tessera("migrate --dry-run");
  EXPECT_EQ(shown.code, 0) << shown.text;
  EXPECT_EQ(content_of(folder_ / "spec.yaml"), gripper) << "nothing is written";
  for (const char* part :
       {"line 9\n", "\n-        grab: { terminal: { done: memory.closed }, next: lift }  # the box\n",
        "\n+        grab: { terminal: { done: memory.closed }, next: [{ to: lift, when: error }, lift] }  # "
        "the "
        "box\n",
        "1 entry for errors and failures would be added"})
    EXPECT_NE(shown.text.find(part), std::string::npos) << part << "\n" << shown.text;
  const project::Exit done = tessera("migrate .");
  EXPECT_EQ(done.code, 0) << done.text;
  EXPECT_NE(content_of(folder_ / "spec.yaml").find("next: [{ to: lift, when: error }, lift] }  # the box"),
            std::string::npos);
  const project::Exit clean = tessera("check");
  EXPECT_EQ(clean.text.find("note"), std::string::npos) << clean.text;
  const project::Exit again = tessera("migrate");
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.text.find("nothing to change"), std::string::npos) << again.text;
}

/// Two behaviours that repeat what a subsystem can say.
constexpr const char* repeated =
    "tessera: 1\nsystem: cell\nagents:\n  arm:\n    control:\n      rate: 10 Hz\n"
    "      outputs: { left: bool, right: bool }\n      # what it does\n      behaviours:\n"
    "        grab: { send: [left], terminal: { late: elapsed > 1 s || index > 7 }, next: [{ to: safe, when: "
    "error }, "
    "lift] }  # box\n"
    "        lift: { send: [left], terminal: { late: elapsed > 1 s || index > 7 }, next: [{ to: safe, when: "
    "error }, "
    "grab] }\n"
    "        safe: { send: [left, right], terminal: true, next: [{ to: end, when: error }, grab] }\n";

TEST_F(Failures, OfAllBehavioursAreWrittenOnceByMigrate) {
  write(folder_ / "spec.yaml", repeated);
  const project::Exit shown = tessera("migrate --dry-run");
  EXPECT_EQ(shown.code, 0) << shown.text;
  EXPECT_EQ(content_of(folder_ / "spec.yaml"), repeated) << "nothing is written";
  EXPECT_NE(shown.text.find("3 defaults would be written; the net is the same: "), std::string::npos)
      << shown.text;
  const project::Exit done = tessera("migrate");
  EXPECT_EQ(done.code, 0) << done.text;
  for (const char* part : {"\n+      on_error: safe\n", "arm.control: on_error: safe, for 2 behaviours",
                           "arm.control: send: [left], for 3 behaviours", "3 defaults written"})
    EXPECT_NE(done.text.find(part), std::string::npos) << part << "\n" << done.text;
  EXPECT_EQ(
      content_of(folder_ / "spec.yaml"),
      "tessera: 1\nsystem: cell\nagents:\n  arm:\n    control:\n      rate: 10 Hz\n"
      "      outputs: { left: bool, right: bool }\n      conditions: { late: elapsed > 1 s || index > 7 }\n"
      "      send: [left]\n      on_error: safe\n      # what it does\n      behaviours:\n"
      "        grab: { terminal: late, next: lift }  # box\n        lift: { terminal: late, next: grab }\n"
      "        safe: { send: [+right], terminal: true, next: [{ to: end, when: error }, grab] }\n");
  const project::Exit again = tessera("migrate");
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.text.find("nothing to change"), std::string::npos) << again.text;
}

TEST_F(Failures, ThatAConditionHasDecidedAreLeftToTheAuthor) {
  std::string text = gripper;
  text.replace(text.find("next: lift"), 10, "next: [{ to: end, when: elapsed > 2 s }, lift]");
  write(folder_ / "spec.yaml", text);
  const project::Exit done = tessera("migrate");
  EXPECT_EQ(done.code, 1) << done.text;
  EXPECT_EQ(content_of(folder_ / "spec.yaml"), text);
  EXPECT_NE(done.text.find("note N331: say where a failure of 'arm.control.grab' leads"), std::string::npos)
      << done.text;
}

TEST_F(Failures, AreNotRoutedInAFileWithErrors) {
  std::string text = gripper;
  text.replace(text.find("next: lift"), 10, "next: lfit");
  write(folder_ / "spec.yaml", text);
  EXPECT_EQ(tessera("migrate").code, 1);
  EXPECT_EQ(content_of(folder_ / "spec.yaml"), text);
  EXPECT_EQ(tessera("migrate nowhere.yaml").code, 2);
}

TEST_F(Failures, ReachBehavioursThatNothingElseReaches) {
  std::string text = gripper;
  text.replace(text.find("next: lift"), 10, "next: [{ to: limp, when: error }, lift]");
  write(folder_ / "spec.yaml",
        text + "        limp: { next: { to: crawl, when: error } }\n        crawl: {}\n");
  const project::Exit judged = tessera("verify");
  EXPECT_EQ(judged.code, 0) << judged.text;
  EXPECT_NE(judged.text.find("live_behaviours: holds"), std::string::npos) << judged.text;
  EXPECT_NE(judged.text.find("2 behaviours are reachable only after a failure: arm.control.limp (line 11), "
                             "arm.control.crawl (line 12)"),
            std::string::npos)
      << judged.text;
  const nlohmann::json report = json("verify");
  for (const nlohmann::json& property : report.at("properties"))
    if (property.at("name") == "live_behaviours") {
      EXPECT_EQ(property.at("verdict"), "holds");
      EXPECT_EQ(property.at("behaviours").size(), 2U);
    }
  write(folder_ / "spec.yaml", text + "        limp: { next: crawl }\n        crawl: {}\n");
  const project::Exit dead = tessera("verify");
  EXPECT_EQ(dead.code, 1) << "not even a failure leads to crawl\n" << dead.text;
  EXPECT_NE(dead.text.find("arm.control.crawl"), std::string::npos) << dead.text;
}

}  // namespace
}  // namespace tessera::cli_test
