// The file with the positions of boxes that a user has moved.

#include <gmock/gmock.h>

#include "served.hpp"
#include "server/analysis/arrangement.hpp"
#include "server/analysis/layout_file.hpp"

namespace tessera::server_test {

using nlohmann::json;
using testing::HasSubstr;

class Layout : public Served {
 protected:
  [[nodiscard]] fs::path file() const { return spec().parent_path() / ".tessera-layout.json"; }
  [[nodiscard]] json now() const { return get("/api/layout").json(); }
  [[nodiscard]] Reply move(const json& boxes, const std::string& revision) const {
    return put("/api/layout", {{"boxes", boxes}, {"revision", revision}});
  }
};

TEST_F(Layout, HasALineForEachBoxInOrder) {
  serve();
  const json none = now();
  EXPECT_TRUE(none.at("boxes").empty());
  EXPECT_TRUE(none.at("error").is_null());
  EXPECT_FALSE(fs::exists(file())) << "nothing was moved";
  EventStream events(port_, token_);
  static_cast<void>(events.next("hello"));
  const Reply written =
      move({{"robot.sensor", {-4.4, 7}}, {"robot", {1, 2.5}}, {"desk", {0, 1e6}}}, none.at("revision"));
  ASSERT_EQ(written.status, 200) << written.body;
  EXPECT_EQ(content_of(file()),
            "{\n  \"desk\": [0, 1000000],\n  \"robot\": [1, 3],\n  \"robot.sensor\": [-4, 7]\n}\n");
  EXPECT_EQ(events.next("layout").at("revision"), written.json().at("revision"));
  EXPECT_EQ(now().at("boxes"), (json{{"desk", {0, 1000000}}, {"robot", {1, 3}}, {"robot.sensor", {-4, 7}}}));
  EXPECT_EQ(move(json::object(), written.json().at("revision")).status, 200);
  EXPECT_FALSE(fs::exists(file())) << "the drawing is automatic again";
}

TEST_F(Layout, ThatAnotherProgramHasChangedStays) {
  serve();
  const json before = now();
  write(file(), "{ \"robot\": [5, 6] }\n");
  EXPECT_EQ(move({{"robot", {1, 1}}}, before.at("revision")).status, 409);
  EXPECT_EQ(move(json::object(), before.at("revision")).status, 409);
  EXPECT_EQ(content_of(file()), "{ \"robot\": [5, 6] }\n");
  EXPECT_EQ(now().at("boxes"), (json{{"robot", {5, 6}}}));
}

TEST_F(Layout, ThatIsNotUnderstoodIsToldAndStays) {
  serve();
  for (const auto& [text, why] : std::map<std::string, std::string>{{"{\n  \"robot\": [1,\n}\n", "line 3"},
                                                                    {"[]", "no object"},
                                                                    {"{ \"robot\": [1, 2, 3] }", "'robot'"},
                                                                    {"{ \"robot\": [1, \"2\"] }", "'robot'"},
                                                                    {"{ \"robot\": [1, 1e9] }", "'robot'"},
                                                                    {"{ \"../x\": [1, 2] }", "'../x'"},
                                                                    {"{ \"a.b.c\": [1, 2] }", "'a.b.c'"},
                                                                    {"{ \"\xff\": [1, 2] }", "line 1"},
                                                                    {std::string(2'000'000, ' '), "1 MB"}}) {
    write(file(), text);
    const json shown = now();
    EXPECT_TRUE(shown.at("boxes").empty()) << text.substr(0, 40);
    EXPECT_THAT(shown.at("error").get<std::string>(), HasSubstr(why));
    EXPECT_EQ(move({{"robot", {1, 1}}}, server::revision_of("")).status, 409);
    EXPECT_EQ(content_of(file()), text);
  }
}

TEST_F(Layout, IsWrittenToNoOtherFile) {
  serve();
  const fs::path other = spec().parent_path() / "other.json";
  write(other, "{}\n");
  const std::string revision = now().at("revision");
  fs::create_symlink(other, file());
  EXPECT_THAT(now().at("error").get<std::string>(), HasSubstr("symbolic link"));
  EXPECT_EQ(move({{"robot", {1, 1}}}, server::revision_of("{}\n")).status, 500);
  EXPECT_EQ(move({{"robot", {1, 1}}}, revision).status, 500);
  EXPECT_EQ(content_of(other), "{}\n");
}

TEST_F(Layout, TakesNothingButPositions) {
  serve();
  const std::string revision = now().at("revision");
  const json many = [] {
    json boxes;
    for (int at = 0; at < 50'000; ++at) boxes["a_box_with_a_long_name_" + std::to_string(at)] = {at, at};
    return boxes;
  }();
  for (const json& boxes :
       {json(1), json::array(), json{{"robot", 1}}, json{{"robot", {1}}}, json{{"robot", {nullptr, 1}}},
        json{{"robot\n", {1, 1}}}, json{{"", {1, 1}}}, many})
    EXPECT_EQ(
        ask_with(own_headers(), "PUT", "/api/layout", json{{"boxes", boxes}, {"revision", revision}}.dump())
            .status,
        400)
        << boxes.dump().substr(0, 80);
  EXPECT_FALSE(fs::exists(file()));
}

TEST_F(Layout, OfThePanelsIsThereForTheNextServerAndForThisProjectAlone) {
  serve();
  EXPECT_TRUE(get("/api/arrangement").json().at("entries").empty());
  const auto keep = [&](const json& name, const json& text) {
    return put("/api/arrangement", {{"name", name}, {"text", text}});
  };
  EXPECT_EQ(keep("panels", "first").json().at("kept"), true);
  EXPECT_EQ(keep("panels", "{\"closed\": [\"play\"]}").json().at("kept"), true);
  EXPECT_EQ(keep("plots", "\xc3\xbc").json().at("kept"), true);
  EXPECT_FALSE(fs::exists(spec().parent_path() / ".tessera")) << "it belongs to the user, not to the project";
  const json kept{{"panels", "{\"closed\": [\"play\"]}"}, {"plots", "\xc3\xbc"}};
  serve();
  EXPECT_EQ(get("/api/arrangement").json().at("entries"), kept);
  server::Arrangement other(spec().parent_path() / "other.yaml");
  EXPECT_TRUE(other.read().empty());
}

TEST_F(Layout, OfThePanelsTakesNothingThatIsTooLarge) {
  serve();
  const auto status = [&](const json& name, const json& text) {
    const std::string body = json{{"name", name}, {"text", text}}.dump();
    return ask_with(own_headers(), "PUT", "/api/arrangement", body).status;
  };
  for (const json& name : {json(1), json(""), json("../x"), json(std::string(41, 'x'))})
    EXPECT_EQ(status(name, "x"), 400) << name;
  EXPECT_EQ(status("panels", std::string(65'537, 'x')), 400);
  EXPECT_EQ(status("panels", nullptr), 400);
  for (std::size_t count = 0; count < server::Arrangement::most_names; ++count)
    EXPECT_EQ(
        put("/api/arrangement", {{"name", std::string(count + 1, 'n')}, {"text", ""}}).json().at("kept"),
        true);
  EXPECT_EQ(put("/api/arrangement", {{"name", "one_more"}, {"text", ""}}).json().at("kept"), false);
}

}  // namespace tessera::server_test
