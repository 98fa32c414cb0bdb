#include "bag/bag_reader.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

#include "bag/bag_writer.hpp"
#include "bag/conversion.hpp"
#include "bag/raw_channel.hpp"

namespace tessera::bag {
namespace {

constexpr std::size_t most_differences = 10;

/// A message that the recording gives, or that stands in the bag.
struct Sample {
  std::uint64_t log_ns = 0, publish_ns = 0;
  std::string data;
  bool is_known = true;
};

/// The definitions with which the bag was made, as its channels tell.
Background background_of(std::string_view bytes) {
  Background background;
  std::map<std::string, bool> seen;
  static_cast<void>(mcap::read(bytes, {.message = [&](const mcap::ReadMessage& one) {
                                 if (one.schema == nullptr || one.channel.metadata.empty()) return;
                                 auto ros = ros_buffer_of(one.channel, *one.schema);
                                 if (ros && seen.try_emplace(ros->path).second)
                                   background.ros.push_back(*std::move(ros));
                               }}));
  return background;
}

/// Plays the recording of a bag beside its other messages.
class Comparison {
 public:
  Comparison(std::string_view bytes, Bag& bag) : bytes_(bytes), bag_(bag) {}

  /// false and `error`: it contains no recording.
  bool run(std::string& error) {
    bag_.condition = mcap::read(bytes_, {.message = [this](const mcap::ReadMessage& one) { take(one); },
                                         .attachment = [this](const mcap::Attachment& one) { take(one); },
                                         .metadata = [this](const mcap::Metadata& one) { take(one); },
                                         .gap =
                                             [this] {
                                               if (conversion_) conversion_->forget();
                                             }});
    if (!bag_.condition.is_mcap) {
      error = "is no MCAP file";
    } else if (!conversion_) {
      error = reader_.problem() ? reader_.problem()->text
                                : "does not contain a recording of Tessera: another program has written it, "
                                  "or its beginning is damaged";
    } else {
      if (reader_.problem()) tell("its recording " + reader_.problem()->text);
      compare_rest();
      bag_.recording.truncated = !reader_.has_ended();
      return true;
    }
    return false;
  }

 private:
  void take(const mcap::Attachment& attachment) {
    if (conversion_ || attachment.name != header_attachment) return;
    reader_.feed(file_start(attachment.data));
    if (!reader_.has_header()) return;
    conversion_.emplace(reader_.recording(), background_of(bytes_));
    for (std::size_t number = 0; number < conversion_->channels().size(); ++number)
      numbers_[key(conversion_->channels()[number].channel)] = number;
    due_.resize(conversion_->channels().size());
    found_.resize(due_.size());
    bag_.recording = reader_.recording();
  }

  void take(const mcap::Metadata& metadata) {
    const auto version = metadata.entries.find("bag_version");
    if (metadata.name == "tessera" && version != metadata.entries.end() && version->second != bag_version)
      return tell("another version of Tessera has written it, so its messages cannot be compared");
    if (!conversion_) return;
    for (const mcap::Metadata& made : metadata_of(bag_.recording))
      if (made.name == metadata.name && made.entries != metadata.entries)
        tell(fmt::format("its metadata {} are not those of the recording", metadata.name));
  }

  /// Several buffers may be on one topic.
  static std::string key(const mcap::Channel& channel) {
    const auto buffer = channel.metadata.find("buffer");
    return channel.topic + "\n" + channel.encoding + "\n" +
           (buffer == channel.metadata.end() ? "" : buffer->second);
  }

  void take(const mcap::ReadMessage& one) {
    if (!conversion_) return;
    if (one.channel.encoding == raw_encoding) return take_entry(one.message);
    const auto number = numbers_.find(key(one.channel));
    if (number == numbers_.end()) {
      if (strangers_.try_emplace(one.channel.topic).second)
        tell(fmt::format("the recording gives no channel {}", one.channel.topic));
      return;
    }
    found_[number->second].push_back(
        {one.message.log_ns, one.message.publish_ns, std::string(one.message.data), true});
    compare(number->second);
  }

