#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "served.hpp"
#include "server/analysis/analysis.hpp"
#include "server/recordings/marking_tracker.hpp"
#include "server/recordings/recording_tail.hpp"
#include "tessera/poses.hpp"
#include "tessera/recording.hpp"

namespace tessera::server_test {

using nlohmann::json;

/// Recordings of the line follower, made by hand.
class RecordingOfTheStudio : public Served {
 protected:
  RecordingOfTheStudio() { analysis_ = server::analyse("spec.yaml", content_of(spec())); }

  [[nodiscard]] std::string header(std::uint64_t segment, const json& scene = {}) const {
    json transitions = json::array();
    for (const auto& transition : analysis_.net->transitions())
      transitions.push_back({transition.name, 0, "other"});
    json header{{"system", "line_follower"},
                {"net_hash", analysis_.net_hash},
                {"verification_hash", ""},
                {"seed", 1},
                {"clock", "steady"},
                {"instances", {"robot.control"}},
                {"channels", json::array()},
                {"transitions", transitions},
                {"values",
                 {{"limit", 4096},
                  {"buffers",
                   {{"robot.control.line", 0, "in", "{left: bool}"},
                    {"robot.control.memory.count", 0, "memory", "uint8"},
                    {"robot.control.memory.free", 0, "memory", "float64"}}}}}};
    if (!scene.is_null()) header["scene"] = scene;
    std::string text = header.dump();
    text.back() = ',';
    text += "\"segment\":" + std::to_string(segment) + "}";
    const auto length = static_cast<std::uint32_t>(text.size());
    std::string bytes(recording_magic);
    bytes.append(reinterpret_cast<const char*>(&length), sizeof length).append(text);
    bytes.resize((bytes.size() + 7) / 8 * 8);
    return bytes;
  }
  static std::string event(std::int64_t time_ns, Event::Kind kind, std::uint32_t subject,
                           const std::string& text = "", std::uint32_t version = 0) {
    const Event event{.time_ns = time_ns,
                      .subject = subject,
                      .version = version,
                      .origin = static_cast<std::uint32_t>(kind)};
    std::string bytes(reinterpret_cast<const char*>(&event), sizeof event);
    bytes += text;
    bytes.resize((bytes.size() + sizeof event - 1) / sizeof event * sizeof event);
    return bytes;
  }
  static std::string firing(std::int64_t time_ns, std::uint32_t transition) {
    return event(time_ns, Event::Kind::firing, transition);
  }
  static std::string marking(const std::string& places) {
    return event(0, Event::Kind::marking, static_cast<std::uint32_t>(places.size()), places);
  }
  /// goes_on: in the next segment.
  static std::string end(bool goes_on) {
    Event event{.version = goes_on ? 1U : 0U,
                .origin = 0xffffffU << 8U | static_cast<std::uint32_t>(Event::Kind::end)};
    return {reinterpret_cast<const char*>(&event), sizeof event};
  }
  static std::string value(const std::string& bytes) {
    return event(0, Event::Kind::value, static_cast<std::uint32_t>(bytes.size()), bytes);
  }
  static std::string memory(std::int64_t time_ns, char count) {
    return event(time_ns, Event::Kind::value, 1, std::string(1, count), 1);
  }
  [[nodiscard]] std::uint32_t transition(std::string_view name) const {
    const auto& all = analysis_.net->transitions();
    return static_cast<std::uint32_t>(
        std::ranges::find(all, name, [](const auto& one) -> std::string_view { return one.name; }) -
        all.begin());
  }
  [[nodiscard]] std::string name_of_place(std::uint32_t place) const {
    return analysis_.net->places()[place].name;
  }

