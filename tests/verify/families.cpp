#include "families.hpp"

#include <vector>

namespace tessera::verify {
namespace {

using Names = std::vector<std::string>;

std::string joined(const Names& names, const std::string& after = "") {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name + after;
  return text;
}

std::string number(unsigned value) { return std::to_string(value); }

/// "go: { send: [..], receive: [..], terminal: .., next: .. }"
std::string behaviour(const std::string& name, const Names& sends, const Names& receives,
                      const std::string& next, const std::string& terminal = "true") {
  return name + ": { send: [" + joined(sends) + "], receive: [" + joined(receives) +
         "], terminal: " + terminal + ", next: " + next + " }";
}

class Specification {
 public:
  void agent(const std::string& name, const Names& inputs, const Names& outputs, const Names& behaviours) {
    agents_ += "  " + name + ":\n    control:\n      rate: 10 Hz\n      memory: { h: int32 }\n";
    if (!inputs.empty()) agents_ += "      inputs: { " + joined(inputs, ": V") + " }\n";
    if (!outputs.empty()) agents_ += "      outputs: { " + joined(outputs, ": V") + " }\n";
    agents_ += "      behaviours: { " + joined(behaviours) + " }\n";
  }
  void channel(const std::string& from, const std::string& to, const std::string& output,
               const std::string& input) {
    channels_ += "  - { from: " + from + ".control." + output + ", to: " + to + ".control." + input +
                 ", send: blocking, receive: blocking }\n";
  }
  [[nodiscard]] std::string text() const {
    return "tessera: 1\nsystem: s\ntypes: { V: { v: float64 } }\nagents:\n" + agents_ + "channels:\n" +
           channels_;
  }

