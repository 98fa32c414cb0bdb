// Clients and servers of the service /enable, as a specification would make them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/definitions/resolver.hpp"
#include "ros2/drivers/drivers.hpp"
#include "tessera/bounded_string.hpp"
#include "tessera/fields.hpp"

namespace tessera::ros2 {

struct Request {
  std::uint32_t call{};
  bool data{};
  TESSERA_FIELDS(Request, call, data)
};
struct Reply {
  BoundedString<16> message{};
  std::uint8_t outcome{};
  bool success{};
  std::uint32_t call{};
  TESSERA_FIELDS(Reply, message, outcome, success, call)
};
struct SentReply {
  std::uint32_t call{};
  BoundedString<16> message{};
  bool success{};
  TESSERA_FIELDS(SentReply, call, message, success)
};
struct BareReply {
  bool success{};
  BoundedString<4> message{};
  std::uint64_t call{};
  TESSERA_FIELDS(BareReply, success, message, call)
};

enum Outcome : std::uint8_t { answered = 1, no_server = 2, no_reply = 3, replaced = 4, unreadable = 5 };

/// Not that of the tests of topics, which run in the same process.
inline std::uint32_t service_domain() { return 60 + static_cast<std::uint32_t>(getpid() + 75) % 150; }

template <class Value>
Ros2Binding side_of_service(const std::string& role, bool request) {
  std::vector<Mistake> mistakes;
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  const auto service = resolve_service("std_srvs/srv/SetBool", folders, mistakes);
  Ros2Binding made;
  made.path = "robot." + role + ".buffer";
  made.topic = "/enable";
  made.type = "std_srvs/srv/SetBool";
  made.role = role;
  made.definition = bundle_of(request ? *service->request : *service->response);
  made.interface = "lo";
  made.domain = service_domain();
  made.encoding = value_encoding_of<Value>();
  return made;
}

template <class Driver, class Make>
std::unique_ptr<Driver> opened(Make make, const Ros2Binding& binding) {
  std::string error;
  std::unique_ptr<Driver> driver = make(binding, error);
  if (driver == nullptr) throw std::runtime_error(error);
  EXPECT_TRUE(driver->open());
  return driver;
}

/// The two drivers of a client whose buffer of replies is a ReplyValue.
template <class ReplyValue = Reply>
struct Client {
  explicit Client(Duration timeout = std::chrono::seconds(30), Duration wait = Duration::zero()) {
    Ros2Binding sends = side_of_service<Request>("client", true);
    sends.timeout = timeout;
    sends.wait = wait;
    requests = opened<RealEffector>(make_effector, sends);
    replies = opened<RealReceptor>(make_receptor, side_of_service<ReplyValue>("client", false));
  }
  ~Client() {
    replies->close();
    requests->close();
  }
  bool call(std::uint32_t number, bool data) {
    const Request request{number, data};
    return requests->write(std::as_bytes(std::span(&request, 1)));
  }
  bool read() { return replies->read(std::as_writable_bytes(std::span(&reply, 1))); }
  std::unique_ptr<RealEffector> requests;
  std::unique_ptr<RealReceptor> replies;
  ReplyValue reply;
};

struct Server {
  explicit Server(Duration timeout = std::chrono::seconds(30)) {
    Ros2Binding sends = side_of_service<SentReply>("server", false);
    sends.timeout = timeout;
    replies = opened<RealEffector>(make_effector, sends);
    requests = opened<RealReceptor>(make_receptor, side_of_service<Request>("server", true));
  }
  ~Server() {
    requests->close();
    replies->close();
  }
  bool read() { return requests->read(std::as_writable_bytes(std::span(&request, 1))); }
  bool reply(std::uint32_t number, bool success, std::string_view message) {
    SentReply value{number, {}, success};
    value.message = message;
    return replies->write(std::as_bytes(std::span(&value, 1)));
  }
  std::unique_ptr<RealReceptor> requests;
  std::unique_ptr<RealEffector> replies;
  Request request;
};

}  // namespace tessera::ros2
