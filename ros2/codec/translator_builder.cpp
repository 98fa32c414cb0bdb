#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "ros2/codec/buffer_blocks.hpp"
#include "ros2/codec/cdr.hpp"
#include "ros2/codec/field_paths.hpp"
#include "ros2/codec/mapping_hints.hpp"
#include "ros2/codec/message_steps.hpp"
#include "ros2/codec/translator.hpp"
#include "tessera/nearest.hpp"

namespace tessera::ros2 {

class TranslatorBuilder {
 public:
  TranslatorBuilder(const ValueType& value, const Mapping& mapping, Direction direction,
                    std::vector<MappingProblem>& problems)
      : value_(value),
        mapping_(mapping),
        direction_(direction),
        receives_(direction == Direction::receive),
        problems_(problems) {}

  std::optional<Translator> make(std::shared_ptr<const Structure> message) {
    const std::size_t before = problems_.size();
    translator_.message_ = std::move(message);
    translator_.names_ = mapping_.names;
    translator_.names_may_be_empty_ = mapping_.parts_may_be_empty;
    translator_.frame_id_ = mapping_.frame_id;
    translator_.steps_ = steps_of(*translator_.message_);
    auto blocks = BufferBlocks::number(value_);
    if (!blocks) {
      wrong("the buffer has too many structures", "use arrays of numbers");
      return std::nullopt;
    }
    blocks_ = std::move(*blocks);
    translator_.blocks_ = blocks_.all();
    if (!refuse_wide_strings(*translator_.message_) || !check_fills() || !take_own_fields())
      return std::nullopt;
    mapping_.fields.empty() ? map_by_names() : map_as_told();
    if (problems_.size() == before) complain_of_rest();
    if (problems_.size() != before) return std::nullopt;
    return std::move(translator_);
  }

 private:
  void wrong(std::string text, Hint hint = {}) {
    problems_.push_back({subject_, std::move(text), std::move(hint)});
  }

  bool refuse_wide_strings(const Structure& structure) {
    for (const Field& field : structure.fields) {
      if (field.type.primitive == Primitive::wstring) {
        wrong(in_quotes(structure.name) + " has the wstring " + in_quotes(field.name),
              "implementations of DDS disagree on wide strings; let a node copy the message into one that "
              "has a "
              "string instead");
        return false;
      }
      if (field.type.structure != nullptr && !refuse_wide_strings(*field.type.structure)) return false;
    }
    return true;
  }

  /// The time, the frame and the names, which are sent without a part of the buffer.
  bool check_fills() {
    const Field* const header = translator_.message_->find("header");
    const bool stamped = header != nullptr && is_header(header->type);
    if (stamped && !receives_) fill_header(*find_step(translator_.steps_, *translator_.message_, "header"));
    subject_ = "frame_id";
    if (!mapping_.frame_id.empty() && (receives_ || (!stamped && !fill_frames(translator_.steps_)))) {
      wrong(receives_ ? "a receptor sends no frame_id"
                      : in_quotes(translator_.message_->name) + " has no header",
            "remove it");
      return false;
    }
    subject_ = "names";
    if (!mapping_.names.empty() && !use_names()) return false;
    subject_.clear();
    return true;
  }

  /// Fields that the driver itself sets or reads are no part of the message.
  bool take_own_fields() {
    bool good = true;
    for (const OwnField& own : mapping_.own) {
      const ValueType::Member* const member = value_.count == 0 ? value_.find(own.name) : nullptr;
      translator_.own_.emplace_back();
      if (member == nullptr && !own.needed) continue;
      if (member == nullptr || member->type.count != 0 ||
          std::ranges::find(own.types, member->type.primitive) == own.types.end()) {
        const std::string type = name_of(own.types.front());
        wrong(member == nullptr
                  ? "the buffer needs a field " + in_quotes(own.name) + ", " + own.meaning
                  : shown(own.name) + ", " + own.meaning + ", cannot be of type " + member->type.text(),
              "give it a structure with a field " + own.name + ": " + type);
        good = false;
        continue;
      }
      translator_.own_.back() = blocks_.at(own.name);
      used_.insert(*translator_.own_.back());
    }
    return good;
  }
  [[nodiscard]] bool is_own(const std::string& name) const {
    return std::ranges::find(mapping_.own, name, &OwnField::name) != mapping_.own.end();
  }

  bool use_names() {
    if (const auto field = use_names_of_joints(translator_.steps_, *translator_.message_)) {
      field_of_names_ = *field;
    } else {
      wrong(in_quotes(translator_.message_->name) + " has no field 'name' or 'joint_names' of type string[]",
            "names are for messages such as sensor_msgs/JointState");
      return false;
    }
    const std::set<std::string> different(mapping_.names.begin(), mapping_.names.end());
    if (different.size() != mapping_.names.size() || different.contains("")) {
      wrong("a name is empty, or there twice");
      return false;
    }
    return true;
  }

