#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastdds/rtps/common/WriteParams.h>

#include <array>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// The other side of topics, by a DDS implementation that Tessera does not use: Fast DDS with its own CDR.
/// This file includes no header of Tessera. The types are written by hand, field after field, from the public
/// definitions of ROS 2.
namespace fast {

using eprosima::fastcdr::Cdr;

struct Header {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame_id;
  template <class Archive>
  void fields(Archive& all) {
    all(sec, nanosec, frame_id);
  }
};
struct Clock {
  static constexpr const char* name = "rosgraph_msgs::msg::dds_::Clock_";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(sec, nanosec);
  }
};
struct Text {
  static constexpr const char* name = "std_msgs::msg::dds_::String_";
  std::string data;
  template <class Archive>
  void fields(Archive& all) {
    all(data);
  }
};
struct Bool {
  static constexpr const char* name = "std_msgs::msg::dds_::Bool_";
  bool data = false;
  template <class Archive>
  void fields(Archive& all) {
    all(data);
  }
};
struct Twist {
  static constexpr const char* name = "geometry_msgs::msg::dds_::Twist_";
  double linear_x = 0, linear_y = 0, linear_z = 0, angular_x = 0, angular_y = 0, angular_z = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(linear_x, linear_y, linear_z, angular_x, angular_y, angular_z);
  }
};
struct LaserScan {
  static constexpr const char* name = "sensor_msgs::msg::dds_::LaserScan_";
  Header header;
  float angle_min = 0, angle_max = 0, angle_increment = 0, time_increment = 0, scan_time = 0, range_min = 0,
        range_max = 0;
  std::vector<float> ranges, intensities;
  template <class Archive>
  void fields(Archive& all) {
    header.fields(all);
    all(angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max, ranges,
        intensities);
  }
};
struct Odometry {
  static constexpr const char* name = "nav_msgs::msg::dds_::Odometry_";
  Header header;
  std::string child_frame_id;
  double x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1;
  std::array<double, 36> pose_covariance{};
  Twist twist;
  std::array<double, 36> twist_covariance{};
  template <class Archive>
  void fields(Archive& all) {
    header.fields(all);
    all(child_frame_id, x, y, z, qx, qy, qz, qw, pose_covariance);
    twist.fields(all);
    all(twist_covariance);
  }
};
struct JointState {
  static constexpr const char* name = "sensor_msgs::msg::dds_::JointState_";
  Header header;
  std::vector<std::string> names;
  std::vector<double> position, velocity, effort;
  template <class Archive>
  void fields(Archive& all) {
    header.fields(all);
    all(names, position, velocity, effort);
  }
};
struct Float64MultiArray {
  static constexpr const char* name = "std_msgs::msg::dds_::Float64MultiArray_";
  std::uint32_t dimensions = 0;  ///< an empty sequence of them
  std::uint32_t data_offset = 0;
  std::vector<double> data;
  template <class Archive>
  void fields(Archive& all) {
    all(dimensions, data_offset, data);
  }
};

/// nav_msgs/msg/Path: a sequence of structures.
struct PoseStamped {
  Header header;
  std::array<double, 7> pose{};  ///< x, y, z, quaternion
};
struct Path {
  static constexpr const char* name = "nav_msgs::msg::dds_::Path_";
  Header header;
  std::vector<PoseStamped> poses;
  template <class Archive>
  void fields(Archive& all) {
    header.fields(all);
    auto count = static_cast<std::uint32_t>(poses.size());
    all(count);
    poses.resize(count);
    for (PoseStamped& one : poses) {
      one.header.fields(all);
      for (double& number : one.pose) all(number);
    }
  }
};

/// tf2_msgs/msg/TFMessage.
struct TransformStamped {
  Header header;
  std::string child;
  std::array<double, 7> transform{0, 0, 0, 0, 0, 0, 1};  ///< x, y, z, quaternion
};
struct Transforms {
  static constexpr const char* name = "tf2_msgs::msg::dds_::TFMessage_";
  std::vector<TransformStamped> all_transforms;
  template <class Archive>
  void fields(Archive& all) {
    auto count = static_cast<std::uint32_t>(all_transforms.size());
    all(count);
    all_transforms.resize(count);
    for (TransformStamped& one : all_transforms) {
      one.header.fields(all);
      all(one.child);
      for (double& number : one.transform) all(number);
    }
  }
};

/// The two messages of std_srvs/srv/SetBool, with the header of rmw_cyclonedds_cpp.
struct SetBoolRequest {
  static constexpr const char* name = "std_srvs::srv::dds_::SetBool_Request_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  bool data = false;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, data);
  }
};
struct SetBoolResponse {
  static constexpr const char* name = "std_srvs::srv::dds_::SetBool_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  bool success = false;
  std::string message;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, success, message);
  }
};
/// The same without a header before the data, as rmw_fastrtps_cpp sends them.
struct BareSetBoolResponse {
  static constexpr const char* name = SetBoolResponse::name;
  bool success = false;
  std::string message;
  template <class Archive>
  void fields(Archive& all) {
    all(success, message);
  }
};
struct BareSetBoolRequest {
  static constexpr const char* name = SetBoolRequest::name;
  bool data = false;
  template <class Archive>
  void fields(Archive& all) {
    all(data);
  }
};

