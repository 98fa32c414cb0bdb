#include "ros2/drivers/prepared.hpp"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ros2/arguments/rules.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"
#include "ros2/tf/transform_value.hpp"

namespace tessera::ros2 {
namespace {

template <class T>
T given(std::optional<T> value, const std::string& error) {
  if (!value) throw std::runtime_error(error);
  return *std::move(value);
}

/// Whether the messages of a driver with a role go from client to server.
bool asks(const Ros2Binding& binding, Direction direction) {
  return (binding.role == "client") == (direction == Direction::send);
}

/// The message of the buffer; for a service or action, one of its two.
std::string message_type(const Ros2Binding& binding, Direction direction) {
  if (binding.role.empty()) return binding.type;
  if (is_action_type(binding.type))
    return asks(binding, direction) ? goal_type(binding.type) : progress_type(binding.type);
  return asks(binding, direction) ? request_type(binding.type) : response_type(binding.type);
}

std::shared_ptr<const Structure> message_of(const Ros2Binding& binding, Direction direction) {
  if (binding.encoding == nullptr)
    throw std::runtime_error("its real buffer has a type without a fixed form");
  if (!binding.frame.empty()) return transform_structure();
  const std::string type = message_type(binding, direction);
  std::vector<Mistake> mistakes;
  const auto message = resolve(type, DefinitionBundle(type, binding.definition), mistakes);
  if (message == nullptr)
    throw std::runtime_error(mistakes.empty() ? "no definition of " + type : mistakes.front().shown());
  return message;
}

Translator translator_of(const Ros2Binding& binding, Direction direction,
                         const std::shared_ptr<const Structure>& message) {
  const auto value = parse_value_type(binding.encoding->type());
  if (!value) throw std::runtime_error("its real buffer has a type that no message has");
  Mapping mapping = written_mapping(binding.fields, binding.names, binding.frame_id);
  if (is_action_type(binding.type))
    mapping = mapping_of_action(std::move(mapping), asks(binding, direction), direction);
  else if (!binding.role.empty())
    mapping.own = own_fields_of_service(binding.role == "client" && direction == Direction::receive);
  if (!binding.frame.empty() && direction == Direction::send) mapping.own = own_fields_of_transform();
  std::vector<MappingProblem> problems;
  auto translator = Translator::make(message, *value, mapping, direction, problems);
  return given(std::move(translator), problems.empty() ? "no mapping" : problems.front().text);
}

/// Sets the final names of the topic and the node, after the rules of the process.
void name(EndpointSetup& endpoint, const Ros2Binding& binding) {
  const std::string written =
      binding.node.empty() ? node_name_of(binding.path.substr(0, binding.path.find('.'))) : binding.node;
  if (!is_node_name(written)) throw std::runtime_error("'" + written + "' is no name of a node");
  const Rules rules = rules_of_process();
  const NodeName node = rules.node(written);
  const bool is_topic = binding.role.empty() && !is_action_type(binding.type);
  std::string error;
  endpoint.node = node.full();
  endpoint.topic = full_topic_name(binding.topic, error);
  if (!endpoint.topic.empty())
    endpoint.topic = full_topic_name(
        rules.name(is_topic ? Rules::Kind::topic : Rules::Kind::service, binding.topic, node), error);
  if (endpoint.topic.empty()) throw std::runtime_error(error);
}

}  // namespace

Prepared prepare(const Ros2Binding& binding, Direction direction) {
  std::string error;
  const auto message = message_of(binding, direction);
  Prepared prepared{message,      translator_of(binding, direction, message),
                    {},           binding.encoding,
                    binding.wait, binding.one_publisher};
  EndpointSetup& endpoint = prepared.endpoint;
  endpoint.path = binding.path;
  name(endpoint, binding);
  if (binding.role.empty()) {
    endpoint.dds_topic = dds_topic_name(endpoint.topic);
    endpoint.dds_type = dds_type_name(binding.type);
  }
  endpoint.qos = given(parse_qos(binding.qos, error), error);
  endpoint.network = {binding.domain ? *binding.domain : domain_of_environment(), binding.interface,
                      binding.peers};
  static_cast<void>(configuration_of(endpoint.network));  // finds mistakes before a device is opened
  return prepared;
}

}  // namespace tessera::ros2
