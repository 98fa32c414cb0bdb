#include "sim/coppelia/request_socket.hpp"

#include <zmq.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "sim/coppelia/link_error.hpp"
#include "sim/coppelia/listener.hpp"

namespace tessera::coppelia {
namespace {

using std::chrono::milliseconds;

constexpr const char* monitor_address = "inproc://connection";
constexpr std::int64_t largest_reply = std::int64_t{256} << 20;  // a picture of 64 megapixels

[[noreturn]] void fail(const std::string& what) { throw LinkError(what + ": " + zmq_strerror(zmq_errno())); }

class Message {
 public:
  Message() { zmq_msg_init(&message_); }
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;
  ~Message() { zmq_msg_close(&message_); }
  [[nodiscard]] bool receive(void* socket, int flags) { return zmq_msg_recv(&message_, socket, flags) >= 0; }
  [[nodiscard]] std::span<const std::uint8_t> bytes() {
    return {static_cast<const std::uint8_t*>(zmq_msg_data(&message_)), zmq_msg_size(&message_)};
  }
  [[nodiscard]] bool more() const { return zmq_msg_more(&message_) != 0; }

 private:
  zmq_msg_t message_{};
};

}  // namespace

void RequestSocket::CloseContext::operator()(void* context) const { zmq_ctx_term(context); }
void RequestSocket::CloseSocket::operator()(void* socket) const { zmq_close(socket); }

RequestSocket::RequestSocket(const std::string& host, std::uint16_t port, Duration patience)
    : name_(host + ":" + std::to_string(port)) {
  const std::string address = listening_address(host, port, patience);
  const bool version_6 = address.find(':') != std::string::npos;
  context_.reset(zmq_ctx_new());
  socket_ = make(ZMQ_REQ);
  set(ZMQ_LINGER, 0);
  set(ZMQ_IPV6, version_6 ? 1 : 0);
  zmq_setsockopt(socket_.get(), ZMQ_MAXMSGSIZE, &largest_reply, sizeof largest_reply);
  watch_connection();
  const std::string endpoint =
      "tcp://" + (version_6 ? "[" + address + "]" : address) + ":" + std::to_string(port);
  if (zmq_connect(socket_.get(), endpoint.c_str()) != 0) fail("cannot connect to " + name_);
}

RequestSocket::Socket RequestSocket::make(int type) const {
  Socket made(zmq_socket(context_.get(), type));
  if (!made) fail("cannot make a ZeroMQ socket");
  return made;
}

void RequestSocket::set(int option, int value) {
  zmq_setsockopt(socket_.get(), option, &value, sizeof value);
}

/// ZeroMQ reconnects when a server comes back, but that server would not know this run.
void RequestSocket::watch_connection() {
  constexpr int lost = ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                       ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;
  if (zmq_socket_monitor(socket_.get(), monitor_address, lost) != 0) fail("cannot watch the connection");
  monitor_ = make(ZMQ_PAIR);
  if (zmq_connect(monitor_.get(), monitor_address) != 0) fail("cannot watch the connection");
}

void RequestSocket::throw_if_lost() {
  Message event;
  if (!event.receive(monitor_.get(), ZMQ_DONTWAIT)) return;
  std::uint16_t kind = 0;
  std::memcpy(&kind, event.bytes().data(), sizeof kind);
  if (kind == ZMQ_EVENT_DISCONNECTED) throw LinkError("the server at " + name_ + " has gone" + doubt());
  throw LinkError("the program at " + name_ + " speaks no ZeroMQ; is it CoppeliaSim's remote API?");
}

/// Another program may listen at that port.
std::string RequestSocket::doubt() const { return has_answered_ ? "" : "; is it CoppeliaSim's remote API?"; }

std::vector<std::uint8_t> RequestSocket::receive() {
  Message reply;
  if (!reply.receive(socket_.get(), 0)) fail("no reply from " + name_);
  if (reply.more()) throw LinkError("the program at " + name_ + " speaks another protocol: several frames");
  has_answered_ = true;
  return {reply.bytes().begin(), reply.bytes().end()};
}

std::vector<std::uint8_t> RequestSocket::ask(std::span<const std::uint8_t> request, Duration patience) {
  throw_if_lost();
  const auto end = std::chrono::steady_clock::now() + patience;
  while (zmq_send(socket_.get(), request.data(), request.size(), 0) < 0)
    if (zmq_errno() != EINTR) fail("cannot ask the server at " + name_);
  for (;;) {
    std::array<zmq_pollitem_t, 2> events{
        {{socket_.get(), 0, ZMQ_POLLIN, 0}, {monitor_.get(), 0, ZMQ_POLLIN, 0}}};
    const auto left = std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
    const int ready = left.count() <= 0 ? 0 : zmq_poll(events.data(), events.size(), left.count());
    if (ready < 0 && zmq_errno() != EINTR) fail("no reply from " + name_);
    if (ready == 0)
      throw NoReply("the server at " + name_ + " has not answered for " +
                    std::to_string(std::chrono::ceil<std::chrono::seconds>(patience).count()) + " s" +
                    doubt());
    if (ready < 0) continue;
    if ((events[0].revents & ZMQ_POLLIN) != 0) return receive();
    throw_if_lost();
  }
}

}  // namespace tessera::coppelia
