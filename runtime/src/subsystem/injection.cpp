#include "subsystem/injection.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tessera/given_values.hpp"
#include "tessera/nearest.hpp"
#include "tessera/signals.hpp"

namespace tessera {

bool Injection::happens(Time now) {
  if (now < from || now >= until || done_) return false;
  done_ = once;
  note_happened();
  return true;
}

bool Injection::has_happened() const { return std::atomic_ref<bool>(happened_).load(); }

void Injection::note_happened() { std::atomic_ref<bool>(happened_).store(true); }

void Injection::announce() {
  if (context != nullptr && !std::exchange(announced_, true)) context->warn("injected: {}", text);
}

// ------------------------------------------------------------------------------------------------ reading

namespace {

/// Reads one `--inject`. Its functions return false after they have stored the mistake.
class InjectionReader {
 public:
  InjectionReader(const System& system, std::uint64_t seed, std::optional<Duration> duration)
      : system_(system), seed_(seed), duration_(duration) {}

  [[nodiscard]] std::optional<Injection> read(const std::string& text) {
    return parse(text) ? std::optional(fault_) : std::nullopt;
  }
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  bool fail(std::string problem) {
    problem_ = std::move(problem);
    return false;
  }

  bool parse(const std::string& text) {
    fault_.text = text;
    const std::size_t at = text.rfind('@');
    const std::size_t colon = text.find(':');
    if (at == std::string::npos || colon == std::string::npos || colon > at)
      return fail("expected FAULT@WHEN, for example robot.control:throw@2.5s");
    const std::string front = text.substr(0, colon), back = text.substr(colon + 1, at - colon - 1);
    const bool known = front == "signal"                        ? signal(back)
                       : front == "link"                        ? link(back)
                       : front == "process"                     ? life(back)
                       : front == "device" || front == "silent" ? device(front, back)
                                                                : function(front, back);
    if (!known || !when(text.substr(at + 1))) return false;
    if (fault_.kind == Injection::Kind::link && !fault_.once)
      return fail("a cut begins at one time, for example link:base-cart:cut=2s@3s");
    if (fault_.kind == Injection::Kind::process && !fault_.once)
      return fail("a process dies at one time, for example process:cart:restart=2s@3s");
    return true;
  }

  bool signal(const std::string& name) {
    fault_.kind = Injection::Kind::signal;
    for (const HandledSignal& one : handled_signals)
      if (one.use == SignalUse::stop && one.name == name) fault_.signal = one.number;
    if (fault_.signal == 0)
      return fail("'" + name + "' is no signal that stops a run, such as SIGINT or SIGHUP");
    return true;
  }

  /// "base-cart[0]:cut=2s". Names of processes may contain a hyphen.
  bool link(const std::string& text) {
    fault_.kind = Injection::Kind::link;
    const std::size_t cut = text.rfind(":cut=");
    if (cut == std::string::npos) return fail("expected link:PROCESS-PROCESS:cut=TIME@WHEN");
    if (!read_time(text.substr(cut + 5), fault_.delay)) return false;
    const std::string pair = text.substr(0, cut);
    for (std::size_t at = pair.find('-'); at != std::string::npos; at = pair.find('-', at + 1)) {
      const auto one = process(pair.substr(0, at)), other = process(pair.substr(at + 1));
      if (!one || !other || one == other) continue;
      fault_.processes = {*one, *other};
      return are_linked(*one, *other) || fail("no channel joins " + pair + known_links());
    }
    return fail("'" + pair + "' names no two processes" + known_processes());
  }

  [[nodiscard]] bool are_linked(std::uint32_t one, std::uint32_t other) const {
    return std::ranges::any_of(system_.channels, [&](const Channel& channel) {
      const std::uint32_t from = system_.process_of[channel.from.instance],
                          to = system_.process_of[channel.to.instance];
      return (from == one && to == other) || (from == other && to == one);
    });
  }

  [[nodiscard]] std::string known_links() const {
    std::string known;
    for (std::uint32_t one = 0; one < system_.processes.size(); ++one)
      for (std::uint32_t other = one + 1; other < system_.processes.size(); ++other)
        if (are_linked(one, other))
          known += (known.empty() ? "; there are the links " : ", ") +
                   std::string(system_.processes[one].name) + "-" +
                   std::string(system_.processes[other].name);
    return known;
  }

  [[nodiscard]] std::string known_processes() const {
    std::string known;
    for (const Process& process : system_.processes)
      known += (known.empty() ? "; there are " : ", ") + std::string(process.name);
    return known;
  }

