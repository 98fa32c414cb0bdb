#include "ros2/codec/message_steps.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "ros2/codec/field_paths.hpp"

namespace tessera::ros2 {

std::vector<Translator::Step> steps_of(const Structure& structure) {
  std::vector<Translator::Step> steps;
  for (const Field& field : structure.fields) {
    Translator::Step step;
    step.type = field.type;
    step.defaults = field.defaults;
    if (field.type.structure != nullptr) step.members = steps_of(*field.type.structure);
    steps.push_back(std::move(step));
  }
  return steps;
}

Translator::Step* find_step(std::vector<Translator::Step>& steps, const Structure& structure,
                            const std::string& name) {
  const Field* const field = structure.find(name);
  return field == nullptr ? nullptr : &steps[static_cast<std::size_t>(field - structure.fields.data())];
}

namespace {

void fill_frame(Translator::Step& header) {
  if (Translator::Step* const frame = find_step(header.members, *header.type.structure, "frame_id"))
    if (frame->type.primitive == Primitive::string) frame->fill = Translator::Fill::frame_id;
}

}  // namespace

bool is_header(const Type& type) {
  return type.refers == "std_msgs/msg/Header" && type.repeat == Type::Repeat::once;
}

bool fill_frames(std::vector<Translator::Step>& steps) {
  bool found = false;
  for (Translator::Step& step : steps) {
    if (is_header(step.type)) {
      fill_frame(step);
      found = true;
    } else if (step.type.structure != nullptr && step.type.repeat == Type::Repeat::once) {
      found = fill_frames(step.members) || found;
    }
  }
  return found;
}

void fill_header(Translator::Step& header) {
  const Structure& structure = *header.type.structure;
  fill_frame(header);
  Translator::Step* const stamp = find_step(header.members, structure, "stamp");
  if (stamp == nullptr || stamp->type.structure == nullptr) return;
  if (Translator::Step* const sec = find_step(stamp->members, *stamp->type.structure, "sec"))
    if (sec->type.primitive == Primitive::int32) sec->fill = Translator::Fill::stamp_sec;
  if (Translator::Step* const nanosec = find_step(stamp->members, *stamp->type.structure, "nanosec"))
    if (nanosec->type.primitive == Primitive::uint32) nanosec->fill = Translator::Fill::stamp_nanosec;
}

namespace {

bool are_names(const Field& field) {
  return (field.name == "name" || field.name == "joint_names") && field.type.primitive == Primitive::string &&
         field.type.repeat == Type::Repeat::sequence;
}

/// Sequences of numbers and texts are in the order of names.
void order_by_name(std::vector<Translator::Step>& steps, bool also_in_points) {
  for (Translator::Step& step : steps) {
    if (step.type.primitive != Primitive::structure)
      step.by_name = step.type.repeat == Type::Repeat::sequence;
    else if (also_in_points && step.type.refers == "trajectory_msgs/msg/JointTrajectoryPoint")
      order_by_name(step.members, /*also_in_points=*/false);
  }
}

}  // namespace

std::optional<std::string> use_names_of_joints(std::vector<Translator::Step>& steps,
                                               const Structure& message) {
  struct Part {
    std::vector<Translator::Step>* steps;
    const Structure* structure;
    std::string path;
  };
  std::vector<Part> parts{{&steps, &message, ""}};
  for (std::size_t at = 0; at < parts.size(); ++at) {  // those further inside come later
    const Part part = parts[at];
    const auto names = std::ranges::find_if(part.structure->fields, are_names);
    if (names != part.structure->fields.end()) {
      order_by_name(*part.steps, /*also_in_points=*/true);
      find_step(*part.steps, *part.structure, names->name)->fill = Translator::Fill::names;
      return member_path(part.path, names->name);
    }
    for (const Field& field : part.structure->fields)
      if (field.type.structure != nullptr && field.type.repeat == Type::Repeat::once)
        parts.push_back({&find_step(*part.steps, *part.structure, field.name)->members,
                         field.type.structure.get(), member_path(part.path, field.name)});
  }
  return std::nullopt;
}

std::optional<ArrayOfMessage> array_in(const std::string& path, std::vector<Translator::Step>& first,
                                       const Structure& message) {
  std::vector<Translator::Step>* steps = &first;
  const Structure* structure = &message;
  std::string way, rest = path;
  for (const std::string& part : split_path(path)) {
    Translator::Step* const step = structure == nullptr ? nullptr : find_step(*steps, *structure, part);
    if (step == nullptr) return std::nullopt;
    way = member_path(way, part);
    rest = rest.substr(std::min(part.size() + 1, rest.size()));
    if (step->type.structure != nullptr && step->type.repeat != Type::Repeat::once)
      return rest.empty() ? std::nullopt : std::optional(ArrayOfMessage{step, way, rest});
    steps = &step->members;
    structure = step->type.structure.get();
  }
  return std::nullopt;
}

}  // namespace tessera::ros2