 private:
  std::string agents_, channels_;
};

}  // namespace

std::string election(unsigned robots) {
  Specification made;
  for (unsigned index = 0; index < robots; ++index) {
    const std::string name = "r" + number(index);
    made.agent(name, {"x"}, {"y"},
               {behaviour("idle", {}, {}, "[{ to: start_it, when: memory.h > 3 }, listen]"),
                behaviour("start_it", {"y"}, {}, "listen"),
                behaviour("listen", {}, {"x"}, "[{ to: pass_on, when: in.x.v > 1 }, idle]"),
                behaviour("pass_on", {"y"}, {}, "listen")});
    made.channel(name, "r" + number((index + 1) % robots), "y", "x");
  }
  return made.text();
}

std::string philosophers(unsigned robots) {
  Specification made;
  for (unsigned index = 0; index < robots; ++index) {
    const std::string philosopher = "p" + number(index);
    made.agent(
        philosopher, {"get_l", "get_r"}, {"ask_l", "ask_r", "back_l", "back_r"},
        {behaviour("think", {}, {}, "first", "memory.h > 0"),
         behaviour("first", {"ask_l"}, {"get_l"}, "second"), behaviour("second", {"ask_r"}, {"get_r"}, "eat"),
         behaviour("eat", {"back_l", "back_r"}, {}, "think")});
    const std::string fork = "f" + number(index);
    Names behaviours{behaviour("rest", {}, {}, "[{ to: hear_a, when: memory.h > 0 }, hear_b]")};
    for (const char* side : {"a", "b"}) {
      const std::string s = side;
      behaviours.push_back(behaviour("hear_" + s, {}, {"ask_" + s}, "lend_" + s));
      behaviours.push_back(behaviour("lend_" + s, {"give_" + s}, {"back_" + s}, "rest"));
    }
    made.agent(fork, {"ask_a", "ask_b", "back_a", "back_b"}, {"give_a", "give_b"}, behaviours);
    const auto join = [&](const std::string& its_fork, const std::string& hand, const std::string& side) {
      made.channel(philosopher, its_fork, "ask_" + hand, "ask_" + side);
      made.channel(its_fork, philosopher, "give_" + side, "get_" + hand);
      made.channel(philosopher, its_fork, "back_" + hand, "back_" + side);
    };
    join(fork, "l", "a");
    join("f" + number((index + 1) % robots), "r", "b");
  }
  return made.text();
}

std::string docks(unsigned robots) {
  Specification made;
  std::string choices;
  Names behaviours, asked, left, given;
  for (unsigned index = 0; index < robots; ++index) {
    const std::string n = number(index);
    choices += index + 1 < robots ? "{ to: hear" + n + ", when: memory.h > " + n + " }, " : "hear" + n;
    behaviours.push_back(behaviour("hear" + n, {}, {"ask" + n}, "grant" + n));
    behaviours.push_back(behaviour("grant" + n, {"grant_it" + n}, {"leave" + n}, "rest"));
    asked.push_back("ask" + n);
    left.push_back("leave" + n);
    given.push_back("grant_it" + n);
    made.agent(
        "r" + n, {"grant"}, {"ask", "leave"},
        {behaviour("work", {}, {}, "ask_it", "memory.h > 0"),
         behaviour("ask_it", {"ask"}, {"grant"}, "charge"), behaviour("charge", {"leave"}, {}, "work")});
    made.channel("r" + n, "dock", "ask", "ask" + n);
    made.channel("dock", "r" + n, "grant_it" + n, "grant");
    made.channel("r" + n, "dock", "leave", "leave" + n);
  }
  behaviours.insert(behaviours.begin(), behaviour("rest", {}, {}, "[" + choices + "]"));
  asked.insert(asked.end(), left.begin(), left.end());
  made.agent("dock", asked, given, behaviours);
  return made.text();
}

std::string gossip(unsigned robots) {
  Specification made;
  for (unsigned index = 0; index < robots; ++index) {
    const std::string next =
        "[{ to: tell_l, when: memory.h > 1 }, { to: tell_r, when: memory.h > 2 }, { to: hear_l, when: "
        "memory.h > 3 }, hear_r]";
    const std::string name = "r" + number(index), right = "r" + number((index + 1) % robots);
    made.agent(name, {"from_l", "from_r"}, {"to_l", "to_r"},
               {behaviour("tell_l", {"to_l"}, {}, next), behaviour("tell_r", {"to_r"}, {}, next),
                behaviour("hear_l", {}, {"from_l"}, next), behaviour("hear_r", {}, {"from_r"}, next)});
    made.channel(name, right, "to_r", "from_l");
    made.channel(right, name, "to_l", "from_r");
  }
  return made.text();
}

std::string auction(unsigned robots) {
  Specification made;
  Names calls, bids, awards, behaviours;
  std::string choices;
  for (unsigned index = 0; index < robots; ++index) {
    const std::string n = number(index);
    calls.push_back("call" + n);
    bids.push_back("bid" + n);
    awards.push_back("award" + n);
    choices += "{ to: award_it" + n + ", when: in.bid" + n + ".v > 1 }, ";
    behaviours.push_back(behaviour("award_it" + n, {"award" + n}, {}, "call"));
    made.agent("r" + n, {"call", "award"}, {"bid"},
               {behaviour("hear", {}, {"call"}, "offer"),
                behaviour("offer", {"bid"}, {}, "[{ to: work, when: in.call.v > 1 }, hear]"),
                behaviour("work", {}, {"award"}, "hear")});
    made.channel("auctioneer", "r" + n, "call" + n, "call");
    made.channel("r" + n, "auctioneer", "bid", "bid" + n);
    made.channel("auctioneer", "r" + n, "award" + n, "award");
  }
  behaviours.insert(behaviours.begin(), {behaviour("call", calls, {}, "hear"),
                                         behaviour("hear", {}, bids, "[" + choices + "call]")});
  Names outputs = calls;
  outputs.insert(outputs.end(), awards.begin(), awards.end());
  made.agent("auctioneer", bids, outputs, behaviours);
  return made.text();
}

std::string server(unsigned clients) {
  Specification made;
  Names requests, answers;
  for (unsigned index = 0; index < clients; ++index) {
    const std::string n = number(index);
    requests.push_back("request" + n);
    answers.push_back("answer" + n);
    made.agent("c" + n, {"answer"}, {"request"}, {"go: {}"});
    made.channel("c" + n, "server", "request", "request" + n);
    made.channel("server", "c" + n, "answer" + n, "answer");
  }
  made.agent("server", requests, answers,
             {behaviour("hear", {}, requests, "tell"), behaviour("tell", answers, {}, "hear")});
  return made.text();
}

std::string hub(unsigned clients, bool parallel) {
  Specification made;
  Names in, out;
  for (unsigned index = 0; index < clients; ++index) {
    const std::string n = number(index);
    in.push_back("in" + n);
    out.push_back("out" + n);
    made.agent("c" + n, {"x"}, {"y"}, {"go: {}"});
    made.channel("c" + n, "hub", "y", "in" + n);
    made.channel("hub", "c" + n, "out" + n, "x");
  }
  made.agent("hub", in, out, {parallel ? "go: { transfer: parallel }" : "go: {}"});
  return made.text();
}

std::string credits(unsigned stages) {
  Specification made;
  for (unsigned index = 0; index < stages; ++index) {
    const bool first = index == 0, last = index + 1 == stages;
    Names in, out;
    if (!last) in.push_back("credit_in"), out.push_back("data_out");
    if (!first) in.push_back("data"), out.push_back("credit");
    const std::string name = "s" + number(index), next = "s" + number(index + 1);
    made.agent(name, in, out, {"go: { send: [" + joined(out) + "], receive: [" + joined(in) + "] }"});
    if (last) continue;
    made.channel(name, next, "data_out", "data");
    made.channel(next, name, "credit", "credit_in");
  }
  return made.text();
}

}  // namespace tessera::verify