  /// "cart[0]:crash", "cart[0]:restart=2s"
  bool life(const std::string& text) {
    fault_.kind = Injection::Kind::process;
    const std::size_t colon = text.rfind(':');
    const std::string name = text.substr(0, colon);
    const std::string what = colon == std::string::npos ? "" : text.substr(colon + 1);
    constexpr std::string_view restart = "restart=";
    if (what == "crash")
      fault_.delay = Duration::max();
    else if (!what.starts_with(restart))
      return fail("expected process:PROCESS:crash@WHEN or process:PROCESS:restart=TIME@WHEN");
    else if (!read_time(what.substr(restart.size()), fault_.delay))
      return false;
    const auto found = process(name);
    if (!found) return fail("'" + name + "' is no process" + known_processes());
    fault_.processes = {*found, *found};
    return true;
  }

  [[nodiscard]] std::optional<std::uint32_t> process(std::string_view name) const {
    const auto found = std::ranges::find(system_.processes, name, &Process::name);
    if (found == system_.processes.end()) return std::nullopt;
    return static_cast<std::uint32_t>(found - system_.processes.begin());
  }

  bool device(const std::string& kind, const std::string& path) {
    fault_.kind = kind == "device" ? Injection::Kind::device : Injection::Kind::silence;
    return find(path, [&](const Instance& instance) {
      std::vector<std::string> names;
      Bindings bindings;
      instance.make()->bind(bindings);
      for (const Bindings::Incoming& input : bindings.real_inputs) names.emplace_back(input.name);
      if (fault_.kind == Injection::Kind::device)
        for (const Bindings::RealOutgoing& output : bindings.real_outputs) names.emplace_back(output.name);
      return names;
    });
  }

  bool function(const std::string& path, const std::string& what) {
    const std::size_t equals = what.find('=');
    const std::string name = what.substr(0, equals);
    const std::vector<std::string> known{"throw", "stall", "nan", "inf"};
    if (std::find(known.begin(), known.end(), name) == known.end())
      return fail(with_hint("unknown fault '" + name +
                                "'; there are throw, stall=TIME, nan, inf, and the prefixes "
                                "device:, silent:, signal:, link:, process:",
                            did_you_mean(name, known)));
    if ((name == "stall") != (equals != std::string::npos))
      return fail(name == "stall" ? "stall needs a time, for example stall=200ms"
                                  : "'" + name + "' takes no value");
    fault_.kind = name == "throw"   ? Injection::Kind::exception
                  : name == "stall" ? Injection::Kind::stall
                                    : Injection::Kind::number;
    fault_.number =
        name == "inf" ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    if (name == "stall" && !read_time(what.substr(equals + 1), fault_.delay)) return false;
    return find(path, [](const Instance& instance) {
      std::vector<std::string> names;
      for (const Behaviour& behaviour : instance.net->behaviours) names.emplace_back(behaviour.name);
      return names;
    });
  }

  /// The subsystem at `path`, or the part of one that parts_of names.
  template <class PartsOf>
  bool find(const std::string& path, PartsOf parts_of) {
    std::vector<std::string> known;
    for (std::uint32_t index = 0; index < system_.instances.size(); ++index) {
      const Instance& instance = system_.instances[index];
      const std::string its = fmt::format("{}.{}", instance.agent, instance.name);
      known.push_back(its);
      fault_.instance = index;
      const std::vector<std::string> parts = parts_of(instance);
      if (path == its) {
        if (parts.empty()) return fail("'" + path + "' has no such device");
        return true;
      }
      for (const std::string& part : parts) {
        fault_.part = part;
        known.push_back(fmt::format("{}.{}", its, part));
        if (path == known.back()) return true;
      }
      fault_.part.clear();
    }
    return fail(with_hint("unknown '" + path + "'", did_you_mean(path, known)));
  }

  bool when(const std::string& text) {
    const std::size_t dots = text.find("..");
    if (text == "any") {
      if (!duration_) return fail("'any' needs a run with a duration");
      std::uint64_t mixed = seed_;  // several in one run get different times
      for (const char letter : fault_.text)
        mixed = (mixed ^ static_cast<unsigned char>(letter)) * 1099511628211U;
      std::mt19937_64 random(mixed);
      fault_.from = Time(Duration(
          static_cast<Duration::rep>(random() % static_cast<std::uint64_t>(duration_->count() + 1))));
      return true;
    }
    if (!read_time(text.substr(0, dots), fault_.from)) return false;
    if (dots == std::string::npos) return true;
    fault_.once = false;
    const std::string end = text.substr(dots + 2);
    if (!end.empty() && !read_time(end, fault_.until)) return false;
    if (fault_.until <= fault_.from) return fail("'" + text + "' ends before it begins");
    return true;
  }

  /// into: a duration or a time.
  template <class Into>
  bool read_time(const std::string& text, Into& into) {
    const std::optional<Duration> read = parse_duration(text);
    if (!read) return fail("'" + text + "' is no time such as 2.5s or 200ms");
    into = Into(*read);
    return true;
  }

