#include "running.hpp"

namespace tessera::server_test {

TEST_F(RunOfTheStudio, SweepsAParameterAndGoesOnWhereItWasStopped) {
  const json request{{"parameter", "v"}, {"values", {"0.1 m/s", "0.2 m/s"}}, {"runs", 2}, {"for", "1s"}};
  json wrong = request;
  wrong["values"] = {"0.1 m"};
  EXPECT_EQ(post("/api/sweeps", wrong).status, 422);
  const auto sweep = [&](const json& wanted) {
    const Reply started = post("/api/sweeps", wanted);
    EXPECT_EQ(started.status, 202) << started.body;
    const json name = started.json().at("sweep");
    std::size_t rows = 0;
    const json end = events_->next("sweep", [&](const json& event) {
      if (event.at("sweep") != name) return false;
      // Every row comes once, in its order.
      EXPECT_EQ(event.at("from"), rows);
      rows += event.at("rows").size();
      const json& state = event.at("state");
      return state == "done" || state == "failed" || state == "stopped";
    });
    EXPECT_EQ(end.at("state"), "done") << end;
    EXPECT_EQ(end.at("done"), rows);
    return get("/api/sweeps/" + name.get<std::string>()).json();
  };
  const json first = sweep(request);
  ASSERT_EQ(first.at("rows").size(), 4U) << first;
  EXPECT_EQ(first.at("rows").at(0).at("failed"), false) << first;
  EXPECT_TRUE(first.at("rows").at(0).at("numbers").at("error, mean").is_number()) << first;
  EXPECT_EQ(first.at("rows").at(0).at("numbers").at("simulated time"), 1.0);
  json more = request;
  more["runs"] = 3;
  const json second = sweep(more);
  EXPECT_EQ(second.at("rows").size(), 6U);
  EXPECT_EQ(second.at("reused"), 4);
  // The same seed and value give the same run, however it was asked for.
  const auto row_of = [](const json& of, const std::string& value, int seed) {
    for (const json& row : of.at("rows"))
      if (row.at("value") == value && row.at("seed") == seed) return row;
    return json();
  };
  EXPECT_EQ(row_of(first, "0.2 m/s", 2), row_of(second, "0.2 m/s", 2));
  EXPECT_NE(row_of(first, "0.1 m/s", 1).at("numbers"), row_of(first, "0.2 m/s", 1).at("numbers"));
  // A long one is stopped, and keeps what it has.
  const Reply started = post("/api/sweeps", {{"runs", 5000}, {"for", "600s"}});
  const std::string name = started.json().at("sweep");
  EXPECT_EQ(post("/api/sweeps", request).status, 429);
  EXPECT_EQ(ask("DELETE", "/api/sweeps/" + name, "").status, 200);
  const json end = events_->next("sweep", [&](const json& event) {
    return event.at("sweep") == name && event.at("state") != "building" && event.at("state") != "running";
  });
  EXPECT_EQ(end.at("state"), "stopped");
}

}  // namespace tessera::server_test
