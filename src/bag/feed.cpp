#include "bag/feed.hpp"

#include <fmt/format.h>

#include <utility>

#include "bag/action_feed.hpp"
#include "bag/buffer_channel.hpp"

namespace tessera::bag {
namespace {

/// One topic, decoded as the definition in the bag says; that of the driver serves where the bag has none in this
/// language.
class TopicFeed final : public Feed {
 public:
  explicit TopicFeed(const WantedInput& wanted) : wanted_(wanted) {}

  [[nodiscard]] bool reads(const std::string& topic) const override { return wanted_.ros.topic == topic; }

  [[nodiscard]] std::string take(const mcap::ReadMessage& one, const Give& give) override {
    if (std::string problem = wrong_type(one, wanted_.ros.type, wanted_.ros.path); !problem.empty())
      return problem;
    if (!translator_) {
      RosBuffer ros = wanted_.ros;
      if (one.schema->encoding == "ros2msg" && !one.schema->data.empty()) ros.definition = one.schema->data;
      std::string why;
      translator_ = translator_of(ros, wanted_.type, ros2::Direction::receive, why);
      if (!translator_)
        return fmt::format("has messages of {} that {} cannot take: {}", wanted_.ros.type, wanted_.ros.path,
                           why);
    }
    ++count_.messages;
    std::vector<std::byte> value;
    if (translator_->decode(std::as_bytes(std::span(one.message.data)), value) ==
        ros2::Translator::Outcome::good)
      give({one.message.log_ns, value});
    else
      ++count_.misfits;
    return {};
  }

  void finish(const Give&) override {}

  [[nodiscard]] std::vector<std::string> notes() const override {
    const auto note = count_.note(wanted_.ros.topic, wanted_.ros.path);
    return note ? std::vector<std::string>{*note} : std::vector<std::string>();
  }

 private:
  const WantedInput& wanted_;
  std::optional<ros2::Translator> translator_;
  MessageCount count_;
};

}  // namespace

std::string wrong_type(const mcap::ReadMessage& one, const std::string& wanted_type,
                       const std::string& path) {
  const std::string type = one.schema == nullptr ? "an unknown type" : one.schema->name;
  if (one.channel.encoding == "cdr" && type == wanted_type) return {};
  return fmt::format("has {} messages of {} on {}, and the driver of {} wants cdr messages of {}",
                     one.channel.encoding, type, one.channel.topic, path, wanted_type);
}

std::optional<std::string> MessageCount::note(const std::string& topic, const std::string& path) const {
  if (messages == 0) return fmt::format("has no message on {}: {} gets no value", topic, path);
  if (misfits == 0) return std::nullopt;
  return fmt::format("{} of {} messages on {} do not fit into {} and are left out", misfits, messages, topic,
                     path);
}

std::unique_ptr<Feed> make_feed(const WantedInput& wanted, std::string& error) {
  if (wanted.is_action) return ActionFeed::make(wanted, error);
  return std::make_unique<TopicFeed>(wanted);
}

}  // namespace tessera::bag
