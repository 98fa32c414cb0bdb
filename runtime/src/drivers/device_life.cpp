#include "drivers/device_life.hpp"

#include <cxxabi.h>
#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "drivers/driver_watch.hpp"

namespace tessera {
namespace {

/// nullopt: the code has returned true. Otherwise ": " and what it threw, or nothing: it returned false.
template <class Code>
[[nodiscard]] std::optional<Problem> problem_of(DriverWatch::Step step, const DriverInUse& driver,
                                                Code code) {
  try {
    const DriverWatch::Call call(step, driver.path);
    if (code()) return std::nullopt;
    return Problem{""};
  } catch (const abi::__forced_unwind&) {
    throw;
  } catch (const std::exception& exception) {
    return Problem{fmt::format(": {}", exception.what())};
  } catch (...) {
    return Problem{": it threw an exception that is no std::exception"};
  }
}

}  // namespace

DeviceLife::DeviceLife(std::vector<DriverInUse> drivers) : drivers_(std::move(drivers)) {
  for (const DriverInUse& driver : drivers_)
    if (const Duration period = driver.device->heartbeat_period(); period > Duration::zero())
      beating_.push_back({&driver, period});
}

bool DeviceLife::open(const std::function<bool(const DriverInUse&)>& secure, std::string& error) {
  for (; open_ < drivers_.size(); ++open_) {
    const DriverInUse& driver = drivers_[open_];
    if (const auto why = problem_of(DriverWatch::Step::open, driver, [&] { return driver.device->open(); })) {
      error = fmt::format("the device of {} cannot be opened{}", driver.path,
                          why->text.empty() ? ": it refuses" : why->text);
      return false;
    }
    const auto why = problem_of(DriverWatch::Step::safe_command, driver, [&] { return secure(driver); });
    if (!why) continue;
    ++open_;
    error = fmt::format("the device of {} is open and refuses its safe command{}", driver.path, why->text);
    return false;
  }
  return true;
}

std::vector<std::string> DeviceLife::close() {
  std::vector<std::string> wrong;
  while (open_ > 0) {
    const DriverInUse& driver = drivers_[--open_];
    try {
      const DriverWatch::Call call(DriverWatch::Step::close, driver.path);
      driver.device->close();
    } catch (const std::exception& exception) {
      wrong.push_back(fmt::format("closing the device of {}: {}", driver.path, exception.what()));
    } catch (...) {
      wrong.push_back(
          fmt::format("closing the device of {}: an exception that is no std::exception", driver.path));
    }
  }
  return wrong;
}

std::vector<std::string> DeviceLife::with_heartbeat() const {
  std::vector<std::string> paths;
  for (const Beating& one : beating_) paths.push_back(one.driver->path);
  return paths;
}

Time DeviceLife::next_beat() const {
  Time next = Time::max();
  for (const Beating& one : beating_) next = std::min(next, one.next);
  return next;
}

void DeviceLife::beat(Time now, const Around& around) {
  for (Beating& one : beating_) {
    if (now < one.next) continue;
    one.next = now + one.period;
    around(*one.driver, [&] { one.driver->device->heartbeat(); });
  }
}

}  // namespace tessera