  void map_by_names() {
    if (value_.primitive == Primitive::structure && value_.count == 0) {
      match_members(value_, "", translator_.steps_, *translator_.message_, "");
      return;
    }
    const Structure& message = *translator_.message_;
    const Field* field = message.fields.size() == 1 ? &message.fields.front() : message.find("data");
    if (field == nullptr)
      return wrong("which field of " + in_quotes(message.name) + " is meant?",
                   "for example fields: " + (message.fields.empty() ? "data" : message.fields.back().name));
    match(value_, "", *find_step(translator_.steps_, message, field->name), field->name);
  }

  void map_as_told() {
    for (const auto& [of_message, of_value] : mapping_.fields) {
      subject_ = of_message;
      match_path({of_message, "", translator_.steps_, *translator_.message_}, {of_value, "", value_});
    }
    subject_.clear();
  }

  /// A path inside a message, or inside an element of an array of messages.
  struct MessagePath {
    std::string path, around;  ///< inside of it; that of the element, without numbers
    std::vector<Translator::Step>& steps;
    const Structure& structure;
  };
  struct ValuePath {
    std::string path, around;
    const ValueType& type;
  };

  /// A path through arrays of messages, and one through as many arrays of the buffer: "boxes.center.x" and "x".
  /// The field is that of every element.
  void match_path(const MessagePath& message, const ValuePath& value) {
    const auto array = array_in(message.path, message.steps, message.structure);
    const std::string whole = member_path(message.around, message.path);
    if (!array) {
      Translator::Step* const step = step_at(message.path, message.steps, message.structure);
      const ValueType* const part = step == nullptr ? nullptr : value_at(value.path, value.type);
      if (part != nullptr) match(*part, member_path(value.around, value.path), *step, whole);
      return;
    }
    const std::string array_path = member_path(message.around, array->path);
    const auto elements = elements_in(value.path, value.type);
    if (!elements)
      return wrong("the field " + in_quotes(whole) + " lies in the array " + in_quotes(array_path) +
                       ", and " + shown(without_numbers(member_path(value.around, value.path))) + " in none",
                   "give the buffer an array of structures, such as Element<=16, for the whole array");
    const std::string elements_path = member_path(value.around, elements->path);
    if (!divide(*elements->type, elements_path, *array->step, array_path)) return;
    ValueType element = *elements->type;
    element.count = 0;
    element.is_sequence = false;
    const std::size_t before = problems_.size();
    for (std::uint32_t index = 0; index < elements->type->count && problems_.size() == before; ++index)
      match_path({array->rest, array_path, array->step->members[index].members, *array->step->type.structure},
                 {elements->rest, element_path(elements_path, *elements->type, index), element});
  }

  /// Gives an array of messages a step for each element of the array of the buffer. false: they do not fit,
  /// which has been reported.
  bool divide(const ValueType& value, const std::string& value_path, Translator::Step& step,
              const std::string& message_path) {
    if (step.per_element) {
      if (step.array == value_path) return true;
      wrong(in_quotes(message_path) + " corresponds to " + shown(step.array) + " and to " +
            shown(value_path));
      return false;
    }
    if (!same_shape(value, value_path, step, message_path)) return false;
    step.per_element = true;
    step.array = value_path;
    Translator::Step one;
    one.type = step.type;
    one.members = std::move(step.members);
    one.type.repeat = Type::Repeat::once;
    step.members.assign(value.count, one);
    if (!value.is_sequence) return true;
    step.length = blocks_.length_at(value_path);
    if (!used_.insert(*step.length).second && receives_) {
      wrong("two arrays of the message for " + shown(value_path));
      return false;
    }
    return true;
  }

  Translator::Step* step_at(const std::string& path, std::vector<Translator::Step>& first,
                            const Structure& root) {
    std::vector<Translator::Step>* steps = &first;
    const Structure* structure = &root;
    Translator::Step* step = nullptr;
    for (const std::string& part : split_path(path)) {
      if (structure == nullptr) {
        wrong("the field " + in_quotes(path) + " lies in a number or text",
              "leave out what stands behind it");
        return nullptr;
      }
      step = find_step(*steps, *structure, part);
      if (step == nullptr) {
        wrong(in_quotes(structure->name) + " has no field " + in_quotes(part),
              hint_of(part, field_names(*structure), structure->name));
        return nullptr;
      }
      steps = &step->members;
      structure = step->type.structure.get();  // none of which is an array, as array_in has found
    }
    if (step == nullptr) wrong("a field of the message needs a name");
    return step;
  }

  const ValueType* value_at(const std::string& path, const ValueType& root) {
    const ValueType* value = &root;
    for (const std::string& part : split_path(path)) {
      const ValueType::Member* const member = value->count == 0 ? value->find(part) : nullptr;
      if (member == nullptr) {
        wrong(
            "the buffer has no field " + in_quotes(path),
            value->members.empty() ? Hint("its type is " + value->text())
            : value->count > 0
                ? Hint("it is an array: begin the field of the message with that of its array, as in array." +
                       part)
                : hint_of(part, member_names(*value), "the buffer"));
        return nullptr;
      }
      value = &member->type;
    }
    return value;
  }

