#include "cli/recordings/bags.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "bag/bag_inputs.hpp"
#include "bag/bag_reader.hpp"
#include "bag/bag_writer.hpp"
#include "bag/raw_channel.hpp"
#include "cli/outputs.hpp"
#include "cli/terminal.hpp"
#include "mcap/records.hpp"
#include "net/pnml.hpp"
#include "project/files/file_names.hpp"
#include "project/files/ros2_messages.hpp"
#include "tessera/growing_recording.hpp"
#include "verify/hashes.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

namespace {

bag::RosBuffer ros_buffer_of(const spec::Model& model, const spec::Driver& driver) {
  const auto text = [&](const char* option) { return project::text_option(driver, option); };
  const std::string& topic = driver.target();
  return {model.driver_path(driver),
          topic.starts_with('/') ? topic : "/" + topic,
          text("type"),
          text("definition"),
          text("fields"),
          text("names"),
          text("frame_id")};
}

bool is_ros(const spec::Driver& driver) { return driver.kind == "ros2" && driver.real.valid(); }

/// nullopt: the driver is none of a topic whose messages are the values of its buffer.
std::optional<bag::RosBuffer> topic_of(const spec::Model& model, const spec::Driver& driver) {
  if (!is_ros(driver) || project::has_role(driver) || project::is_transform(driver)) return std::nullopt;
  return ros_buffer_of(model, driver);
}

/// The real inputs that can get values from a bag.
struct WantedInputs {
  std::vector<bag::WantedInput> wanted;
  std::vector<std::string> without;  ///< why the others get none
};

/// Requests and replies are in no topic; of the messages of an action, state and feedback are.
std::string why_without(const std::string& path, const spec::Driver* driver) {
  if (driver == nullptr || !is_ros(*driver)) return path + " has no topic in `drivers`, so it gets no value";
  if (project::is_transform(*driver))
    return path + " is a transform, which is not made of the messages of a bag, so it gets no value";
  const bool is_client = project::text_option(*driver, "role") == "client";
  return fmt::format("{} is on the side of the {} of the {} {}, and no bag has its {}, so it gets no value",
                     path, is_client ? "client" : "server",
                     project::is_action(*driver) ? "action" : "service", driver->target(),
                     is_client                     ? "replies"
                     : project::is_action(*driver) ? "goals"
                                                   : "requests");
}

WantedInputs wanted_inputs(const spec::Model& model) {
  WantedInputs inputs;
  for (const spec::InstanceId instance : model.instances.ids()) {
    const spec::Subsystem& subsystem = model.subsystem(instance);
    if (subsystem.kind != spec::SubsystemKind::receptor) continue;
    for (const spec::RealId real : subsystem.real.ids()) {
      const auto driver = std::ranges::find_if(model.drivers, [&](const spec::Driver& one) {
        return one.instance == instance && one.real == real;
      });
      const spec::Driver* const its = driver == model.drivers.end() ? nullptr : &*driver;
      const bool is_goal = its != nullptr && is_ros(*its) && project::is_action(*its) &&
                           project::text_option(*its, "role") == "client";
      if (is_goal || (its != nullptr && topic_of(model, *its)))
        inputs.wanted.push_back(
            {ros_buffer_of(model, *its), model.layout_of(subsystem.real[real].type), is_goal});
      else
        inputs.without.push_back(
            why_without(model.instance_path(instance) + "." + subsystem.real[real].name, its));
    }
  }
  return inputs;
}

std::string duration_up_to(std::int64_t time_ns) {
  return fmt::format("{:.9f}s", static_cast<double>(time_ns + 1) * 1e-9);
}

void note_units(const spec::Model& model, const spec::Type& type, const std::string& path,
                std::map<std::string, std::string>& units) {
  if (type.kind != spec::Type::Kind::structure) {
    if (!type.unit.empty()) units[path] = type.unit;
    return;
  }
  for (const spec::Field& field : model.structures[type.structure].fields)
    note_units(model, field.type, path.empty() ? field.name : path + "." + field.name, units);
}

std::map<std::string, std::map<std::string, std::string>> units_of(const spec::Model& model) {
  std::map<std::string, std::map<std::string, std::string>> units;
  for (const spec::InstanceId instance : model.instances.ids()) {
    const spec::Subsystem& subsystem = model.subsystem(instance);
    const std::string path = model.instance_path(instance) + ".";
    const auto note = [&](const auto& fields, const std::string& prefix) {
      for (const spec::Field& field : fields)
        if (!field.few) note_units(model, field.type, "", units[path + prefix + field.name]);
    };
    note(subsystem.inputs, "");
    note(subsystem.outputs, "");
    note(subsystem.real, "");
    note(subsystem.memory, "memory.");
  }
  return units;
}

/// Bytes go to the file as soon as they are complete.
class BagFile {
 public:
  explicit BagFile(const std::string& file) : name_(file) {
    check_replaceable(file, mcap::magic);
    stream_.open(file, std::ios::binary | std::ios::trunc);
    write({});
  }
  void write(const std::string& bytes) {
    if (!(stream_ << bytes)) fail();
  }
  void close() {
    stream_.close();
    if (!stream_) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(fmt::format("cannot write {}: {}", name_, std::strerror(errno)));
  }
  std::string name_;
  std::ofstream stream_;
};

}  // namespace

