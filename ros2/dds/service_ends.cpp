#include "ros2/dds/service_ends.hpp"

#include <algorithm>
#include <cstdio>

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

bool ServiceEnds::write(std::span<const std::byte> message) { return writer_->write(message); }

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

void SharedService::use_timeout(Duration timeout) {
  const std::lock_guard lock(mutex_);
  if (timeout > Duration::zero()) timeout_ = timeout;
}

void SharedService::open() {
  const std::lock_guard lock(mutex_);
  if (!ends_) ends_.emplace(setup_);
  ++users_;
}

void SharedService::warn(std::uint64_t& count, const char* text) const {
  if (!is_told(++count)) return;
  std::fprintf(stderr, "warning: %s: service %s: %s (%llu until now)\n", setup_.endpoint.path.c_str(),
               setup_.endpoint.topic.c_str(), text, static_cast<unsigned long long>(count));
}

}  // namespace tessera::ros2
