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

TEST_F(Sources, ARenameTellsWhatItChangesInOtherFilesAndWritesNothing) {
  serve();
  write(project() / "params.yaml", "v: 0.1   # slow\n");
  const std::string text = content_of(spec()), code = content_of(project() / "src/control.cpp");
  const auto rename = [&](const json& at, const char* to) {
    return post("/api/edit", {{"text", text}, {"edit", {{"do", "rename"}, {"at", at}, {"text", to}}}});
  };
  const json found = rename({"agents", "robot", "control", "behaviours", "follow"}, "pursue").json();
  EXPECT_EQ(found.at("edits").size(), 2U) << found;
  ASSERT_EQ(found.at("files").at(0).at("file"), "src/control.cpp");
  EXPECT_THAT(found.at("files").at(0).at("after").get<std::string>(), testing::HasSubstr("void pursue("));
  EXPECT_EQ(found.at("files").at(0).at("before"), code);
  EXPECT_EQ(content_of(project() / "src/control.cpp"), code) << "nothing is written";
  const json parameter = rename({"parameters", "v"}, "speed").json();
  EXPECT_EQ(parameter.at("files").at(0).at("file"), "params.yaml");
  EXPECT_EQ(parameter.at("files").at(0).at("after"), "speed: 0.1   # slow\n");
  const Reply taken = rename({"agents", "robot", "control", "behaviours", "follow"}, "init");
  EXPECT_EQ(taken.status, 422);
  EXPECT_THAT(taken.json().at("error").get<std::string>(), testing::HasSubstr("is taken"));
  const json nothing{{"do", "set"}, {"at", {"nowhere", 3}}, {"key", "x"}, {"text", "1"}};
  EXPECT_EQ(post("/api/edit", {{"text", text}, {"edit", nothing}}).status, 422);
  for (const json& wrong :
       {json("set"), json::array(), json{{"do", "dance"}}, json{{"do", "set"}, {"at", 5}}})
    EXPECT_EQ(post("/api/edit", {{"text", text}, {"edit", wrong}}).status, 400) << wrong;
}

TEST_F(Sources, FilesAreWrittenAllOrNone) {
  serve();
  const std::string text = content_of(spec()), code = content_of(project() / "src/control.cpp");
  write(project() / "test/more.cpp", "// more\n");
  const auto revision = [&](const char* file) {
    return get(std::string("/api/sources?file=") + file).json().at("revision");
  };
  const json own{{"file", "spec.yaml"},
                 {"text", text + "# mine\n"},
                 {"revision", get("/api/spec").json().at("revision")}};
  const auto with = [&](const json& other) {
    return post("/api/files", {{"files", json::array({own, other})}});
  };
  write(folder_ / "secret.cpp", "// not of this project\n");
  fs::create_symlink(folder_ / "secret.cpp", project() / "src/link.cpp");
  for (const char* file :
       {"../secret.cpp", "src/link.cpp", "test/../../secret.cpp", "/etc/passwd", "project.cmake"})
    EXPECT_EQ(with({{"file", file}, {"text", "x"}, {"revision", ""}}).status, 409) << file;
  const json late{{"file", "src/control.cpp"}, {"text", "x"}, {"revision", "of another text"}};
  EXPECT_EQ(with(late).status, 409);
  EXPECT_EQ(content_of(spec()), text) << "the other file was not written either";
  EXPECT_EQ(post("/api/files", {{"files", {{{"file", "spec.yaml"}}}}}).status, 400);
  const Reply done =
      post("/api/files", {{"files", json::array({own,
                                                 {{"file", "src/control.cpp"},
                                                  {"text", code + "// 1\n"},
                                                  {"revision", revision("src/control.cpp")}},
                                                 {{"file", "test/more.cpp"},
                                                  {"text", "// 2\n"},
                                                  {"revision", revision("test/more.cpp")}}})}});
  ASSERT_EQ(done.status, 200) << done.body;
  EXPECT_EQ(done.json().at("files").size(), 3U);
  EXPECT_EQ(content_of(spec()), text + "# mine\n");
  EXPECT_EQ(content_of(project() / "src/control.cpp"), code + "// 1\n");
  EXPECT_EQ(content_of(project() / "test/more.cpp"), "// 2\n");
  EXPECT_EQ(done.json().at("files").at(0).at("revision"), get("/api/spec").json().at("revision"));
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