bag::Background background_of(const project::Specification& specification, const net::Net& net) {
  bag::Background background{{}, units_of(specification.model), {}};
  for (const spec::Driver& driver : specification.model.drivers)
    if (auto topic = topic_of(specification.model, driver)) background.ros.push_back(*std::move(topic));
  const diagnostics::Diagnostics& source = specification.diagnostics;
  const auto add = [&](std::string name, const std::string& text) {
    background.files.push_back({std::move(name), "application/yaml", text});
  };
  add(project::file_names::specification, source.text());
  const std::vector<std::string> included = source.sources().included();
  for (std::size_t number = 0; number < included.size(); ++number)
    add(included[number], source.included_text(number));
  background.files.push_back(
      {"net.pnml", "application/xml", net::to_pnml(net, {specification.model.system})});
  return background;
}

bag::Background background_of(const project::Specification& specification) {
  const std::optional<project::Nets> nets = project::build(specification, terminal());
  if (!nets) throw std::runtime_error("the net of the specification cannot be built");
  return background_of(specification, nets->flat);
}

namespace {

constexpr std::size_t read_at_once = 1U << 20U;

/// The background of a recording. Says on standard error if the specification is missing, or is another one.
bag::Background background_beside(const Recording& recording, const std::string& specification) {
  std::string missing = "no specification is beside the recording";
  if (!specification.empty()) {
    missing = specification + " is not the specification of this recording";
    const std::optional<project::Specification> read = project::read(specification, terminal());
    const std::optional<project::Nets> nets = read ? project::build(*read, terminal()) : std::nullopt;
    if (nets && verify::hash_of(nets->flat) == recording.net_hash) return background_of(*read, nets->flat);
  }
  fmt::print(stderr, "note: {}: the bag has no messages of ROS 2, no units and no net; name it with --spec\n",
             missing);
  return {};
}

/// A recording that becomes the file of a bag, entry by entry.
class WrittenBag {
 public:
  WrittenBag(const Recording& recording, const std::string& specification, const std::string& file)
      : file_(file), writer_(recording, background_beside(recording, specification), bag_library) {}
  void add(const std::vector<Recording::Entry>& entries) {
    for (const Recording::Entry& entry : entries) {
      writer_.add(entry);
      file_.write(writer_.take());
    }
  }
  void finish(bool has_ended, std::uint64_t lost) {
    if (has_ended) writer_.end(lost);
    writer_.finish();
    file_.write(writer_.take());
    file_.close();
  }

 private:
  BagFile file_;
  bag::BagWriter writer_;
};

}  // namespace

void write_bag(const Recording& recording, const std::string& specification, const std::string& file) {
  WrittenBag bag(recording, specification, file);
  bag.add(recording.entries);
  bag.finish(!recording.truncated, recording.lost);
}

