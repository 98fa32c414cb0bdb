#include "ros2/drivers/service_ends.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <string_view>
#include <utility>

#include "ros2/drivers/prepared.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::ros2 {
namespace {

constexpr const char* client_key = "clientid";
constexpr const char* server_key = "serviceid";
/// Messages that wait in DDS until the driver is asked.
constexpr int kept_messages = 64;
/// The bit that tells the numbers of requests by Fast DDS from others.
constexpr std::int64_t by_fast_dds = std::int64_t{1} << 62U;

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

ServiceEnds::ServiceEnds(const ServiceSetup& setup) : path_(setup.endpoint.path) {
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
  if (setup.is_client) {
    // While a server that was killed counts as alive, DDS keeps the requests that it has not confirmed, and gives
    // them to a reader of Fast DDS that is started meanwhile. That server would execute them again.
    requests.qos.lifespan = setup.timeout;
    if (setup.one_at_a_time) requests.qos.depth = 1;
  }
  const Network& network = requests.network;
  fast_setup_ = {network.domain,     network.interface,  network.peers,
                 requests.dds_topic, requests.dds_type,  replies.dds_topic,
                 replies.dds_type,   requests.user_data, setup.is_client};
  reader_.emplace(setup.is_client ? replies : requests, /*writes=*/false);
  writer_.emplace(setup.is_client ? requests : replies, /*writes=*/true);
}

bool ServiceEnds::await_receipt(Duration timeout) {
  const auto until = std::chrono::steady_clock::now() + timeout;
  const bool received = writer_->await_receipt(timeout);
  const Duration left = std::max<Duration>(until - std::chrono::steady_clock::now(), Duration::zero());
  FastService* const fast = fast_library_.service();
  return (fast == nullptr || fast->await_receipt(left)) && received;
}

std::optional<std::int64_t> ServiceEnds::send_request(std::vector<std::byte> request) {
  const Servers found = servers();
  if (FastService* const fast = found.fast ? fast_library_.service() : nullptr) {
    const auto number = fast->request(request);
    return number ? std::optional(*number | by_fast_dds) : std::nullopt;
  }
  ++newest_request_;
  if (!found.fast) put_header({writer_->identity(), newest_request_}, request);
  if (writer_->write(request)) return newest_request_;
  --newest_request_;
  return std::nullopt;
}

ServiceEnds::Replies ServiceEnds::take_replies() {
  Replies replies;
  const Guid writer = writer_->guid();
  for (Taken& one : take()) {  // all clients get all replies
    if (one.beside) {
      if (one.beside->related.endpoint == writer)
        replies.ours.push_back({one.beside->related.sequence, std::move(one.message)});
      continue;
    }
    const auto header = take_header(one.message);
    if (!header)
      ++replies.strange;
    else if (header->client == writer_->identity())
      replies.ours.push_back({header->sequence, std::move(one.message)});
  }
  if (FastService* const fast = fast_library_.service())
    for (FastService::Message& one : fast->take())
      replies.ours.push_back({one.request.sequence | by_fast_dds, std::move(one.bytes)});
  return replies;
}

ServiceEnds::Requests ServiceEnds::take_requests() {
  Requests requests;
  look_for_fast_clients();
  for (Taken& one : take()) {
    if (one.beside) {
      if (cannot_answer_fast_clients()) continue;
      const RelatedIdentity asker{one.beside->related.endpoint, one.beside->sequence};
      if (seen_.is_new(asker)) requests.all.push_back({{{}, {}, one.writer, asker}, std::move(one.message)});
      continue;
    }
    auto client = client_of(one.writer);
    const auto header = client ? take_header(one.message) : std::nullopt;
    if (header)
      requests.all.push_back({{*header, *std::move(client), one.writer}, std::move(one.message)});
    else
      ++requests.foreign;
  }
  if (FastService* const fast = fast_library_.service())
    for (FastService::Message& one : fast->take())
      if (seen_.is_new(one.request)) requests.all.push_back({{{}, {}, 0, one.request}, std::move(one.bytes)});
  return requests;
}

/// The writer of replies may not have found the client of a request yet.
ServiceEnds::Sending ServiceEnds::send_reply(const Asker& asker, std::vector<std::byte> reply) {
  if (asker.fast) return send_fast_reply(asker, reply);
  if (!hears(asker.client)) return is_there(asker) ? Sending::not_yet : Sending::gone;
  put_header(asker.header, reply);
  return writer_->write(reply) ? Sending::sent : Sending::refused;
}

ServiceEnds::Sending ServiceEnds::send_fast_reply(const Asker& asker, const std::vector<std::byte>& reply) {
  FastService* const fast = fast_library_.service();
  if (!fast_library_.error().empty()) return Sending::impossible;
  if (fast == nullptr || !fast->is_heard_by(asker.fast->endpoint))
    return is_there(asker) ? Sending::not_yet : Sending::gone;
  return fast->reply(reply, *asker.fast) ? Sending::sent : Sending::refused;
}

void ServiceEnds::look_for_fast_clients() {
  constexpr auto between_looks = std::chrono::milliseconds(100);
  const auto now = std::chrono::steady_clock::now();
  if (fast_begun_ || now < next_look_) return;
  next_look_ = now + between_looks;
  const auto others = reader_->others();
  fast_begun_ = std::ranges::any_of(others, [](const Endpoint::Other& one) {
    return is_fast(one.guid) && !value_of(one.user_data, client_key);
  });
  if (fast_begun_) fast_library_.begin(fast_setup_);
}

bool ServiceEnds::cannot_answer_fast_clients() {
  fast_library_.begin(fast_setup_);
  static_cast<void>(fast_library_.service());
  if (fast_library_.error().empty()) return false;
  if (is_told(++unanswerable_))
    std::fprintf(
        stderr,
        "warning: %s: a request was dropped (%llu until now): clients that run rmw_fastrtps_cpp get no "
        "replies: %s. Install the Debian package libfastrtps2.9, or start them with "
        "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp\n",
        path_.c_str(), static_cast<unsigned long long>(unanswerable_), fast_library_.error().c_str());
  return true;
}

std::size_t ServiceEnds::new_other_servers() {
  FastService* const fast = fast_library_.service();
  if (fast != nullptr && !std::exchange(fast_known_, true)) writer_->take_for_ours(fast->identity());
  return writer_->new_other_writers().size();
}

std::vector<ServiceEnds::Taken> ServiceEnds::take() const {
  std::vector<Taken> taken;
  reader_->take(
      [](void* all, const TakenBlob& blob) {
        static_cast<std::vector<Taken>*>(all)->push_back(
            Taken{{blob.message.begin(), blob.message.end()}, blob.writer, blob.beside});
      },
      &taken);
  return taken;
}

/// A server of Fast DDS answers before Cyclone DDS is ready to read its replies. So Fast DDS carries the calls to such a
/// server, if the library is there. It also finds a server sooner, so it begins as soon as there may be one.
ServiceEnds::Servers ServiceEnds::servers() {
  constexpr auto between_looks = std::chrono::milliseconds(50);
  Servers found = found_servers();
  if (!found.fast || found.foreign) return found;
  fast_begun_ = fast_begun_ || found.ready > 0;
  if (const auto now = std::chrono::steady_clock::now(); !fast_begun_ && now >= next_look_) {
    next_look_ = now + between_looks;
    fast_begun_ = reader_->participant().knows_fast_dds();
  }
  if (!fast_begun_) return found;
  fast_library_.begin(fast_setup_);
  if (const FastService* const fast = fast_library_.service())
    found.ready = fast->servers();
  else if (fast_library_.error().empty())
    found.ready = 0;
  return found;
}

/// A server has a reader of requests and a writer of replies. In rmw_cyclonedds_cpp both have the same user data.
/// In rmw_fastrtps_cpp both belong to a participant of Fast DDS, without such user data.
ServiceEnds::Servers ServiceEnds::found_servers() const {
  std::set<std::string> heard, ready;
  std::vector<Guid> fast_writers;
  for (const Endpoint::Other& one : reader_->others()) {
    if (auto server = value_of(one.user_data, server_key))
      heard.insert(*std::move(server));
    else if (is_fast(one.guid))
      fast_writers.push_back(one.guid);
  }
  Servers servers;
  std::size_t fast_readers = 0, fast_ready = 0;
  bool has_header = false;
  for (const Endpoint::Other& one : writer_->others()) {
    if (const auto server = value_of(one.user_data, server_key)) {
      has_header = true;
      if (heard.contains(*server)) ready.insert(*server);
    } else if (is_fast(one.guid)) {
      ++fast_readers;
      fast_ready += static_cast<std::size_t>(std::ranges::any_of(
          fast_writers, [&](const Guid& writer) { return same_participant(writer, one.guid); }));
    } else {
      servers.foreign = true;
    }
  }
  servers.foreign = servers.foreign || (has_header && fast_readers > 0);
  servers.fast = !has_header;
  servers.ready = has_header ? ready.size() : fast_ready;
  return servers;
}

std::optional<std::string> ServiceEnds::client_of(dds_instance_handle_t writer) const {
  const auto user_data = reader_->user_data_of(writer);
  return user_data ? value_of(*user_data, client_key) : std::nullopt;
}

bool ServiceEnds::is_there(const Asker& asker) {
  FastService* const fast = fast_library_.service();
  if (asker.writer == 0) return fast != nullptr && asker.fast && fast->is_there(asker.fast->endpoint);
  return std::ranges::any_of(reader_->others(),
                             [&](const Endpoint::Other& one) { return one.handle == asker.writer; });
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
