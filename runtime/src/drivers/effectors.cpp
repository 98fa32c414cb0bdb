#include "drivers/effectors.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "system/waker.hpp"

namespace tessera {
namespace {

thread_local constinit const void* in_call = nullptr;

}  // namespace

/// One thread at a time calls the driver of a device. Another thread comes only if something has gone
/// wrong, so the lock normally costs no system call.
class Effectors::Lock {
 public:
  Lock(Device& device, Busy busy) : device_(device) {
    while (device_.in_use.test_and_set(std::memory_order_acquire)) {
      if (busy == Busy::leaves_out) return;
      device_.in_use.wait(true, std::memory_order_relaxed);
    }
    held_ = true;
    in_call = &device_;
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() {
    if (!held_) return;
    in_call = nullptr;
    device_.in_use.clear(std::memory_order_release);
    device_.in_use.notify_one();
  }
  explicit operator bool() const { return held_; }

 private:
  Device& device_;
  bool held_ = false;
};

Effectors::Effectors(std::vector<Group> devices, std::span<const std::unique_ptr<RealEffector>> drivers,
                     std::span<const Bindings::RealOutgoing> outputs, const RunControl& control,
                     const Clock& clock)
    : drivers_(drivers),
      outputs_(outputs),
      control_(control),
      clock_(clock),
      count_(devices.size()),
      devices_(std::make_unique<Device[]>(devices.size())) {
  for (std::size_t index = 0; index < count_; ++index) devices_[index].its = std::move(devices[index]);
}

// -------------------------------------------------------------------------------------------- commands

Effectors::Answer Effectors::command(Time now, const RunControl::Interruptions& before) {
  told_ = SafeReason::Kind::none;
  const auto withheld = [&] { return control_.withholds_commands() || control_.interruptions() != before; };
  for (Device& device : devices()) {
    const Lock lock(device, Busy::waits);
    // Checked under the lock: the safe command of another thread is then the later one.
    if (withheld()) return Answer::withheld;
    device.safe = false;  // even if the driver does not return
    if (!write(device, now)) {
      refuser_ = device.its.name;
      return Answer::refused;
    }
    // A thread that withholds commands and then finds the device in use relies on
    // this thread to notice that.
    device.owes = device.resists = false;
    device.owes = withheld();
    if (device.standing.kind != SafeReason::Kind::none) device.since = now;
    device.standing = {};
    if (device.owes) return Answer::withheld;
  }
  return Answer::taken;
}

bool Effectors::write(Device& device, Time now) {
  for (std::size_t index = device.its.first; index < device.its.first + device.its.count; ++index) {
    const Bindings::RealOutgoing& output = outputs_[index];
    if (!drivers_[index]->write({static_cast<const std::byte*>(output.value), output.size})) return false;
    output.departure->stamp = now;
  }
  return true;
}

bool Effectors::make_safe(SafeReason why, Busy busy) { return make_safe(why, busy, /*owing_only=*/false); }

bool Effectors::insist(SafeReason why, Busy busy) { return make_safe(why, busy, /*owing_only=*/true); }

bool Effectors::make_safe(SafeReason why, Busy busy, bool owing_only) {
  bool all = true;
  if (busy == Busy::waits) {
    giving_since_ns_ = monotonic_ns();
    if (std::exchange(told_, why.kind) != why.kind) control_.tell_supervisor();
  }
  for (Device& device : devices()) {
    if (owing_only && !device.owes) continue;
    device.owes = true;
    const Lock lock(device, busy);
    all = lock && write_safe(device, why) && all;
  }
  if (busy == Busy::waits) giving_since_ns_ = 0;
  return all;
}

bool Effectors::make_safe_one(std::size_t index, SafeReason why, Busy busy) {
  Device& device = devices_[index];
  device.owes = true;
  const Lock lock(device, busy);
  return lock && write_safe(device, why);
}

/// Call it with the device's lock.
bool Effectors::write_safe(Device& device, SafeReason why) {
  // Before the driver is called: a stop that begins during the call may come after another command.
  const std::uint32_t stop = control_.emergency() ? control_.emergencies() : 0;
  bool taken = true;
  for (std::size_t index = device.its.first; index < device.its.first + device.its.count; ++index) {
    const Bindings::RealOutgoing& output = outputs_[index];
    try {
      taken =
          drivers_[index]->write({static_cast<const std::byte*>(output.safe.get()), output.size}) && taken;
    } catch (const abi::__forced_unwind&) {
      throw;
    } catch (...) {  // the other devices must get theirs
      taken = false;
    }
  }
  device.refused = !taken;
  device.stopped_in = taken ? stop : 0;
  if (!taken) {
    device.since = clock_.now();
    note_resistance(device);
    return false;
  }
  device.owes = device.resists = false;
  device.safe = true;
  device.complained = false;
  if (device.standing != why) device.since = clock_.now();
  device.standing = why;
  return true;
}

const void* Effectors::device_in_call() { return in_call; }

bool Effectors::rescue(std::size_t index, const void* dead) {
  Device& device = devices_[index];
  device.owes = true;
  const Lock lock(device, Busy::leaves_out);
  return (lock || dead == &device) && write_safe(device, {SafeReason::Kind::leaves});
}

void Effectors::alone_with(std::size_t output, const std::function<void()>& code) {
  for (Device& device : devices()) {
    if (output < device.its.first || output >= device.its.first + device.its.count) continue;
    const Lock lock(device, Busy::waits);
    return code();
  }
}

void Effectors::note_resistance(std::size_t index) { note_resistance(devices_[index]); }

void Effectors::note_resistance(Device& device) const {
  if (!device.resists.exchange(true)) control_.tell_supervisor();
}

bool Effectors::resists() const {
  return std::ranges::any_of(devices(), [](const Device& device) { return device.resists && device.owes; });
}

std::vector<std::string> Effectors::resisting() const {
  std::vector<std::string> names;
  for (const Device& device : devices())
    if (device.resists && device.owes) names.push_back(device.its.name);
  return names;
}

bool Effectors::owing() const {
  return std::ranges::any_of(devices(), [](const Device& device) { return device.owes.load(); });
}

std::vector<std::string> Effectors::unsafe() const {
  std::vector<std::string> names;
  for (const Device& device : devices())
    if (!device.safe || device.owes) names.push_back(device.its.name);
  return names;
}

std::vector<std::string> Effectors::not_stopped() {
  std::vector<std::string> names;
  for (Device& device : devices())
    if (!is_stopped(device)) names.push_back(device.its.name);
  return names;
}

/// A device that has the safe command for another reason may not get it again. That counts only if no thread
/// calls its driver: a command that was on its way when the stop began would be the later one.
bool Effectors::is_stopped(Device& device) const {
  if (device.stopped_in == control_.emergencies()) return true;
  const Lock lock(device, Busy::leaves_out);
  return lock && device.safe && !device.owes;
}

std::string not_safe(const std::vector<std::string>& names) {
  return names.size() == 1 ? fmt::format("{} has not taken its safe command", names.front())
                           : fmt::format("{} have not taken their safe commands", fmt::join(names, ", "));
}

// -------------------------------------------------------------------------------------------- recording

void Effectors::record(RecordingLane* lane) {
  if (lane == nullptr) return;
  for (Device& device : devices())
    if (const Lock lock(device, Busy::leaves_out); lock) record(device, *lane);
}

/// Call it with the device's lock.
void Effectors::record(Device& device, RecordingLane& lane) {
  std::array<char, 256> text, reason;
  const auto put = [&](SafeEvent what, auto format, const auto&... values) {
    const auto end = fmt::format_to_n(text.data(), text.size(), format, device.its.name, values...);
    lane.text(Event::Kind::safe, device.since, static_cast<std::uint32_t>(what),
              {text.data(), std::min(end.size, text.size())});
  };
  if (device.refused && !std::exchange(device.complained, true))
    put(SafeEvent::refused, FMT_STRING("{}: refuses its safe command"));
  if (device.standing == device.recorded) return;
  if (device.standing.kind == SafeReason::Kind::none)
    put(SafeEvent::ended, FMT_STRING("{}: commands go to it again"));
  else
    put(SafeEvent::given, FMT_STRING("{}: safe command: {}"), describe(device.standing, reason));
  device.recorded = device.standing;
}

std::string_view describe(const SafeReason& why, std::span<char> room) {
  const auto about_input = [&](auto format) {
    const auto end = fmt::format_to_n(room.data(), room.size(), format, why.input);
    return std::string_view(room.data(), std::min(end.size, room.size()));
  };
  switch (why.kind) {
    case SafeReason::Kind::starting:
      return about_input(FMT_STRING("no valid value has come to input '{}' yet"));
    case SafeReason::Kind::stale:
      return about_input(FMT_STRING("input '{}' is stale"));
    case SafeReason::Kind::source_stalls:
      return about_input(FMT_STRING("the source of input '{}' stalls"));
    case SafeReason::Kind::source_ended:
      return about_input(FMT_STRING("the source of input '{}' has ended"));
    case SafeReason::Kind::fault:
      return "a fault";
    case SafeReason::Kind::stalls:
      return "its transition function does not return";
    case SafeReason::Kind::stuck:
      return "it waits for ever";
    case SafeReason::Kind::emergency:
      return "emergency stop";
    case SafeReason::Kind::suspended:
      return "the run is suspended";
    case SafeReason::Kind::other:
      return "another device does not take its safe command";
    case SafeReason::Kind::leaves:
      return "the end";
    case SafeReason::Kind::none:
      break;
  }
  return "";
}

}  // namespace tessera