bool write_bag_of_file(const std::string& recording, const std::string& specification,
                       const std::string& file) {
  if (!fs::is_regular_file(recording) || end_of(recording) == FileEnd::goes_on) return false;
  GrowingRecording source(recording, GrowingRecording::From::oldest);
  auto reader = std::make_unique<RecordingReader>();
  std::optional<WrittenBag> bag;
  std::optional<std::int64_t> lost_up_to_ns;
  std::uint64_t lost = 0;
  for (auto piece = source.next(read_at_once); !piece.bytes.empty(); piece = source.next(read_at_once)) {
    if (piece.begins) {
      lost += reader->recording().lost;
      reader = std::make_unique<RecordingReader>();
    }
    reader->feed(piece.bytes);
    if (reader->problem()) {
      if (!bag) return false;
      bag.reset();
      fs::remove(file);
      throw std::runtime_error(fmt::format("'{}' {}", recording, reader->problem()->text));
    }
    if (!reader->has_header()) continue;
    Recording& read = reader->recording();
    if (!bag) {
      if (lacks_beginning(read) && !read.entries.empty()) lost_up_to_ns = read.entries.front().event.time_ns;
      bag.emplace(read, specification, file);
    }
    bag->add(read.entries);
    read.entries.clear();
  }
  if (!bag) return false;
  bag->finish(reader->has_ended(), lost + reader->recording().lost);
  if (lost_up_to_ns) fmt::print(stderr, "note: {}\n", note_on_lost_beginning(lost_up_to_ns));
  return true;
}

std::optional<ReadRun> read_run(const std::string& file, std::string& error) {
  if (!bag::is_bag(file)) {
    std::optional<Recording> recording = read_recording(file, error);
    if (!recording) return std::nullopt;
    return ReadRun{*std::move(recording), {}};
  }
  std::optional<bag::Bag> bag = bag::read_bag(file, error);
  if (!bag) return std::nullopt;
  if (const std::string told = bag->condition.told(); !told.empty())
    fmt::print(stderr, "note: {}: {}\n", file, told);
  for (const std::string& difference : bag->differences) complain(file + ": " + difference);
  return ReadRun{std::move(bag->recording), std::move(bag->differences)};
}

std::optional<std::string> unpacked(const std::string& file, const std::string& folder) {
  if (!bag::is_bag(file)) return std::nullopt;
  std::string error;
  const std::optional<ReadRun> run = read_run(file, error);
  if (!run) throw std::runtime_error(error);
  if (!run->differences.empty())
    throw std::runtime_error(file + " shows another run than the recording in it");
  const Recording& recording = run->recording;
  const std::string name = (fs::path(folder) / "inputs.tsr").string();
  std::ofstream stream(name, std::ios::binary);
  stream << bag::file_start(recording.header);
  for (const Recording::Entry& entry : recording.entries) stream << bag::file_bytes(bag::raw_of(entry));
  if (!recording.truncated)
    stream << bag::raw_end(recording.entries.empty() ? 0 : recording.entries.back().event.time_ns,
                           recording.lost);
  if (!stream.flush()) throw std::runtime_error("cannot write " + name);
  return name;
}

RunInputs inputs_of_run(const project::Specification& specification, const std::string& file,
                        const std::string& folder) {
  std::string error;
  const auto end_of = [](const Recording& recording) {
    std::int64_t end_ns = 0;
    for (const Recording::Entry& entry : recording.entries) end_ns = std::max(end_ns, entry.event.time_ns);
    return duration_up_to(end_ns);
  };
  if (!bag::is_bag(file)) {
    const std::optional<Recording> recording = read_recording(file, error);
    if (!recording) throw std::runtime_error(error);
    return {fs::absolute(file).string(), end_of(*recording)};
  }
  const std::optional<std::string> bytes = bag::bytes_of_file(file, error);
  if (!bytes) throw std::runtime_error(error);
  if (bag::read_bag_bytes(*bytes, error)) {
    const std::string recording = *unpacked(file, folder);
    const std::optional<Recording> read = read_recording(recording, error);
    if (!read) throw std::runtime_error(error);
    return {recording, end_of(*read)};
  }
  const WantedInputs real = wanted_inputs(specification.model);
  const std::optional<bag::BagInputs> inputs =
      bag::inputs_of(*bytes, specification.model.system, real.wanted, error);
  if (!inputs) throw std::runtime_error(file + " " + error);
  for (const std::string& note : inputs->notes) fmt::print(stderr, "note: {}: {}\n", file, note);
  for (const std::string& why : real.without) fmt::print(stderr, "note: {}\n", why);
  const std::string name = (fs::path(folder) / "inputs.tsr").string();
  std::ofstream stream(name, std::ios::binary);
  if (!(stream << inputs->recording << std::flush)) throw std::runtime_error("cannot write " + name);
  return {name, duration_up_to(inputs->end_ns)};
}

}  // namespace tessera::cli
