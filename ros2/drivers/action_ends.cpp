#include "ros2/drivers/action_ends.hpp"

#include <algorithm>
#include <string>

#include "ros2/naming/names.hpp"

namespace tessera::ros2 {
namespace {

ServiceSetup part_of(const ServiceSetup& action, const std::string& name, const std::string& type) {
  ServiceSetup part = action;
  part.endpoint.topic = name;
  part.type = type;
  return part;
}

/// Requests about several goals may be on their way.
ServiceSetup of_many(ServiceSetup part) {
  part.one_at_a_time = false;
  return part;
}

ServiceSetup goal_service(const ServiceSetup& action) {
  const ActionNames names = names_of_action(action.endpoint.topic, action.type);
  return part_of(action, names.send_goal, names.send_goal_type);
}
ServiceSetup result_service(const ServiceSetup& action) {
  const ActionNames names = names_of_action(action.endpoint.topic, action.type);
  return of_many(part_of(action, names.get_result, names.get_result_type));
}
ServiceSetup cancel_service(const ServiceSetup& action) {
  const ActionNames names = names_of_action(action.endpoint.topic, action.type);
  return of_many(part_of(action, names.cancel_goal, names.cancel_goal_type));
}

EndpointSetup topic_of(const ServiceSetup& action, const std::string& name, const std::string& type) {
  EndpointSetup topic = action.endpoint;
  topic.topic = name;
  topic.dds_topic = dds_topic_name(name);
  topic.dds_type = dds_type_name(type);
  topic.qos = Qos{};
  return topic;
}
EndpointSetup feedback_topic(const ServiceSetup& action) {
  const ActionNames names = names_of_action(action.endpoint.topic, action.type);
  return topic_of(action, names.feedback, names.feedback_type);
}
EndpointSetup status_topic(const ServiceSetup& action) {
  const ActionNames names = names_of_action(action.endpoint.topic, action.type);
  EndpointSetup topic = topic_of(action, names.status, names.status_type);
  topic.qos = Qos{.transient_local = true, .depth = 1};
  return topic;
}

}  // namespace

ActionEnds::ActionEnds(const ServiceSetup& setup)
    : send_goal(goal_service(setup)),
      get_result(result_service(setup)),
      cancel_goal(cancel_service(setup)),
      feedback(feedback_topic(setup), /*writes=*/!setup.is_client),
      status(status_topic(setup), /*writes=*/!setup.is_client) {}

ServiceEnds::Servers ActionEnds::servers() {
  ServiceEnds::Servers all = send_goal.servers();
  for (ServiceEnds* const service : {&get_result, &cancel_goal}) {
    const ServiceEnds::Servers one = service->servers();
    all.ready = std::min(all.ready, one.ready);
    all.foreign = all.foreign || one.foreign;
  }
  return all;
}

std::vector<std::vector<std::byte>> ActionEnds::messages_of(const Endpoint& topic) {
  std::vector<std::vector<std::byte>> messages;
  topic.take(
      [](void* all, const TakenBlob& blob) {
        static_cast<std::vector<std::vector<std::byte>>*>(all)->emplace_back(blob.message.begin(),
                                                                             blob.message.end());
      },
      &messages);
  return messages;
}

}  // namespace tessera::ros2