  void take_entry(const mcap::Message& message) {
    const std::string bytes = file_bytes(message.data);
    if (bytes.empty()) return tell("an entry of its recording is damaged");
    reader_.feed(bytes);
    for (Recording::Entry& entry : reader_.recording().entries) {
      if (bag_time(entry.event.time_ns) != message.log_ns)
        tell(fmt::format("the event at {:.6f} s stands at {:.6f} s", seconds(bag_time(entry.event.time_ns)),
                         seconds(message.log_ns)));
      conversion_->convert(entry, [this](const Converted& made) {
        if (made.channel == 0) return;
        due_[made.channel].push_back({made.log_ns, made.publish_ns, std::string(made.data), made.is_known});
        compare(made.channel);
      });
      bag_.recording.entries.push_back(std::move(entry));
    }
    reader_.recording().entries.clear();
    bag_.recording.lost = reader_.recording().lost;
  }

  void compare(std::size_t channel) {
    std::deque<Sample>&due = due_[channel], &found = found_[channel];
    while (!due.empty() && !found.empty()) {
      const Sample& wanted = due.front();
      const Sample& given = found.front();
      if (!wanted.is_known && wanted.log_ns != given.log_ns) {
        due.pop_front();
        continue;
      }
      if (wanted.is_known && (wanted.data != given.data || wanted.log_ns != given.log_ns ||
                              wanted.publish_ns != given.publish_ns))
        tell(fmt::format("{} at {:.6f} s is not what the recording gives at {:.6f} s", topic(channel),
                         seconds(given.log_ns), seconds(wanted.log_ns)));
      due.pop_front();
      found.pop_front();
    }
  }

  void compare_rest() {
    for (std::size_t channel = 0; channel < due_.size(); ++channel) {
      std::erase_if(due_[channel], [](const Sample& sample) { return !sample.is_known; });
      if (!due_[channel].empty())
        tell(fmt::format("{} messages of {} are missing", due_[channel].size(), topic(channel)));
      if (!found_[channel].empty())
        tell(fmt::format("{} messages of {} are not in the recording", found_[channel].size(),
                         topic(channel)));
    }
  }

  [[nodiscard]] const std::string& topic(std::size_t channel) const {
    return conversion_->channels()[channel].channel.topic;
  }
  static double seconds(std::uint64_t time_ns) { return static_cast<double>(time_ns) * 1e-9; }
  void tell(std::string difference) {
    if (bag_.differences.size() < most_differences) bag_.differences.push_back(std::move(difference));
  }

  std::string_view bytes_;
  Bag& bag_;
  RecordingReader reader_;
  std::optional<Conversion> conversion_;
  std::map<std::string, std::size_t> numbers_;
  std::map<std::string, bool> strangers_;
  std::vector<std::deque<Sample>> due_, found_;
};

}  // namespace

bool is_bag(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string start(mcap::magic.size(), '\0');
  return stream.read(start.data(), static_cast<std::streamsize>(start.size())) && start == mcap::magic;
}

std::optional<std::string> bytes_of_file(const std::string& file, std::string& error) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  if (!stream || !(bytes << stream.rdbuf())) {
    error = fmt::format("cannot read '{}': {}", file, std::strerror(errno));
    return std::nullopt;
  }
  return std::move(bytes).str();
}

std::optional<Bag> read_bag_bytes(std::string_view bytes, std::string& error) {
  Bag bag;
  if (!Comparison(bytes, bag).run(error)) return std::nullopt;
  return bag;
}

std::optional<Bag> read_bag(const std::string& file, std::string& error) {
  const std::optional<std::string> bytes = bytes_of_file(file, error);
  if (!bytes) return std::nullopt;
  std::optional<Bag> bag = read_bag_bytes(*bytes, error);
  if (!bag) error = fmt::format("'{}' {}", file, error);
  return bag;
}

}  // namespace tessera::bag