  const System& system_;
  std::uint64_t seed_;
  std::optional<Duration> duration_;
  Injection fault_;
  std::string problem_;
};

}  // namespace

std::optional<Injection> read_injection(const std::string& text, const System& system, std::uint64_t seed,
                                        std::optional<Duration> duration, std::string& error) {
  InjectionReader reader(system, seed, duration);
  std::optional<Injection> read = reader.read(text);
  if (!read) error = fmt::format("--inject {}: {}", text, reader.problem());
  return read;
}

// ------------------------------------------------------------------------------------------------ planting

FaultySubsystem::FaultySubsystem(std::unique_ptr<Subsystem> inner, const SubsystemNet& net, Injections faults,
                                 const Clock& clock)
    : inner_(std::move(inner)), net_(net), faults_(std::move(faults)), clock_(clock) {}

void FaultySubsystem::bind(Bindings& bindings) {
  inner_->bind(bindings);
  outputs_ = bindings.outputs;
  outputs_.insert(outputs_.end(), bindings.real_outputs.begin(), bindings.real_outputs.end());
}

void FaultySubsystem::call(std::uint16_t behaviour) {
  std::vector<Injection*> now;
  for (const std::shared_ptr<Injection>& fault : faults_)
    if ((fault->part.empty() || fault->part == net_.behaviours[behaviour].name) &&
        fault->happens(clock_.now()))
      now.push_back(fault.get());
  for (const Injection* fault : now) context().warn("injected: {}", fault->text);
  for (const Injection* fault : now)
    if (fault->kind == Injection::Kind::exception) throw std::runtime_error("injected");
  inner_->call(behaviour);
  for (Injection* fault : now) apply(*fault);
}

void FaultySubsystem::apply(Injection& fault) {
  if (fault.kind == Injection::Kind::stall) {
    if (clock_.simulated())
      delay_ += fault.delay;
    else
      std::this_thread::sleep_for(fault.delay);
  }
  if (fault.kind == Injection::Kind::number)
    for (const Bindings::Outgoing& output : outputs_)
      if (output.fill != nullptr) output.fill(output.value, fault.number);
}

InjectedSignals::InjectedSignals(const Injections& faults) {
  for (const std::shared_ptr<Injection>& fault : faults)
    if (fault->kind == Injection::Kind::signal) left_.push_back(fault);
  std::sort(left_.begin(), left_.end(), [](const auto& a, const auto& b) { return a->from > b->from; });
}

void InjectedSignals::raise_due(Time now) {
  for (; next() <= now; left_.pop_back()) {
    left_.back()->note_happened();
    raise(left_.back()->signal);
  }
}

namespace {

/// The fault that happens now, or nullptr.
[[nodiscard]] Injection* happening(Injections& faults, Time now) {
  const auto found =
      std::find_if(faults.begin(), faults.end(), [&](const auto& one) { return one->happens(now); });
  return found == faults.end() ? nullptr : found->get();
}

class FaultyReceptor final : public RealReceptor {
 public:
  FaultyReceptor(std::unique_ptr<RealReceptor> inner, Injections faults, const Clock& clock)
      : inner_(std::move(inner)), faults_(std::move(faults)), clock_(clock) {}
  bool read(std::span<std::byte> value) override {
    Injection* const fault = happening(faults_, clock_.now());
    if (fault == nullptr) return inner_->read(value);
    fault->announce();
    if (fault->kind == Injection::Kind::silence) return false;
    throw std::runtime_error("injected: " + fault->text);
  }

 private:
  std::unique_ptr<RealReceptor> inner_;
  Injections faults_;
  const Clock& clock_;
};

/// Refuses commands.
class FaultyEffector final : public RealEffector {
 public:
  FaultyEffector(std::unique_ptr<RealEffector> inner, Injections faults, const Clock& clock, const void* safe)
      : inner_(std::move(inner)), faults_(std::move(faults)), clock_(clock), safe_(safe) {}
  bool write(std::span<const std::byte> value) override {
    const bool is_safe = value.data() == safe_;
    Injection* const fault = is_safe ? nullptr : happening(faults_, clock_.now());
    if (fault == nullptr) return inner_->write(value);
    fault->announce();
    return false;
  }

 private:
  std::unique_ptr<RealEffector> inner_;
  Injections faults_;
  const Clock& clock_;
  const void* safe_;
};

}  // namespace

std::unique_ptr<RealReceptor> with_faults(std::unique_ptr<RealReceptor> device, Injections faults,
                                          const Clock& clock) {
  if (device == nullptr || faults.empty()) return device;
  return std::make_unique<FaultyReceptor>(std::move(device), std::move(faults), clock);
}

std::unique_ptr<RealEffector> with_faults(std::unique_ptr<RealEffector> device, Injections faults,
                                          const Clock& clock, const void* safe) {
  if (device == nullptr || faults.empty()) return device;
  return std::make_unique<FaultyEffector>(std::move(device), std::move(faults), clock, safe);
}

}  // namespace tessera
