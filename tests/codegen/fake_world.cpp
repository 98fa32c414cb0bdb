#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>

#include "tessera/device.hpp"

// A world that is black everywhere and does not move: generated controllers run in it without physics.
namespace {

class Black : public tessera::RealReceptor {
 public:
  bool read(std::span<std::byte> value) override {
    const double dark = 0;
    if (value.size() != sizeof dark) return false;
    std::memcpy(value.data(), &dark, sizeof dark);
    return true;
  }
};

class Still : public tessera::RealEffector {
 public:
  bool write(std::span<const std::byte>) override { return true; }
};

class FakeWorld : public tessera::World {
 public:
  std::unique_ptr<tessera::RealReceptor> receptor(const tessera::DriverRequest&, std::string&) override {
    return std::make_unique<Black>();
  }
  std::unique_ptr<tessera::RealEffector> effector(const tessera::DriverRequest&, std::string&) override {
    return std::make_unique<Still>();
  }
  void advance_to(tessera::Time) override {}
  bool finish(std::string&) override { return true; }
};

}  // namespace

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif
// NOLINTNEXTLINE(readability-identifier-naming): the name that the runtime looks up
extern "C" std::unique_ptr<tessera::World> tessera_open_world_4(const tessera::WorldOptions&, std::string&) {
  return std::make_unique<FakeWorld>();
}
