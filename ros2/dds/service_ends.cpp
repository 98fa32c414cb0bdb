#include "ros2/dds/service_ends.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>

#include "ros2/dds/prepared.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::ros2 {
namespace {

constexpr const char* client_key = "clientid";
constexpr const char* server_key = "serviceid";
/// Messages that wait in DDS until the driver is asked.
constexpr int kept_messages = 64;

/// The value of a key in "KEY=VALUE;KEY=VALUE;".
std::optional<std::string> value_of(std::string_view user_data, std::string_view key) {
  while (!user_data.empty()) {
    const std::size_t end = std::min(user_data.find(';'), user_data.size());
    const std::string_view part = user_data.substr(0, end);
    if (part.size() > key.size() && part.starts_with(key) && part[key.size()] == '=')
      return std::string(part.substr(key.size() + 1));
    user_data.remove_prefix(std::min(end + 1, user_data.size()));
  }
  return std::nullopt;
}

}  // namespace

ServiceEnds::ServiceEnds(const ServiceSetup& setup) {
  EndpointSetup requests = setup.endpoint;
  const auto participant = Participant::of(requests.network);
  requests.qos = Qos{.depth = kept_messages};
  requests.user_data = std::string(setup.is_client ? client_key : server_key) + "=" +
                       participant->new_service_identity() + ";";
  EndpointSetup replies = requests;
  requests.dds_topic = dds_request_name(requests.topic);
  requests.dds_type = dds_type_name(request_type(setup.type));
  replies.dds_topic = dds_reply_name(replies.topic);
  replies.dds_type = dds_type_name(response_type(setup.type));
  replies.sole_writer = !setup.is_client;
  reader_.emplace(setup.is_client ? replies : requests, /*writes=*/false);
  writer_.emplace(setup.is_client ? requests : replies, /*writes=*/true);
}

std::optional<std::int64_t> ServiceEnds::send_request(std::vector<std::byte> request) {
  put_header({writer_->identity(), ++newest_request_}, request);
  return writer_->write(request) ? std::optional(newest_request_) : std::nullopt;
}

ServiceEnds::Replies ServiceEnds::take_replies() {
  Replies replies;
  for (Taken& one : take()) {
    const auto header = take_header(one.message);
    if (!header)
      ++replies.strange;
    else if (header->client == writer_->identity())  // all clients get all replies
      replies.ours.push_back({header->sequence, std::move(one.message)});
  }
  return replies;
}

ServiceEnds::Requests ServiceEnds::take_requests() {
  Requests requests;
  for (Taken& one : take()) {
    auto client = client_of(one.writer);
    const auto header = client ? take_header(one.message) : std::nullopt;
    if (header)
      requests.all.push_back({{*header, *std::move(client), one.writer}, std::move(one.message)});
    else
      ++requests.foreign;
  }
  return requests;
}

/// The writer of replies may not have found the client of a request yet.
ServiceEnds::Sending ServiceEnds::send_reply(const Asker& asker, std::vector<std::byte> reply) {
  if (!hears(asker.client)) return is_there(asker.writer) ? Sending::not_yet : Sending::gone;
  put_header(asker.header, reply);
  return writer_->write(reply) ? Sending::sent : Sending::refused;
}

std::vector<ServiceEnds::Taken> ServiceEnds::take() const {
  std::vector<Taken> taken;
  reader_->take(
      [](void* all, const TakenBlob& blob) {
        static_cast<std::vector<Taken>*>(all)->push_back(
            Taken{{blob.message.begin(), blob.message.end()}, blob.writer});
      },
      &taken);
  return taken;
}

ServiceEnds::Servers ServiceEnds::servers() const {
  std::vector<std::string> heard;
  for (const Endpoint::Other& one : reader_->others())
    if (auto server = value_of(one.user_data, server_key)) heard.push_back(*std::move(server));
  Servers servers;
  for (const Endpoint::Other& one : writer_->others()) {
    const auto server = value_of(one.user_data, server_key);
    if (!server)
      servers.foreign = true;
    else if (std::ranges::find(heard, *server) != heard.end())
      ++servers.ready;
  }
  return servers;
}

std::optional<std::string> ServiceEnds::client_of(dds_instance_handle_t writer) const {
  const auto user_data = reader_->user_data_of(writer);
  return user_data ? value_of(*user_data, client_key) : std::nullopt;
}

bool ServiceEnds::is_there(dds_instance_handle_t writer) const {
  return std::ranges::any_of(reader_->others(),
                             [&](const Endpoint::Other& one) { return one.handle == writer; });
}

bool ServiceEnds::hears(const std::string& client) const {
  return std::ranges::any_of(writer_->others(), [&](const Endpoint::Other& one) {
    return value_of(one.user_data, client_key) == client;
  });
}

void warn_of(const ServiceSetup& setup, std::uint64_t& count, const char* text) {
  if (!is_told(++count)) return;
  std::fprintf(stderr, "warning: %s: %s %s: %s (%llu until now)\n", setup.endpoint.path.c_str(), setup.kind,
               setup.endpoint.topic.c_str(), text, static_cast<unsigned long long>(count));
}

}  // namespace tessera::ros2
