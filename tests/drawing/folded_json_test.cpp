#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "drawing/drawing.hpp"
#include "environment.hpp"
#include "layers/models.hpp"

namespace tessera::drawing {
namespace {

using nlohmann::json;

std::string joined(const std::string& path, const std::string& name) {
  return path.empty() || name.empty() ? path + name : path + "." + name;
}

/// Unfolds a folded net like the page: `pages`, `places` and `transitions` as to_json writes them, except
/// `fusion` of a node, which is the name of its place.
class Unfolding {
 public:
  explicit Unfolding(const json& folded) : folded_(folded), whole_(folded.at("system")) {
    std::size_t places = folded.at("system").at("places").size();
    for (const json& agent : folded.at("agents")) places += shape_of(agent).at("places").size();
    for (const json& channel : folded.at("channels")) {
      memories_.push_back(places);
      places += memory_of(channel).size();
    }
    for (const json& agent : folded.at("agents")) add(agent);
    for (std::size_t channel = 0; channel < memories_.size(); ++channel) add_memory(channel);
    for (json& page : whole_["pages"])
      for (json& node : page["nodes"])
        if (!node["fusion"].is_null())
          node["fusion"] = whole_["places"][node["fusion"].get<std::size_t>()].at("name");
  }
  [[nodiscard]] const json& whole() const { return whole_; }

 private:
  [[nodiscard]] const json& shape_of(const json& agent) const {
    return folded_.at("shapes")[agent.at("shape").get<std::size_t>()];
  }
  [[nodiscard]] const json& memory_of(const json& channel) const {
    return folded_.at("memories")[channel.at("memory").get<std::size_t>()];
  }

  void add(const json& agent) {
    const json& shape = shape_of(agent);
    const std::size_t pages = whole_["pages"].size(), places = whole_["places"].size(),
                      subsystems = subsystems_;
    const std::string name = agent.at("name");
    const auto later = [](json& number, std::size_t by) {
      if (!number.is_null()) number = number.get<std::size_t>() + by;
    };
    const auto channel = [&](json& of, std::initializer_list<const char*> kinds) {
      if (of.is_null()) return;
      for (const char* kind : kinds)
        if (of.at("kind") == kind) of["subject"] = agent.at("channels")[of.at("subject").get<std::size_t>()];
    };
    const auto place = [&](json& number) {
      const std::size_t own = number, count = shape.at("places").size();
      if (own < count) return void(number = places + own);
      const json& where = shape.at("memory")[own - count];
      const std::size_t used = agent.at("channels")[where[0].get<std::size_t>()];
      number = memories_[used] + where[1].get<std::size_t>();
    };
    for (json page : shape.at("pages")) {
      page["path"] = joined(name, page["path"]);
      if (page["name"] == "") page["name"] = name;
      page["parent"].is_null() ? void(page["parent"] = 0) : later(page["parent"], pages);
      later(page["subsystem"], subsystems);
      for (json& node : page["nodes"]) {
        later(node["page"], pages);
        if (!node["fusion"].is_null()) place(node["fusion"]);
        channel(node["operation"], {"write", "read"});
      }
      for (json& transition : page["transitions"]) channel(transition["condition"], {"elapsed"});
      whole_["pages"].push_back(page);
    }
    const auto owned = [&](json& one) {
      one["name"] = joined(name, one["name"]);
      later(one["page"], pages);
      later(one["subsystem"], subsystems);
    };
    for (json one : shape.at("places")) {
      owned(one);
      channel(one["operation"], {"write", "read"});
      whole_["places"].push_back(one);
    }
    for (json one : shape.at("transitions")) {
      owned(one);
      channel(one["condition"], {"elapsed"});
      for (const char* side : {"inputs", "outputs"})
        for (json& arc : one[side]) place(arc["place"]);
      whole_["transitions"].push_back(one);
    }
    subsystems_ += shape.at("subsystems").get<std::size_t>();
  }

  void add_memory(std::size_t index) {
    const json& channel = folded_.at("channels")[index];
    for (json place : memory_of(channel)) {
      place["name"] = joined(channel.at("name"), place["name"]);
      place["channel"] = index;
      if (!place["operation"].is_null()) place["operation"]["subject"] = index;
      whole_["places"].push_back(place);
    }
  }

  const json& folded_;
  json whole_;
  std::vector<std::size_t> memories_;
  std::size_t subsystems_ = 0;
};

void expect_whole(const test::Built& built, const std::string& what) {
  json expected = json::parse(to_json(built.pages, built.net));
  for (json& page : expected["pages"])
    for (json& node : page["nodes"])
      if (!node["fusion"].is_null())
        node["fusion"] = expected["fusions"][node["fusion"].get<std::size_t>()].at("name");
  const json folded = json::parse(to_folded_json(built.pages, built.net));
  const Unfolding unfolding(folded);
  EXPECT_EQ(unfolding.whole().at("pages"), expected.at("pages")) << what;
  EXPECT_EQ(unfolding.whole().at("places"), expected.at("flat").at("places")) << what;
  EXPECT_EQ(unfolding.whole().at("transitions"), expected.at("flat").at("transitions")) << what;
}

TEST(FoldedNet, IsTheWholeNet) {
  expect_whole(test::build(test::line_follower()), "line follower");
  expect_whole(test::build(test::fleet(7)), "fleet");
  expect_whole(test::build(test::pair({{test::B, test::B, true, true}, {test::N, test::B}})), "pair");
  for (std::uint32_t seed = 0; seed < from_environment("TESSERA_RANDOM_MODELS", share_of(100)); ++seed)
    expect_whole(test::build(test::random_model(seed)), "random model " + std::to_string(seed));
}

TEST(FoldedNet, WritesAgentsThatAreAlikeOnce) {
  const test::Built few = test::build(test::fleet(2)), many = test::build(test::fleet(200));
  const json folded = json::parse(to_folded_json(many.pages, many.net));
  EXPECT_EQ(folded.at("shapes").size(), 1U);
  EXPECT_EQ(folded.at("agents").size(), 200U);
  const std::size_t each =
      (to_folded_json(many.pages, many.net).size() - to_folded_json(few.pages, few.net).size()) / 198;
  EXPECT_LT(each, 600U) << "bytes for one agent more";
}

}  // namespace
}  // namespace tessera::drawing