/// The announcement of a participant with one node, which has one writer and no reader. The identifiers have
/// 24 bytes up to ROS 2 Humble, and 16 since.
template <std::size_t identifier_size>
struct OneWriter {
  static constexpr const char* name = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
  std::array<std::uint8_t, identifier_size> participant{};
  std::uint32_t nodes = 1;
  std::string node_namespace = "/", node_name{};
  std::uint32_t readers = 0, writers = 1;
  std::array<std::uint8_t, identifier_size> writer{};
  template <class Archive>
  void fields(Archive& all) {
    all(participant, nodes, node_namespace, node_name, readers, writers, writer);
  }
};

/// A type without keys, serialised by Fast CDR.
template <class Message>
class Type final : public eprosima::fastdds::dds::TopicDataType {
 public:
  Type() {
    setName(Message::name);
    m_typeSize = 1 << 16;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
    eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->max_size);
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    payload->encapsulation = CDR_LE;
    cdr.serialize_encapsulation();
    auto put = [&](auto&... field) { ((cdr << field), ...); };
    static_cast<Message*>(data)->fields(put);
    payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
    return true;
  }
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    try {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
      cdr.read_encapsulation();
      auto take = [&](auto&... field) { ((cdr >> field), ...); };
      static_cast<Message*>(data)->fields(take);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* /*data*/) override {
    return [] { return 1U << 16; };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void* /*data*/, eprosima::fastrtps::rtps::InstanceHandle_t* /*key*/, bool /*md5*/) override {
    return false;
  }
};

/// The interfaces that a participant uses.
enum class Reach : std::uint8_t {
  loopback,  ///< without multicast
  announced,  ///< loopback, announced to a multicast group alone, as by rmw_fastrtps_cpp with ROS_LOCALHOST_ONLY=1
  all         ///< as Fast DDS does by itself: all interfaces, with multicast and shared memory
};

class Peer {
 public:
  explicit Peer(std::uint32_t domain, Reach reach = Reach::loopback);
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// topic: "rt/cmd_vel".
  template <class Message>
  eprosima::fastdds::dds::DataWriter* writer(const std::string& topic, bool reliable = true,
                                             const std::string& user_data = "",
                                             bool transient_local = false) {
    return make_writer(eprosima::fastdds::dds::TypeSupport(new Type<Message>), topic, reliable, user_data,
                       transient_local);
  }
  template <class Message>
  eprosima::fastdds::dds::DataReader* reader(const std::string& topic, bool transient_local = false,
                                             const std::string& user_data = "") {
    return make_reader(eprosima::fastdds::dds::TypeSupport(new Type<Message>), topic, transient_local,
                       user_data);
  }
  /// The next message; nullopt: there is none now.
  template <class Message>
  static std::optional<Message> take(eprosima::fastdds::dds::DataReader& reader) {
    Message message;
    eprosima::fastdds::dds::SampleInfo info;
    using eprosima::fastrtps::types::ReturnCode_t;
    while (reader.take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK)
      if (info.valid_data) return message;
    return std::nullopt;
  }
  /// A message, and the identities in its datagram.
  template <class Message>
  struct Identified {
    Message message;
    eprosima::fastrtps::rtps::SampleIdentity own, related;
  };
  template <class Message>
  static std::optional<Identified<Message>> take_identified(eprosima::fastdds::dds::DataReader& reader) {
    Identified<Message> taken;
    eprosima::fastdds::dds::SampleInfo info;
    using eprosima::fastrtps::types::ReturnCode_t;
    while (reader.take_next_sample(&taken.message, &info) == ReturnCode_t::RETCODE_OK) {
      taken.own = info.sample_identity;
      taken.related = info.related_sample_identity;
      if (info.valid_data) return taken;
    }
    return std::nullopt;
  }
  /// As the client of rmw_fastrtps_cpp: the identity beside the request names its reader of replies.
  /// Gives the identity that the reply must have.
  template <class Message>
  static eprosima::fastrtps::rtps::SampleIdentity request(eprosima::fastdds::dds::DataWriter& writer,
                                                          Message& message,
                                                          const eprosima::fastdds::dds::DataReader& replies) {
    eprosima::fastrtps::rtps::WriteParams parameters;
    parameters.related_sample_identity().writer_guid(replies.guid());
    writer.write(&message, parameters);
    parameters.sample_identity().writer_guid(replies.guid());
    return parameters.sample_identity();
  }
  /// As its server: the reply goes to the reader of replies, if the request names it, or else to its writer.
  template <class Message, class Request>
  static void reply(eprosima::fastdds::dds::DataWriter& writer, Message& message,
                    const Identified<Request>& request) {
    eprosima::fastrtps::rtps::WriteParams parameters;
    parameters.related_sample_identity(request.own);
    if (request.related.writer_guid() != eprosima::fastrtps::rtps::GUID_t::unknown())
      parameters.related_sample_identity().writer_guid(request.related.writer_guid());
    writer.write(&message, parameters);
  }
  static bool is_matched(eprosima::fastdds::dds::DataWriter& writer);
  static bool is_matched(eprosima::fastdds::dds::DataReader& reader);
  /// The number of readers that a writer has found, those that have left included.
  static int found_by(eprosima::fastdds::dds::DataWriter& writer);

 private:
  eprosima::fastdds::dds::DataWriter* make_writer(eprosima::fastdds::dds::TypeSupport type,
                                                  const std::string& topic, bool reliable,
                                                  const std::string& user_data, bool transient_local);
  eprosima::fastdds::dds::DataReader* make_reader(eprosima::fastdds::dds::TypeSupport type,
                                                  const std::string& topic, bool transient_local,
                                                  const std::string& user_data);
  eprosima::fastdds::dds::Topic* topic(eprosima::fastdds::dds::TypeSupport& type, const std::string& name);

  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace fast
