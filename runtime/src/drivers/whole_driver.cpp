#include "drivers/whole_driver.hpp"

#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

namespace tessera {
namespace {

/// The position of one buffer in the structure of all real buffers.
struct Part {
  void* at;
  std::size_t size;
  const ValueType* type;  // nullptr: bytes
};

void assign(void* to, const void* from, const Part& part) {
  if (part.type == nullptr)
    std::memcpy(to, from, part.size);
  else
    part.type->assign(to, from);
}

template <class Base>
struct Shared {
  std::unique_ptr<Base> driver;
  Bindings::Real all;
  std::optional<std::size_t> asked;  // number of the part that was asked last
  bool has_value = false;
};

class ReceptorPart final : public RealReceptor {
 public:
  ReceptorPart(std::shared_ptr<Shared<RealReceptor>> shared, Part part, std::size_t number)
      : shared_(std::move(shared)), part_(part), number_(number) {}

  /// The parts are read in order, though some may be left out. A part that is not after the
  /// last one begins a new reading.
  bool read(std::span<std::byte> value) override {
    const std::optional<std::size_t> last = std::exchange(shared_->asked, number_);
    if (!last || number_ <= *last) {
      shared_->has_value = false;  // in case it throws
      shared_->has_value =
          shared_->driver->read({static_cast<std::byte*>(shared_->all.value.get()), shared_->all.size});
    }
    if (!shared_->has_value) return false;
    assign(value.data(), part_.at, part_);
    return true;
  }

 private:
  std::shared_ptr<Shared<RealReceptor>> shared_;
  Part part_;
  std::size_t number_;
};

class EffectorPart final : public RealEffector {
 public:
  EffectorPart(std::shared_ptr<Shared<RealEffector>> shared, Part part, bool last)
      : shared_(std::move(shared)), part_(part), last_(last) {}

  bool write(std::span<const std::byte> value) override {
    assign(part_.at, value.data(), part_);
    if (!last_) return true;
    return shared_->driver->write(
        {static_cast<const std::byte*>(shared_->all.value.get()), shared_->all.size});
  }

 private:
  std::shared_ptr<Shared<RealEffector>> shared_;
  Part part_;
  bool last_;
};

template <class Base>
[[nodiscard]] std::shared_ptr<Shared<Base>> shared(std::unique_ptr<Base> driver, const Bindings& bindings) {
  auto made = std::make_shared<Shared<Base>>();
  made->driver = std::move(driver);
  made->all = bindings.real;
  return made;
}

}  // namespace

std::vector<std::unique_ptr<RealReceptor>> parts_of(std::unique_ptr<RealReceptor> driver,
                                                    const Bindings& bindings) {
  const auto all = shared(std::move(driver), bindings);
  std::vector<std::unique_ptr<RealReceptor>> parts;
  for (const Bindings::Incoming& buffer : bindings.real_inputs)
    parts.push_back(
        std::make_unique<ReceptorPart>(all, Part{buffer.part, buffer.size, buffer.type}, parts.size()));
  return parts;
}

std::vector<std::unique_ptr<RealEffector>> parts_of(std::unique_ptr<RealEffector> driver,
                                                    const Bindings& bindings) {
  const auto all = shared(std::move(driver), bindings);
  std::vector<std::unique_ptr<RealEffector>> parts;
  for (const Bindings::RealOutgoing& buffer : bindings.real_outputs)
    parts.push_back(std::make_unique<EffectorPart>(all, Part{buffer.part, buffer.size, buffer.type},
                                                   parts.size() + 1 == bindings.real_outputs.size()));
  return parts;
}

}  // namespace tessera
