#include "reply_server.hpp"

#include <zmq.h>

#include <array>
#include <stdexcept>

namespace tessera::testing {

ReplyServer::ReplyServer(Answer answer, std::uint16_t port)
    : answer_(std::move(answer)), context_(zmq_ctx_new()), socket_(zmq_socket(context_, ZMQ_REP)) {
  const int linger = 0;
  zmq_setsockopt(socket_, ZMQ_LINGER, &linger, sizeof linger);
  const std::string place = "tcp://127.0.0.1:" + (port == 0 ? "*" : std::to_string(port));
  if (zmq_bind(socket_, place.c_str()) != 0) throw std::runtime_error(zmq_strerror(zmq_errno()));
  std::array<char, 256> endpoint{};
  std::size_t size = endpoint.size();
  zmq_getsockopt(socket_, ZMQ_LAST_ENDPOINT, endpoint.data(), &size);
  const std::string text = endpoint.data();
  port_ = static_cast<std::uint16_t>(std::stoi(text.substr(text.rfind(':') + 1)));
  thread_ = std::thread([this] { serve(); });
}

void ReplyServer::stop() {
  stopping_ = true;
  if (!thread_.joinable()) return;
  thread_.join();
  zmq_close(socket_);
  zmq_ctx_term(context_);
}

void ReplyServer::serve() {
  while (!stopping_) {
    zmq_pollitem_t event{socket_, 0, ZMQ_POLLIN, 0};
    if (zmq_poll(&event, 1, /*ms=*/10) <= 0) continue;
    zmq_msg_t message;
    zmq_msg_init(&message);
    zmq_msg_recv(&message, socket_, 0);
    const auto* const data = static_cast<const std::uint8_t*>(zmq_msg_data(&message));
    const Bytes request(data, data + zmq_msg_size(&message));
    zmq_msg_close(&message);
    if (const auto reply = answer_(request)) zmq_send(socket_, reply->data(), reply->size(), 0);
  }
}

}  // namespace tessera::testing
