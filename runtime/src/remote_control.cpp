#include "remote_control.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tessera {
namespace {

using nlohmann::json;

constexpr std::int64_t values_period_ns = 40'000'000;
constexpr std::size_t largest_value = 4096, most_values = std::size_t{256} << 10U;  // bytes
constexpr double fastest = 1000;

void append_hex(const void* value, std::size_t size, std::string& to) {
  for (const auto* byte = static_cast<const unsigned char*>(value); size > 0; ++byte, --size) {
    to += "0123456789abcdef"[*byte >> 4U];
    to += "0123456789abcdef"[*byte & 15U];
  }
}

}  // namespace

RemoteControl::RemoteControl(Assembly& assembly, bool paused, double speed)
    : assembly_(assembly), paused_(paused), speed_(speed), news_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  update();
}

RemoteControl::~RemoteControl() { close(news_); }

// -------------------------------------------------------------------------------------------- the watcher's

std::string RemoteControl::command(const json& command) {
  const std::lock_guard lock(mutex_);
  const std::string what = command.is_object() ? command.value("command", "") : "";
  std::string wrong;
  if (what == "pause" || what == "resume") {
    paused_ = what == "pause";
    firings_left_ = 0;
    to_iteration_ = false;
    broke_at_.clear();
  } else if (what == "step_firing") {
    paused_ = true;
    ++firings_left_;
  } else if (what == "step_iteration") {
    wrong = step_iteration(command);
  } else if (what == "speed") {
    const json value = command.value("value", json());
    const double speed = value.is_number() ? value.get<double>() : -1;
    if (std::isfinite(speed) && speed >= 0 && speed <= fastest)
      speed_ = speed;
    else
      wrong = "a speed is a number from 0 (as fast as possible) to 1000";
  } else if (what == "breakpoints") {
    wrong = set_breakpoints(command);
  } else {
    wrong = "there is no such command";
  }
  if (!wrong.empty()) return wrong;
  update();
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(news_, &one, sizeof one);
  return {};
}

std::string RemoteControl::step_iteration(const json& command) {
  const std::string path = command.value("subsystem", "");
  std::uint32_t found = UINT32_MAX;
  for (std::uint32_t instance = 0; instance < assembly_.executors.size(); ++instance)
    if (assembly_.executors[instance]->path() == path) found = instance;
  if (!path.empty() && found == UINT32_MAX) return "there is no subsystem '" + path + "'";
  paused_ = true;
  to_iteration_ = true;
  iterating_ = found;
  iterations_.clear();
  return {};
}

std::string RemoteControl::set_breakpoints(const json& command) {
  std::vector<Breakpoint> wanted;
  for (const json& name : command.value("places", json::array())) {
    Breakpoint one{.name = name.is_string() ? name.get<std::string>() : std::string()};
    if (!find(one.name, one)) return "the controller has no place '" + one.name + "'";
    wanted.push_back(std::move(one));
  }
  breakpoints_ = std::move(wanted);
  return {};
}

bool RemoteControl::find(const std::string& name, Breakpoint& breakpoint) const {
  const auto index_in = [&](const auto& places, std::string_view owner) {
    for (std::uint32_t place = 0; place < places.size(); ++place)
      if (name.size() == owner.size() + 1 + places[place].name.size() && name.starts_with(owner) &&
          name[owner.size()] == '.' && name.ends_with(places[place].name))
        return place;
    return UINT32_MAX;
  };
  for (std::uint32_t instance = 0; instance < assembly_.executors.size(); ++instance) {
    const std::uint32_t place =
        index_in(assembly_.system.instances[instance].net->places, assembly_.executors[instance]->path());
    if (place == UINT32_MAX) continue;
    breakpoint.instance = instance;
    breakpoint.place = place;
    return true;
  }
  for (std::uint32_t channel = 0; channel < assembly_.system.channels.size(); ++channel) {
    const Channel& one = assembly_.system.channels[channel];
    const std::uint32_t place = index_in(one.places, one.name);
    if (place == UINT32_MAX) continue;
    breakpoint.channel = channel;
    breakpoint.place = place;
    return true;
  }
  return false;
}

RemoteControl::Shown RemoteControl::shown() const {
  const std::lock_guard lock(mutex_);
  return {resting(), speed_, broke_at_, pauses_, values_};
}

void RemoteControl::abandon() {
  assembly_.control.request_stop("who started it has gone", /*fault=*/false);
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(news_, &one, sizeof one);
}

// -------------------------------------------------------------------------------------------- the run's

