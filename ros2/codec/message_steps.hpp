#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ros2/codec/translator.hpp"
#include "ros2/definitions/type.hpp"

/// The steps of a translator for the fields of a message.
namespace tessera::ros2 {

/// A step for each field of the structure, in its order; none corresponds to a part of the buffer yet.
[[nodiscard]] std::vector<Translator::Step> steps_of(const Structure& structure);
/// The step for that field of the structure, of which `steps` are; nullptr: it has no such field.
[[nodiscard]] Translator::Step* find_step(std::vector<Translator::Step>& steps, const Structure& structure,
                                          const std::string& name);
/// Whether it is a std_msgs/Header, and no array of them.
[[nodiscard]] bool is_header(const Type& type);
/// Lets the translator fill the time and the frame of a std_msgs/Header.
void fill_header(Translator::Step& header);

/// Lets the translator fill the frames of all headers in a message, except for those in arrays, and none of the times. false:
/// there is no header.
bool fill_frames(std::vector<Translator::Step>& steps);

/// Finds the field with the names of joints: `name` or `joint_names`, a sequence of strings in the message itself
/// or, if it has none, in a structure inside that is no array. Lets the translator send the names in it, and
/// take the sequences in their order: those beside the names, and those of a trajectory_msgs/JointTrajectoryPoint
/// beside them.
///
/// The path of the field; nullopt: there is none.
std::optional<std::string> use_names_of_joints(std::vector<Translator::Step>& steps,
                                               const Structure& message);

struct ArrayOfMessage {
  Translator::Step* step;
  std::string path, rest;  ///< of the array; inside its elements
};
/// The first array of messages through which the path leads, to something inside; nullopt: there is none.
[[nodiscard]] std::optional<ArrayOfMessage> array_in(const std::string& path,
                                                     std::vector<Translator::Step>& first,
                                                     const Structure& message);

}  // namespace tessera::ros2