  server::Analysis analysis_;
};

TEST_F(RecordingOfTheStudio, OneInSegmentsIsOneAndBeginsWithTheMarkingOfTheFirstThatIsLeft) {
  const fs::path last = folder_ / "project/.tessera/last";
  write(last / "recording.3.tsr", header(3) + marking(name_of_place(2) + "\n" + name_of_place(5)) +
                                      firing(10, 1) + firing(20, 2) + end(true));
  write(last / "recording.tsr",
        header(4) + marking(name_of_place(7)) + firing(30, 3) + value("\1") + end(false));
  write(folder_ / "project/run.tsr", header(0) + firing(10, 4));
  write(folder_ / "project/alone.7.tsr", header(7) + marking("nowhere"));
  serve();
  const json list = get("/api/recordings").json();
  std::map<std::string, json> by_name;
  for (const json& one : list) by_name[one.at("name")] = one;
  ASSERT_EQ(by_name.size(), 3U) << list;
  EXPECT_EQ(by_name.at("last").at("bytes"),
            fs::file_size(last / "recording.3.tsr") + fs::file_size(last / "recording.tsr"));
  EXPECT_DOUBLE_EQ(by_name.at("last").at("duration"), 30e-9);

  const json whole = get("/api/recordings/last").json();
  EXPECT_EQ(whole.at("marking"), json({2, 5}));
  EXPECT_EQ(whole.at("firings"), json({{10, 1}, {20, 2}, {30, 3}}));
  EXPECT_EQ(whole.at("values").at("robot.control.line.left"), json({{0, true}}));
  EXPECT_EQ(whole.at("truncated"), false);
  EXPECT_EQ(whole.at("cut"), false);
  EXPECT_EQ(whole.at("lacks_beginning"), true);
  EXPECT_EQ(get("/api/recordings/run.tsr").json().at("lacks_beginning"), false);
  EXPECT_EQ(get("/api/recordings/run.tsr").json().at("cut"), true);
  EXPECT_EQ(whole.at("path"), json::array());
  EXPECT_TRUE(whole.at("track").is_null());
  EXPECT_TRUE(get("/api/recordings/run.tsr").json().at("marking").is_null());
  EXPECT_EQ(get("/api/recordings/alone.7.tsr").json().at("marking"), json::array());
  // A part of a recording that is there has no page of its own.
  fs::copy_file(folder_ / "project/run.tsr", folder_ / "project/alone.tsr");
  EXPECT_EQ(get("/api/recordings/alone.7.tsr").status, 404);
}

TEST_F(RecordingOfTheStudio, SaysWhenInputsGotNewValuesAndWhereADeviceGivesNone) {
  const auto input = [](std::int64_t time_ns, std::uint32_t flags, std::int64_t written_ns, char left) {
    std::string bytes(reinterpret_cast<const char*>(&written_ns), sizeof written_ns);
    if ((flags & ValueFlags::same) == 0) bytes += left;
    return event(time_ns, Event::Kind::value, static_cast<std::uint32_t>(bytes.size()), bytes,
                 (flags | ValueFlags::stamped) << 24U);
  };
  constexpr std::uint32_t news = ValueFlags::valid | ValueFlags::fresh;
  write(folder_ / "project/run.tsr",
        header(0) + input(10, news, 4, 1) + input(20, ValueFlags::valid | ValueFlags::same, 4, 1) +
            input(30, news | ValueFlags::same, 28, 1) + input(40, ValueFlags::same, 28, 1) +
            event(50, Event::Kind::value, 0, "", ValueFlags::silent << 24U) + firing(60, 0) + end(false));
  serve();
  const json whole = get("/api/recordings/run.tsr").json();
  EXPECT_EQ(whole.at("arrivals"),
            json({{"robot.control.line", {{10, 4, true}, {30, 28, true}, {40, 28, false}}}}));
  const json& left = whole.at("values").at("robot.control.line.left");
  EXPECT_EQ(left.back(), json({50, nullptr})) << left;
  EXPECT_EQ(get("/api/recordings/run.tsr?from=35&to=100").json().at("arrivals"),
            json({{"robot.control.line", {{40, 28, false}}}}));
}

TEST_F(RecordingOfTheStudio, KeepsWhatTheUserSaysAboutIt) {
  const fs::path folder = folder_ / "project/.tessera/runs/20261128-101010-simulate-1";
  write(folder / "recording.tsr", header(0) + firing(10, 0) + end(false));
  serve();
  const std::string name = folder.filename().string(), path = "/api/recordings/" + name + "/notes";
  EXPECT_TRUE(get("/api/recordings").json().at(0).at("notes").is_null());
  const json notes{{"title", "slow \"start\""}, {"text", "two\nlines"}, {"revision", ""}};
  json given = notes;
  given["marks"] = {{{"t", 7}, {"text", "here"}}};
  const Reply kept = put(path, given);
  ASSERT_EQ(kept.status, 200) << kept.body;
  const json listed = get("/api/recordings").json().at(0).at("notes");
  EXPECT_EQ(listed, kept.json().at("notes"));
  EXPECT_EQ(listed.at("title"), "slow \"start\"");
  EXPECT_EQ(listed.at("marks"), json::array({{{"t", 7}, {"text", "here"}}}));
  EXPECT_TRUE(fs::exists(folder / "recording.tsr.notes.json"));
  // It is not removed when it is old.
  EXPECT_TRUE(fs::exists(folder / "keep"));
  // Another tab knows older notes.
  const Reply late = put(path, given);
  EXPECT_EQ(late.status, 409);
  EXPECT_EQ(late.json().at("notes"), listed);
  for (const auto& [member, wrong] :
       {std::pair<std::string, json>{"title", std::string(201, 'x')},
        {"title", "two\nlines"},
        {"text", std::string(10'001, 'x')},
        {"text", 7},
        {"marks", json::array({7})},
        {"marks", json::array({{{"t", "now"}, {"text", ""}}})},
        {"marks", json::array({{{"t", 7}, {"text", std::string(501, 'x')}}})}}) {
    json bad = given;
    bad["revision"] = listed.at("revision");
    bad[member] = wrong;
    EXPECT_EQ(put(path, bad).status, 400) << member;
  }
  EXPECT_EQ(put("/api/recordings/nothing/notes", given).status, 404);
  EXPECT_EQ(put("/api/recordings/..%2f..%2fspec.yaml/notes", given).status, 404);
  EXPECT_EQ(
      put(path, {{"title", ""}, {"text", ""}, {"revision", listed.at("revision")}, {"marks", json::array()}})
          .status,
      200);
  EXPECT_FALSE(fs::exists(folder / "recording.tsr.notes.json"));
  EXPECT_FALSE(fs::exists(folder / "keep"));
}

TEST_F(RecordingOfTheStudio, NotesOfOthersAndLinksAreNotReplaced) {
  write(folder_ / "project/run.tsr", header(0) + firing(10, 0) + end(false));
  write(folder_ / "project/run.tsr.notes.json", "by hand");
  write(folder_ / "elsewhere.json", "{}");
  serve();
  const json given{{"title", "x"}, {"text", ""}, {"marks", json::array()}, {"revision", "?"}};
  EXPECT_NE(get("/api/recordings").json().at(0).at("notes").at("problem"), "");
  EXPECT_EQ(put("/api/recordings/run.tsr/notes", given).status, 409);
  EXPECT_EQ(content_of(folder_ / "project/run.tsr.notes.json"), "by hand");
  fs::remove(folder_ / "project/run.tsr.notes.json");
  fs::create_symlink(folder_ / "elsewhere.json", folder_ / "project/run.tsr.notes.json");
  EXPECT_EQ(put("/api/recordings/run.tsr/notes", given).status, 409);
  EXPECT_EQ(content_of(folder_ / "elsewhere.json"), "{}");
}

TEST_F(RecordingOfTheStudio, FromAMomentOnHasTheMarkingAndTheValuesOfThatMoment) {
  const std::uint32_t first = transition("t_in"), second = transition("robot.t_in");
  write(folder_ / "project/run.tsr", header(0) + value("\1") + memory(5, 1) + firing(10, first) +
                                         memory(20, 2) + firing(40, second) + memory(50, 3) +
                                         firing(70, first));
  serve();
  const json whole = get("/api/recordings/run.tsr").json();
  EXPECT_TRUE(whole.at("marking").is_null());
  EXPECT_EQ(whole.at("values").at("robot.control.line.left"), json({{0, true}}));
  EXPECT_EQ(whole.at("values").at("robot.control.memory.count"), json({{5, 1}, {20, 2}, {50, 3}}));
  const json part = get("/api/recordings/run.tsr?from=40&to=60").json();
  EXPECT_EQ(part.at("values").at("robot.control.memory.count"), json({{40, 2}, {50, 3}}));
  EXPECT_EQ(part.at("firings"), json({{40, second}}));
  server::MarkingTracker tokens(*analysis_.net);
  tokens.fire({first});
  EXPECT_EQ(part.at("marking"), json(tokens.marked()));
  EXPECT_EQ(part.at("values").at("robot.control.line.left"), json({{40, true}}));
  for (const json& one : {whole, part}) {
    EXPECT_EQ(one.at("first"), 10);
    EXPECT_EQ(one.at("last"), 70);
    EXPECT_EQ(one.at("total"), 3);
  }
  // After its end, the last state stays.
  const json end = get("/api/recordings/run.tsr?from=100").json();
  EXPECT_EQ(end.at("firings"), json::array());
  EXPECT_EQ(end.at("values").at("robot.control.line.left"), json({{100, true}}));
}

TEST_F(RecordingOfTheStudio, NumbersThatJsonHasNotAreTexts) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::string events;
  for (const double free : {-infinite, infinite, std::numeric_limits<double>::quiet_NaN(), 0.5}) {
    std::string bytes(sizeof free, '\0');
    std::memcpy(bytes.data(), &free, sizeof free);
    events += event(10, Event::Kind::value, sizeof free, bytes, 2);
  }
  write(folder_ / "project/run.tsr", header(0) + events);
  serve();
  EXPECT_EQ(get("/api/recordings/run.tsr").json().at("values").at("robot.control.memory.free"),
            json::parse(R"([[10, "-inf"], [10, "inf"], [10, "nan"], [10, 0.5]])"));
}

TEST_F(RecordingOfTheStudio, HasThePathAndTheTrackOfItsRun) {
  const fs::path last = folder_ / "project/.tessera/last";
  PoseEncoder encoder(2);
  std::string events;
  std::vector<BodyPose> poses(2);
  poses[0].rotation = {std::cos(0.25), 0, 0, std::sin(0.25)};
  for (int point = 0; point < 50'000; ++point) {
    poses[0].position_m = {1e-3 * point, -2, 0};
    const std::string frame(encoder.encode(point * pose_period.count(), poses));
    Event head{.time_ns = point * pose_period.count(),
               .subject = static_cast<std::uint32_t>(frame.size()),
               .origin = system_instance << 8U | static_cast<std::uint32_t>(Event::Kind::poses)};
    events.append(reinterpret_cast<const char*>(&head), sizeof head).append(frame);
    events.resize((events.size() + sizeof head - 1) / sizeof head * sizeof head);
  }
  const json scene =
      json::parse(R"({"hash": "0123456789abcdef", "bodies": [["rover", "robot"], ["stone", ""]]})");
  write(last / "recording.tsr", header(0, scene) + events);
  write(last / "summary.json", R"({"track": "/somewhere/tracks/oval.png"})");
  serve();
  const json whole = get("/api/recordings/last").json();
  EXPECT_EQ(whole.at("track"), "oval.png");
  EXPECT_LE(whole.at("path").size(), 20'000U);
  EXPECT_GE(whole.at("path").size(), 10'000U);
  const json first = whole.at("path").front();
  EXPECT_EQ(first[0], 0);
  EXPECT_NEAR(first[2].get<double>(), -2, 1e-4);
  EXPECT_NEAR(first[3].get<double>(), 0.5, 1e-3);
  EXPECT_EQ(whole.at("path").back()[0], 49'999 * pose_period.count());
  EXPECT_NEAR(whole.at("path").back()[1].get<double>(), 49.999, 1e-4);
  const json part = get("/api/recordings/last?from=1000000000&to=1100000000").json();
  EXPECT_EQ(part.at("path").size(), 3U);
}

TEST_F(RecordingOfTheStudio, WhatIsBesideItMayBeAnything) {
  const fs::path last = folder_ / "project/.tessera/last";
  write(last / "recording.tsr", header(0) + firing(10, 1));
  serve();
  const std::vector<std::string> noise{"", std::string(3'000'000, '\xff'), "{\"track\":[]}", "[[[[",
                                       "{\"track\":\"..\"}"};
  for (const std::string& one : noise) {
    write(last / "summary.json", one);
    const Reply reply = get("/api/recordings/last");
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.json().at("path"), json::array());
  }
}

TEST_F(RecordingOfTheStudio, IsFollowedFromSegmentToSegment) {
  std::vector<GrowingRecording::Piece> pieces;
  server::RecordingTail tail(
      [&] {
        if (pieces.empty()) return GrowingRecording::Piece{};
        GrowingRecording::Piece piece = pieces.front();
        pieces.erase(pieces.begin());
        piece.more = !pieces.empty();
        return piece;
      },
      *analysis_.net);
  EXPECT_TRUE(tail.next().firings.empty());
  const std::string first = header(7) + marking(name_of_place(2)) + value("\1");
  pieces = {{first.substr(0, 100), true, false}, {first.substr(100), false, false}};
  EXPECT_TRUE(tail.next().jumped);
  EXPECT_EQ(tail.marking(), std::vector<std::uint32_t>{2});

  // The value was not taken before the next segment began, which does not repeat it.
  pieces = {{header(9) + marking(name_of_place(5)) + firing(40, 1), true, false}};
  const server::RecordingTail::Batch batch = tail.next();
  EXPECT_TRUE(batch.jumped);
  EXPECT_EQ(batch.firings.size(), 1U);
  EXPECT_EQ(tail.take_changed_values(), json::parse(R"({"robot.control.line": {"left": true}})"));
  EXPECT_EQ(tail.take_changed_values(), json::object());

  pieces = {{value(std::string(1, '\0')) + firing(50, 2), false, false}};
  EXPECT_FALSE(tail.next().jumped);
  EXPECT_EQ(tail.take_changed_values(0), json::object());
  EXPECT_EQ(tail.take_changed_values(1), json::parse(R"({"robot.control.line": {"left": false}})"));

  pieces = {{memory(60, 9), false, false}};
  EXPECT_FALSE(tail.next().jumped);
  EXPECT_EQ(tail.take_changed_values(), json::parse(R"({"robot.control.memory.count": 9})"));

  pieces = {{"damaged for ever and ever", false, false}, {firing(60, 1), false, false}};
  EXPECT_TRUE(tail.next().firings.empty());
}

}  // namespace tessera::server_test
