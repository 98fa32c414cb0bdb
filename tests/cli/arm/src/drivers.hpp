#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tessera/device.hpp>

namespace reach {

/// How high a site of the simulated world is.
class Height final : public tessera::Receptor<double> {
 public:
  explicit Height(const tessera::DriverSetup& setup) : world_(setup.world()), site_(setup.text("site")) {
    static_cast<void>(world_->site(site_));  // throws if there is none
  }
  std::optional<double> read() override { return world_->site(site_).position_m[2]; }

 private:
  std::shared_ptr<tessera::WorldState> world_;
  std::string site_;
};

}  // namespace reach
