#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "drivers/substitutes.hpp"
#include "tessera/testing.hpp"

namespace tessera {

/// The parts that a test puts into a run.
class TestedParts final : public Substitutes {
 public:
  explicit TestedParts(SystemUnderTest& test) : test_(test) {}

  std::unique_ptr<Subsystem> subsystem(std::uint32_t instance, std::unique_ptr<Subsystem> own,
                                       bool& scripted) override {
    scripted = test_.instead_[instance] != nullptr;
    return std::make_unique<Watched>(test_, instance, std::move(own));
  }
  std::unique_ptr<RealReceptor> receptor(const std::string& path) override {
    const auto found = test_.sensed_.find(path);
    return std::make_unique<Sensed>(found == test_.sensed_.end() ? nullptr : found->second);
  }
  std::unique_ptr<RealEffector> effector(const std::string&) override { return std::make_unique<Taken>(); }

 private:
  /// Calls the script of the test, or the user's function; then the observer of the test.
  class Watched final : public Subsystem {
   public:
    Watched(SystemUnderTest& test, std::uint32_t instance, std::unique_ptr<Subsystem> own)
        : test_(test), instance_(instance), own_(std::move(own)) {}

    void bind(Bindings& bindings) override { own_->bind(bindings); }
    void call(std::uint16_t behaviour) override {
      const std::string_view name = test_.system_.instances[instance_].net->behaviours[behaviour].name;
      std::vector<std::string>& behaviours = test_.behaviours_[instance_];
      if (behaviours.empty() || behaviours.back() != name) behaviours.emplace_back(name);
      if (const auto& instead = test_.instead_[instance_]; instead)
        instead(*own_);
      else
        own_->call(behaviour);
      if (const auto& after = test_.after_[instance_]; after) after(*own_);
    }
    Outcome decide(std::uint16_t behaviour, bool failed) override { return own_->decide(behaviour, failed); }
    int route(std::uint16_t behaviour, bool failed) override { return own_->route(behaviour, failed); }
    void keep_outputs() override { own_->keep_outputs(); }
    void restore_outputs() override { own_->restore_outputs(); }
    Context& context() override { return own_->context(); }

   private:
    SystemUnderTest& test_;
    std::uint32_t instance_;
    std::unique_ptr<Subsystem> own_;
  };

  class Sensed final : public RealReceptor {
   public:
    explicit Sensed(std::function<bool(std::span<std::byte>)> value) : value_(std::move(value)) {}
    bool read(std::span<std::byte> value) override { return value_ && value_(value); }

   private:
    std::function<bool(std::span<std::byte>)> value_;
  };

  class Taken final : public RealEffector {
   public:
    bool write(std::span<const std::byte>) override { return true; }
  };

  SystemUnderTest& test_;
};

SystemUnderTest::SystemUnderTest(const System& system)
    : system_(system),
      instead_(system.instances.size()),
      after_(system.instances.size()),
      behaviours_(system.instances.size()) {}

SystemUnderTest::~SystemUnderTest() = default;

std::size_t SystemUnderTest::instance_of(std::string_view path) const {
  for (std::size_t index = 0; index < system_.instances.size(); ++index)
    if (fmt::format("{}.{}", system_.instances[index].agent, system_.instances[index].name) == path)
      return index;
  throw std::invalid_argument(fmt::format("{} has no subsystem {}", system_.name, path));
}

void SystemUnderTest::place(Maker maker, std::string_view path, Moment moment, const Function& function) {
  std::vector<Function>& functions = moment == Moment::instead ? instead_ : after_;
  const auto put = [&](std::size_t index) { functions[index] = function; };
  if (!path.empty()) {
    const std::size_t index = instance_of(path);
    if (system_.instances[index].make != maker)
      throw std::invalid_argument(fmt::format("{} is a subsystem of another kind than this Context", path));
    put(index);
    return;
  }
  for (std::size_t index = 0; index < system_.instances.size(); ++index)
    if (system_.instances[index].make == maker) put(index);
}

void SystemUnderTest::check_real_buffer(const std::string& path, std::size_t bytes) const {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) throw std::invalid_argument(path + " is no real buffer");
  Bindings bindings;
  const auto subsystem = system_.instances[instance_of(path.substr(0, dot))].make();
  subsystem->bind(bindings);
  for (const Bindings::Incoming& input : bindings.real_inputs) {
    if (input.name != path.substr(dot + 1)) continue;
    if (input.size != bytes)
      throw std::invalid_argument(fmt::format("the values for {} are of another type", path));
    return;
  }
  throw std::invalid_argument(path + " is no real buffer of a receptor");
}

RunSummary SystemUnderTest::run(Duration duration) {
  for (std::vector<std::string>& behaviours : behaviours_) behaviours.clear();
  TestedParts parts(*this);
  RunOptions how = options;
  how.clock = RunOptions::Clock::simulated;
  how.duration = duration;
  how.substitutes = &parts;
  // `tessera test --coverage` reads the firings of the net.
  static int number = 0;
  const char* const folder = std::getenv("TESSERA_TEST_RECORDINGS");
  if (how.recording.empty() && folder != nullptr)
    how.recording = fmt::format("{}/{}-{}.tsr", folder, getpid(), ++number);
  std::string error;
  std::optional<RunSummary> summary = execute(system_, how, error);
  if (!summary) throw std::runtime_error(error);
  return *std::move(summary);
}

const std::vector<std::string>& SystemUnderTest::behaviours(std::string_view path) const {
  return behaviours_[instance_of(path)];
}

}  // namespace tessera
