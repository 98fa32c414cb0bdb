#include "running.hpp"
#include "tessera/recording.hpp"

namespace tessera::server_test {

TEST_F(RunOfTheStudio, ShowsTokensValuesAndThePathPausesStepsAndLeavesARecording) {
  const std::string run = start({{"kind", "simulate"}, {"for", "1000s"}, {"speed", 10}});
  ASSERT_FALSE(await_state(run, "running").is_null());

  const json firings = events_->next("firings");
  ASSERT_FALSE(firings.is_null());
  EXPECT_EQ(firings.at("run"), run);
  EXPECT_FALSE(firings.at("firings").empty());
  // The first values are the initial ones, before any receptor was read.
  const json value = events_->next("values", [](const json& data) {
    return data.at("values").contains("robot.sensor.line") &&
           data.at("values").contains("robot.control.motion");
  });
  ASSERT_FALSE(value.is_null());
  EXPECT_TRUE(value.at("values").at("robot.sensor.line").at("middle").is_boolean()) << value;
  EXPECT_TRUE(value.at("values").at("robot.control.motion").at("linear").is_number());
  const json first = events_->next("pose"),
             later = events_->next("pose", [](const json&data) { return data.at("t") > 3'000'000'000; });
  EXPECT_NE(first.at("x"), later.at("x"));
  const json path = info(run).at("path");
  ASSERT_GT(path.size(), 10U);
  EXPECT_EQ(path.front()[0], 0);
  EXPECT_GE(path.back()[0], later.at("t"));

  ASSERT_EQ(control(run, {{"command", "pause"}}), 200);
  ASSERT_FALSE(await_state(run, "paused").is_null());
  // The shown values are those that the buffers hold at this moment.
  const std::string recorded = get("/api/recordings").json().at(0).at("name");
  const json samples = get("/api/recordings/" + recorded).json().at("values");
  EXPECT_EQ(info(run).at("values").at("robot.control.motion").at("linear"),
            samples.at("robot.control.motion.linear").back()[1]);
  EXPECT_EQ(info(run).at("values").at("robot.control.motion").at("angular"),
            samples.at("robot.control.motion.angular").back()[1]);

  // A step is one firing, seen by everybody.
  ASSERT_EQ(control(run, {{"command", "step_firing"}}), 200);
  const std::int64_t rest = info(run).at("t");
  const json step = events_->next("firings", [&](const json& data) { return data.at("t") >= rest; });
  EXPECT_FALSE(step.is_null());

  const std::uint32_t called = place("robot.control.follow.in");
  ASSERT_EQ(control(run, {{"command", "breakpoints"}, {"breakpoints", {{{"place", called}}}}}), 200);
  ASSERT_EQ(control(run, {{"command", "resume"}}), 200);
  const json broken = events_->next("run", [&](const json& data) {
    return data.at("state") == "paused" && !data.at("why").get<std::string>().empty();
  });
  EXPECT_THAT(broken.at("why").get<std::string>(), HasSubstr("robot.control.follow.in"));
  EXPECT_THAT(info(run).at("marking").get<std::vector<std::uint32_t>>(), testing::Contains(called));

  ASSERT_EQ(control(run, {{"command", "stop"}}), 200);
  const json ended = await_state(run, "ended");
  ASSERT_TRUE(ended.at("outcome").is_object()) << ended;
  EXPECT_EQ(ended.at("outcome").at("ended"), "SIGINT");
  EXPECT_EQ(control(run, {{"command", "resume"}}), 409);

  const json list = get("/api/recordings").json();
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].at("system"), "line_follower");
  EXPECT_GT(list[0].at("duration").get<double>(), 3);
  const std::string name = list[0].at("name");
  const json recording = get("/api/recordings/" + name).json();
  EXPECT_EQ(recording.at("net_hash"), get("/api/spec").json().at("analysis").at("net_hash"));
  ASSERT_GT(recording.at("firings").size(), 100U);
  EXPECT_TRUE(recording.at("marking").is_null());
  EXPECT_GT(recording.at("path").size(), path.size());
  EXPECT_TRUE(recording.at("track").is_string());
  const json part = get("/api/recordings/" + name + "?from=1000000000&to=2000000000").json();
  ASSERT_FALSE(part.at("firings").empty());
  EXPECT_GE(part.at("firings").front()[0], 1'000'000'000);
  EXPECT_LE(part.at("firings").back()[0], 2'000'000'000);
  const json& speed = part.at("values").at("robot.control.motion.linear");
  ASSERT_FALSE(speed.empty());
  EXPECT_GE(speed.front()[0], 1'000'000'000);
  EXPECT_LE(speed.back()[0], 2'000'000'000);
  EXPECT_TRUE(speed.front()[1].is_number()) << speed.front();
  EXPECT_TRUE(recording.at("values").at("robot.control.line.middle").front()[1].is_boolean());
}

TEST_F(RunOfTheStudio, ParametersAreShownAndChangedWhileItRuns) {
  const std::string run = start({{"kind", "simulate"}, {"for", "1000s"}, {"speed", 10}});
  ASSERT_FALSE(await_state(run, "running").is_null());
  const auto held = [](const json& rows, const std::string& path) {
    for (const json& row : rows)
      if (row.at("path") == path) return row;
    return json(nullptr);
  };
  const json begun = info(run);
  const json speed = held(begun.at("parameters"), "v");
  ASSERT_FALSE(speed.is_null()) << begun.at("parameters");
  EXPECT_EQ(speed.at("value"), "0.2");
  EXPECT_EQ(speed.at("unit"), "m/s");
  EXPECT_FALSE(speed.at("differs").get<bool>());
  EXPECT_EQ(held(begun.at("parameters"), "robot.motor.r").at("value"), "0.03");

  const auto set = [&](const std::string& path, const std::string& text) {
    return control(run, {{"command", "set"}, {"path", path}, {"text", text}});
  };
  ASSERT_EQ(set("v", "0.15"), 200);
  ASSERT_EQ(set("robot.motor.r", "0.04"), 200);
  // The page shows the values that the recording reports as taken, not the requested ones.
  EXPECT_FALSE(events_
                   ->next("parameters",
                          [&](const json& data) {
                            return held(data.at("parameters"), "v").at("value") == "0.15" &&
                                   held(data.at("parameters"), "robot.motor.r").at("value") == "0.04";
                          })
                   .is_null());
  const json changed = info(run);
  EXPECT_EQ(held(changed.at("parameters"), "v").at("value"), "0.15");
  // The robot drives slower.
  EXPECT_FALSE(events_
                   ->next("values",
                          [](const json& data) {
                            const json& values = data.at("values");
                            return values.contains("robot.control.motion") &&
                                   values.at("robot.control.motion").at("linear") == 0.15;
                          })
                   .is_null());
  EXPECT_EQ(set("v", "fast"), 409);
  EXPECT_EQ(set("robot.control.nothing", "1"), 409);
  EXPECT_EQ(control(run, {{"command", "set"}}), 409);
  EXPECT_EQ(held(info(run).at("parameters"), "v").at("value"), "0.15");
  ASSERT_EQ(control(run, {{"command", "stop"}}), 200);
  ASSERT_FALSE(await_state(run, "ended").is_null());
}

TEST_F(RunOfTheStudio, SkipsToAMomentAndPausesThere) {
  const json asked{{"kind", "simulate"}, {"for", "100s"}, {"speed", 1}, {"paused", true}, {"skip_to", 42.5}};
  const std::string run = start(asked);
  ASSERT_FALSE(await_state(run, "running").is_null());
  ASSERT_FALSE(await_state(run, "paused").is_null());
  // All events before the moment have happened, and none after it.
  const json there = info(run);
  EXPECT_LE(there.at("t"), 42'500'000'000);
  EXPECT_GT(there.at("t"), 42'300'000'000);
  const json values = there.at("values");
  const std::uint64_t firings = there.at("firings");
  ASSERT_EQ(control(run, {{"command", "step_firing"}}), 200);
  EXPECT_FALSE(
      events_->next("firings", [&](const json& data) { return data.at("total") == firings + 1; }).is_null());
  ASSERT_EQ(control(run, {{"command", "stop"}}), 200);
  ASSERT_FALSE(await_state(run, "ended").is_null());
  // The same run again comes to the same place.
  const std::string again = start(asked);
  ASSERT_FALSE(await_state(again, "paused").is_null());
  EXPECT_EQ(info(again).at("firings"), firings);
  EXPECT_EQ(info(again).at("values"), values);
  ASSERT_EQ(control(again, {{"command", "stop"}}), 200);
  json late = asked;
  late["skip_to"] = 100;
  EXPECT_EQ(post("/api/runs", late).status, 400);
}

TEST_F(RunOfTheStudio, WhatTheCompilerSaysReachesThePage) {
  const fs::path source = folder_ / "project/src/control.cpp";
  write(source, content_of(source) + "\nint broken = \"text\";\n");
  const std::string run = start({{"kind", "simulate"}});
  const json line = events_->next("build", [](const json& data) {
    return data.at("line").get<std::string>().find("error") != std::string::npos;
  });
  EXPECT_THAT(line.at("line").get<std::string>(), HasSubstr("control.cpp"));
  EXPECT_THAT(await_state(run, "failed").at("why").get<std::string>(), HasSubstr("control.cpp"));
}

TEST_F(RunOfTheStudio, RefusesWhatItCannotStart) {
  for (const json& request : std::vector<json>{{{"kind", "fly"}},
                                               {{"speed", -1}},
                                               {{"speed", "fast"}},
                                               {{"for", "soon"}},
                                               {{"track", "../secret.png"}},
                                               {{"track", "/etc/passwd"}},
                                               {{"world", "nowhere.xml"}}})
    EXPECT_EQ(post("/api/runs", request).status, 400) << request;
  write(spec(), "tessera: 1");
  EXPECT_EQ(post("/api/runs", {{"kind", "simulate"}}).status, 422);
  EXPECT_EQ(get("/api/runs/1").status, 404);
  EXPECT_EQ(control("1", {{"command", "stop"}}), 404);
}

TEST_F(RunOfTheStudio, OnlyOneRunAtATimeDrivesTheDevices) {
  const json request{
      {"kind", "run"}, {"world", get("/api/project").json().at("worlds").at(0).at("name")}, {"for", "1000s"}};
  const std::string first = start(request);
  ASSERT_FALSE(await_state(first, "running").is_null());
  const Reply second = post("/api/runs", request);
  EXPECT_EQ(second.status, 409);
  EXPECT_THAT(second.body, HasSubstr("run " + first + " goes on"));

  // The emergency stop is that of the command line: it holds until the reset.
  const auto driving = [&](bool stopped) {
    return events_->next("driving", [&](const json& data) {
      const json& all = data.at("controllers");
      return all.size() == 1 && all[0].at("answers") == true && all[0].at("emergency").is_null() != stopped;
    });
  };
  ASSERT_FALSE(driving(false).is_null());
  const json stopped = post("/api/emergency_stop", json::object()).json();
  EXPECT_EQ(stopped.at("done"), true) << stopped;
  EXPECT_THAT(stopped.at("lines").at(0).get<std::string>(), testing::EndsWith(": emergency stop"));
  const json seen = driving(true);
  ASSERT_FALSE(seen.is_null());
  EXPECT_EQ(seen, get("/api/driving").json());
  const std::string name = seen.at("controllers").at(0).at("name");
  EXPECT_EQ(post("/api/emergency_reset", {{"controller", "--help"}}).status, 404);
  EXPECT_EQ(post("/api/emergency_reset", {{"controller", name}}).json().at("done"), true);
  EXPECT_FALSE(driving(false).is_null());
  ASSERT_EQ(control(first, {{"command", "stop"}}), 200);
  ASSERT_FALSE(await_state(first, "ended").is_null());
  const std::string third = start(request);
  ASSERT_EQ(control(third, {{"command", "stop"}}), 200);
  EXPECT_FALSE(await_state(third, "ended").is_null());
}

TEST_F(RunOfTheStudio, AttachesToAControllerThatSomebodyElseHasStartedAndLetsGoOfIt) {
  Elsewhere other({TESSERA_BINARY_DIR "/tessera", "run", (folder_ / "project").string(), "--world",
                   "--record-limit", "30kBx3"});
  const std::string socket = await_controller();
  EXPECT_THAT(socket, testing::StartsWith("line_follower."));
  const fs::path recording = folder_ / "project/.tessera/last/recording.tsr";
  const auto await_segment = [&](std::uint64_t number) {
    ASSERT_TRUE(eventually([&] { return fs::exists(segment_path(recording.string(), number)); },
                           [&] { return !other.runs(); }));
  };
  await_segment(2);
  const std::string run = start({{"kind", "attach"}, {"socket", socket}});
  ASSERT_FALSE(await_state(run, "running").is_null());
  // The first one may say where the segment begins only.
  EXPECT_FALSE(
      events_->next("firings", [](const json& data) { return !data.at("firings").empty(); }).is_null());
  // So may the values: a segment begins with none.
  EXPECT_FALSE(
      events_->next("values", [](const json& data) { return !data.at("values").empty(); }).is_null());
  const json shown = events_->next("subsystems");
  EXPECT_EQ(shown.at("run"), run);
  EXPECT_TRUE(shown.at("subsystems").at(0).at("iterations").is_number());
  EXPECT_FALSE(events_->next("pose").is_null());
  // On and on in the next segment.
  const std::int64_t before = info(run).at("t");
  await_segment(5);
  EXPECT_FALSE(
      events_->next("firings", [&](const json& data) { return data.at("t") > before + 1'000'000'000; })
          .is_null());
  const json info_of_run = info(run);
  EXPECT_FALSE(info_of_run.at("marking").empty());
  EXPECT_FALSE(info_of_run.at("path").empty());
  EXPECT_EQ(info_of_run.at("kind"), "attach");
  EXPECT_EQ(control(run, {{"command", "pause"}}), 409);

  ASSERT_EQ(control(run, {{"command", "stop"}}), 200);
  EXPECT_THAT(await_state(run, "ended").at("why").get<std::string>(), HasSubstr("runs on"));
  EXPECT_THAT(get("/api/controllers").json().get<std::vector<std::string>>(), testing::Contains(socket));
  EXPECT_THAT(other.stop(), HasSubstr("SIGINT"));

  const Reply gone = post("/api/runs", {{"kind", "attach"}, {"socket", socket}});
  EXPECT_EQ(gone.status, 400);
  EXPECT_THAT(gone.body, HasSubstr("no program listens"));
  EXPECT_EQ(post("/api/runs", {{"kind", "attach"}, {"socket", "../x.sock"}}).status, 400);
}

TEST_F(RunOfTheStudio, ARecordingThatIsElsewhereComesThroughTheControlSocketToItsEnd) {
  const fs::path recording = folder_ / "elsewhere.tsr";
  Elsewhere other({TESSERA_BINARY_DIR "/tessera", "run", (folder_ / "project").string(), "--world",
                   "--record", recording.string()});
  const std::string run = start({{"kind", "attach"}, {"socket", await_controller()}});
  ASSERT_FALSE(await_info(run, [](const json& now) {
                 return now.at("values").contains("robot.control.motion") && !now.at("marking").empty();
               }).is_null());
  std::size_t shown = 0;
  const auto show = [&](std::size_t wanted) {
    return !events_
                ->next("firings",
                       [&](const json& data) {
                         shown += data.at("firings").size() + data.at("dropped").get<std::size_t>();
                         return shown >= wanted;
                       })
                .is_null();
  };
  ASSERT_TRUE(show(50));
  EXPECT_THAT(other.stop(), HasSubstr("SIGINT"));
  ASSERT_TRUE(eventually([&] { return info(run).at("state") != "running"; }));
  EXPECT_EQ(info(run).at("why"), "it has ended");

  fs::rename(recording, folder_ / "project/elsewhere.tsr");
  const std::size_t all = get("/api/recordings/elsewhere.tsr").json().at("firings").size();
  EXPECT_TRUE(shown >= all || show(all));
  EXPECT_EQ(shown, all);
}

TEST_F(RunOfTheStudio, EndsWithTheServer) {
  const std::string run = start({{"kind", "simulate"}, {"for", "100000s"}, {"paused", true}});
  ASSERT_FALSE(await_state(run, "paused").is_null());
  ASSERT_FALSE(events_->next("subsystems").is_null());  // the controller is up and listens
  stop_ = true;  // Ctrl-C of the studio; its controller must not be left over
  EXPECT_TRUE(await_state(run, "nothing").is_null());
  command_.join();
  command_ = std::thread([] {});
  EXPECT_TRUE(fs::exists(fs::directory_iterator(folder_ / "project/.tessera/runs")->path() / "summary.json"));
}

}  // namespace tessera::server_test