  /// value_path, message_path: for error messages and for the numbers of blocks.
  void match(const ValueType& value, const std::string& value_path, Translator::Step& step,
             const std::string& message_path) {
    if (step.type.primitive == Primitive::structure || value.primitive == Primitive::structure)
      match_structures(value, value_path, step, message_path);
    else
      match_numbers(value, value_path, step, message_path);
  }

  void match_members(const ValueType& value, const std::string& value_path,
                     std::vector<Translator::Step>& steps, const Structure& structure,
                     const std::string& message_path) {
    std::set<std::string> proposed;
    for (const ValueType::Member& member : value.members) {
      if (value_path.empty() && is_own(member.name)) continue;
      if (Translator::Step* const step = find_step(steps, structure, member.name))
        match(member.type, member_path(value_path, member.name), *step,
              member_path(message_path, member.name));
      else
        wrong(in_quotes(structure.name) + " has no field " + in_quotes(member.name),
              missing_member_hint(member, value_path, structure, message_path, direction_, proposed));
    }
  }

  void match_structures(const ValueType& value, const std::string& value_path, Translator::Step& step,
                        const std::string& message_path) {
    if (value.primitive != step.type.primitive) return differ(value, value_path, step, message_path);
    if (!same_shape(value, value_path, step, message_path)) return;
    const Structure& structure = *step.type.structure;
    if (value.count == 0) return match_members(value, value_path, step.members, structure, message_path);
    if (const std::string fields = fields_of_elements(value, value_path, structure, message_path, direction_);
        !fields.empty())
      return wrong("the elements of " + in_quotes(message_path) + " do not have the fields of those of " +
                       shown(value_path),
                   fields);
    if (!divide(value, value_path, step, message_path)) return;
    const std::size_t before = problems_.size();
    for (std::uint32_t index = 0; index < value.count && problems_.size() == before; ++index)
      match_members(value, element_path(value_path, value, index), step.members[index].members, structure,
                    message_path);
  }

  void match_numbers(const ValueType& value, const std::string& value_path, Translator::Step& step,
                     const std::string& message_path) {
    const Primitive from = receives_ ? step.type.primitive : value.primitive;
    const Primitive to = receives_ ? value.primitive : step.type.primitive;
    if (!converts_exactly(from, to)) return differ(value, value_path, step, message_path);
    if (!same_shape(value, value_path, step, message_path)) return;
    if (from == Primitive::string && !receives_ && step.type.string_bound > 0 &&
        step.type.string_bound < value.capacity)
      return differ(value, value_path, step, message_path);
    if (step.fill == Translator::Fill::names)
      return wrong(in_quotes(field_of_names_) + " is compared with the names and has no place in the buffer");
    const std::size_t block = blocks_.at(value_path);
    if (!used_.insert(block).second && receives_)
      return wrong("two fields of the message for " + shown(value_path));
    step.block = block;
    if (step.by_name && value.count != mapping_.names.size())
      wrong("there are " + std::to_string(mapping_.names.size()) + " names, and " + shown(value_path) +
            " is " + value.text());
  }

  bool same_shape(const ValueType& value, const std::string& value_path, const Translator::Step& step,
                  const std::string& message_path) {
    using Repeat = Type::Repeat;
    // A sequence of the buffer takes a message's sequence of any bound: what is too long is dropped.
    const bool bounded_enough = step.type.count == 0 || value.count <= step.type.count;
    const bool fits = step.type.repeat == Repeat::once ? value.count == 0
                      : step.type.repeat == Repeat::array
                          ? value.count == step.type.count && !value.is_sequence
                          : value.count > 0 && (value.is_sequence || !mapping_.parts_may_be_empty) &&
                                (bounded_enough || (value.is_sequence && receives_));
    if (!fits) differ(value, value_path, step, message_path);
    return fits;
  }

  void differ(const ValueType& value, const std::string& value_path, const Translator::Step& step,
              const std::string& message_path) {
    const std::string of_message = in_quotes(message_path) + " of type " + step.type.text();
    const std::string of_value = shown(value_path) + " of type " + value.text();
    wrong(receives_ ? of_message + " does not fit " + of_value : of_value + " does not fit " + of_message,
          fitting_type(step));
  }

  /// A part of the buffer that is silently left out would be worse than an error.
  void complain_of_rest() {
    for (std::size_t block = 0; block < translator_.blocks_.size(); ++block)
      if (!used_.contains(block))
        return wrong("no field of the message corresponds to " + shown(translator_.blocks_[block].path),
                     "name it in `fields`");
    if (translator_.blocks_.empty()) wrong("the buffer has no fields");
  }

  const ValueType& value_;
  const Mapping& mapping_;
  Direction direction_;
  bool receives_;
  std::vector<MappingProblem>& problems_;
  Translator translator_;
  std::string subject_;
  BufferBlocks blocks_;
  std::string field_of_names_;  ///< the path in the message; empty: no names are used
  std::set<std::size_t> used_;
};

std::optional<Translator> Translator::make(std::shared_ptr<const Structure> message, const ValueType& value,
                                           const Mapping& mapping, Direction direction,
                                           std::vector<MappingProblem>& problems) {
  return TranslatorBuilder(value, mapping, direction, problems).make(std::move(message));
}

}  // namespace tessera::ros2