void RemoteControl::update() { one_by_one_ = paused_ || !breakpoints_.empty(); }

void RemoteControl::take_news() const {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t taken = read(news_, &count, sizeof count);
}

bool RemoteControl::wait_while_paused(const StopSignals& signals, Time now) {
  bool waited = false;
  while (StopSignals::pending() == 0 && !assembly_.control.stopping()) {
    {
      const std::lock_guard lock(mutex_);
      if (!resting()) return waited;
      if (!waited) {
        ++pauses_;
        keep_values(now);
        if (assembly_.recorder != nullptr) assembly_.recorder->flush();
      }
    }
    std::array<pollfd, 2> sources{pollfd{.fd = news_, .events = POLLIN, .revents = 0},
                                  pollfd{.fd = signals.descriptor(), .events = POLLIN, .revents = 0}};
    poll(sources.data(), sources.size(), -1);
    take_news();
    waited = true;
  }
  return waited;
}

bool RemoteControl::wait_for(Duration time, const StopSignals& signals) {
  std::array<pollfd, 2> sources{pollfd{.fd = news_, .events = POLLIN, .revents = 0},
                                pollfd{.fd = signals.descriptor(), .events = POLLIN, .revents = 0}};
  const timespec left{.tv_sec = time.count() / 1'000'000'000, .tv_nsec = time.count() % 1'000'000'000};
  const bool interrupted = ppoll(sources.data(), sources.size(), &left, nullptr) > 0;
  take_news();
  return !interrupted;
}

bool RemoteControl::is_marked(const Breakpoint& breakpoint) const {
  if (breakpoint.instance != UINT32_MAX)
    return assembly_.executors[breakpoint.instance]->holds(breakpoint.place);
  return (assembly_.channels[breakpoint.channel]->marking() >> breakpoint.place & 1U) != 0;
}

void RemoteControl::about_to_fire() {
  const std::lock_guard lock(mutex_);
  if (to_iteration_ && iterations_.empty())
    for (const auto& executor : assembly_.executors)
      iterations_.push_back(executor->operations().iterations());
  for (Breakpoint& one : breakpoints_) {
    if (one.known) continue;
    one.known = true;
    one.marked = is_marked(one);
  }
}

void RemoteControl::fired(std::uint32_t instance) {
  const std::lock_guard lock(mutex_);
  if (firings_left_ > 0) --firings_left_;
  const bool counts = iterating_ == UINT32_MAX || iterating_ == instance;
  if (to_iteration_ && !iterations_.empty() && counts &&
      assembly_.executors[instance]->operations().iterations() > iterations_.at(instance))
    to_iteration_ = false;
  for (Breakpoint& one : breakpoints_) {
    const bool marked = is_marked(one);
    if (marked && !one.marked) {
      paused_ = true;
      firings_left_ = 0;
      to_iteration_ = false;
      broke_at_ = one.name;
    }
    one.known = true;
    one.marked = marked;
  }
  update();
}

void RemoteControl::show_values(Time now) {
  const std::int64_t wall_ns = monotonic_ns();
  if (wall_ns - values_at_ns_ < values_period_ns) return;
  values_at_ns_ = wall_ns;
  const std::lock_guard lock(mutex_);
  keep_values(now);
}

/// {"time_s", "buffers": {"robot.sensor.line": bytes in hexadecimal}}
void RemoteControl::keep_values(Time now) {
  values_ = "{\"time_s\":" + std::to_string(static_cast<double>(now.time_since_epoch().count()) * 1e-9) +
            ",\"buffers\":{";
  const char* separator = "\"";
  const auto add = [&](const std::string& path, const auto& buffers) {
    for (const auto& buffer : buffers) {
      // A value that is more than its bytes is an image or the like: too much to send so often.
      if (buffer.type != nullptr || buffer.size > largest_value || values_.size() > most_values) continue;
      values_.append(separator).append(path).append(".").append(buffer.name).append("\":\"");
      append_hex(buffer.value, buffer.size, values_);
      separator = "\",\"";
    }
  };
  for (const auto& executor : assembly_.executors) {
    const Bindings& bindings = executor->operations().parts().bindings;
    add(executor->path(), bindings.inputs);
    add(executor->path(), bindings.outputs);
    add(executor->path(), bindings.real_inputs);
    add(executor->path(), bindings.real_outputs);
  }
  values_ += *separator == '"' && separator[1] == '\0' ? "}}" : "\"}}";
}

}  // namespace tessera
