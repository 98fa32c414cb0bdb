#include "assembly/open_devices.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <future>
#include <iterator>
#include <memory>
#include <thread>

#include "system/stop_signals.hpp"

namespace tessera {
namespace {

/// Returns the failures. left_behind: per instance, whether its devices stay open; empty: none.
std::vector<std::string> close_devices(Assembly& assembly, const std::vector<bool>& left_behind) {
  std::vector<std::string> wrong;
  for (const bool effectors : {false, true})
    for (std::size_t index = assembly.executors.size(); index-- > 0;) {
      SubsystemExecutor& executor = *assembly.executors[index];
      if (executor.effectors().none() == effectors || (!left_behind.empty() && left_behind[index])) continue;
      std::ranges::move(executor.operations().devices().close(), std::back_inserter(wrong));
    }
  return wrong;
}

}  // namespace

OpenDevices::~OpenDevices() {
  if (!open_) return;
  // Before that, a device is not open, or has got nothing but its safe command.
  if (all_open_)
    for (const auto& executor : assembly_.executors) executor->leave();
  close();
}

bool OpenDevices::open(std::string& error) {
  open_ = true;
  for (const bool effectors : {true, false})
    for (const auto& executor : assembly_.executors) {
      Operations& operations = executor->operations();
      if (operations.devices().none() == effectors) continue;
      if (StopSignals::pending() == 0 && operations.devices().open(error)) continue;
      if (error.empty())
        error = fmt::format("{} while devices were opened", StopSignals::name(StopSignals::pending()));
      close();
      return false;
    }
  all_open_ = true;
  return true;
}

std::vector<std::string> OpenDevices::close() {
  open_ = false;
  return close_devices(assembly_, {});
}

void OpenDevices::close_what_can_be_closed(const std::vector<bool>& left_behind) {
  open_ = false;
  const auto closed = std::make_shared<std::promise<void>>();
  std::thread([&assembly = assembly_, left_behind, closed] {
    static_cast<void>(close_devices(assembly, left_behind));
    closed->set_value();
  }).detach();
  closed->get_future().wait_for(closing_patience);
}

}  // namespace tessera
