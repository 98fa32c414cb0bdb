#include <gmock/gmock.h>

#include <algorithm>

#include "served.hpp"

namespace tessera::server_test {

using nlohmann::json;

class Sources : public Served {
 protected:
  [[nodiscard]] json function(const std::string& text, const std::string& name) const {
    const json all = post("/api/functions", {{"text", text}}).json();
    const auto found = std::ranges::find_if(all, [&](const json& one) { return one.at("function") == name; });
    return found == all.end() ? json(nullptr) : *found;
  }
  [[nodiscard]] fs::path project() const { return spec().parent_path(); }
};

TEST_F(Sources, TheFunctionOfABehaviourIsFoundReadAndSaved) {
  serve();
  const json follow = function(content_of(spec()), "follow");
  ASSERT_EQ(follow.at("state"), "defined") << follow;
  ASSERT_EQ(follow.at("file"), "src/control.cpp");
  EXPECT_TRUE(follow.at("line").is_number_integer());
  const json before = get("/api/sources?file=src/control.cpp").json();
  EXPECT_EQ(before.at("text"), content_of(project() / "src/control.cpp"));
  const std::string text = before.at("text").get<std::string>() + "// more\n";
  const json body{{"file", "src/control.cpp"}, {"text", text}, {"revision", before.at("revision")}};
  EXPECT_EQ(put("/api/sources", body).status, 200);
  EXPECT_EQ(content_of(project() / "src/control.cpp"), text);
  // The revision is that of the text before: another program may have written since.
  EXPECT_EQ(put("/api/sources", body).status, 409);
}

TEST_F(Sources, AMissingFunctionIsAddedOnce) {
  serve();
  std::string text = content_of(spec());
  text.replace(text.find("        follow: {}"), 18, "        follow: {}\n        rest: {}");
  ASSERT_EQ(function(text, "rest").at("state"), "missing");
  const json wanted{{"text", text}, {"subsystem", "robot.control"}, {"function", "rest"}};
  EXPECT_EQ(post("/api/functions/add", wanted).json().at("file"), "src/control.cpp");
  EXPECT_EQ(function(text, "rest").at("state"), "defined");
  const std::string once = content_of(project() / "src/control.cpp");
  EXPECT_EQ(post("/api/functions/add", wanted).status, 200);
  EXPECT_EQ(content_of(project() / "src/control.cpp"), once);
  const json unknown{{"text", text}, {"subsystem", "robot.control"}, {"function", "dance"}};
  EXPECT_EQ(post("/api/functions/add", unknown).status, 409);
}

TEST_F(Sources, AFunctionGetsTheNameThatItsBehaviourHasNow) {
  serve();
  write(project() / "test/control_test.cpp",
        "namespace line_follower::robot::control {\nvoid twice() { follow(1); }  // follow\n}\n");
  std::string text = content_of(spec());
  text.replace(text.find("        follow: {}"), 18, "        pursue: {}");
  text.replace(text.find("next: follow"), 12, "next: pursue");
  const json missing = function(text, "pursue");
  ASSERT_EQ(missing.at("state"), "missing") << missing;
  EXPECT_EQ(missing.at("leftovers"), json::array({"follow"}));
  const std::string before = content_of(project() / "src/control.cpp");
  const json wanted{
      {"text", text}, {"subsystem", "robot.control"}, {"from", "follow"}, {"function", "pursue"}};
  const Reply renamed = post("/api/functions/rename", wanted);
  ASSERT_EQ(renamed.status, 200) << renamed.body;
  EXPECT_THAT(renamed.json().at("files").get<std::vector<std::string>>(),
              testing::UnorderedElementsAre("src/control.cpp", "test/control_test.cpp"));
  std::string after = before;
  after.replace(after.find("void follow("), 12, "void pursue(");
  EXPECT_EQ(content_of(project() / "src/control.cpp"), after);
  EXPECT_EQ(function(text, "pursue").at("state"), "defined");
  EXPECT_EQ(post("/api/functions/rename", wanted).status, 409) << "there is no function follow any more";
}

TEST_F(Sources, TheWorldTellsWhatDriversMayName) {
  serve();
  const json targets = post("/api/world", {{"text", content_of(spec())}}).json().at("targets");
  EXPECT_EQ(targets.at("velocity"), json::array({"wheel_left", "wheel_right"}));
  EXPECT_EQ(targets.at("reflectance"), json::array({"eye_left", "eye_middle", "eye_right"}));
  EXPECT_EQ(targets.at("place"), json::array({"robot"}));
  EXPECT_EQ(targets.at("mocap"), json::array());
}

TEST_F(Sources, NothingOutsideOfTheSourcesIsReadOrWritten) {
  serve();
  write(folder_ / "secret.cpp", "// not of this project\n");
  fs::create_symlink(folder_ / "secret.cpp", project() / "src/link.cpp");
  fs::create_directory_symlink(folder_, project() / "src/away");
  for (const char* file :
       {"spec.yaml", "../secret.cpp", "src/../../secret.cpp", "src/link.cpp", "src/away/secret.cpp",
        "/etc/passwd", "src/.hidden.cpp", "src/notes.txt", "src", ""}) {
    EXPECT_EQ(get(std::string("/api/sources?file=") + file).status, 404) << file;
    EXPECT_EQ(put("/api/sources", {{"file", file}, {"text", "x"}, {"revision", ""}}).status, 404) << file;
  }
  EXPECT_EQ(content_of(folder_ / "secret.cpp"), "// not of this project\n");
}

TEST_F(Sources, AnExampleIsCopiedIntoAProjectThatHasNotBegun) {
  write(folder_ / "share/examples/tiny/spec.yaml", "# A tiny one. And more.\ntessera: 1\n");
  write(folder_ / "share/examples/tiny/src/control.cpp", "// theirs\n");
  write(folder_ / "share/examples/tiny/src/other.cpp", "// other\n");
  write(folder_ / "share/examples/tiny/README.md", "no part of it\n");
  options_.share = folder_ / "share";
  serve();
  EXPECT_EQ(get("/api/examples").json(), json::parse(R"([{"name": "tiny", "title": "A tiny one."}])"));
  EXPECT_EQ(post("/api/begin", {{"example", "tiny"}}).status, 409) << "the project has a specification";
  write(spec(), "");
  EXPECT_EQ(post("/api/begin", {{"example", "../tiny"}}).status, 409);
  const std::string own = content_of(project() / "src/control.cpp");
  const json begun = post("/api/begin", {{"example", "tiny"}}).json();
  EXPECT_EQ(begun.at("files"), json::array({"src/other.cpp", "spec.yaml"})) << begun;
  EXPECT_EQ(begun.at("kept"), json::array({"src/control.cpp"}));
  EXPECT_EQ(content_of(project() / "src/control.cpp"), own);
  EXPECT_FALSE(fs::exists(project() / "README.md") &&
               content_of(project() / "README.md") == "no part of it\n");
}

}  // namespace tessera::server_test
