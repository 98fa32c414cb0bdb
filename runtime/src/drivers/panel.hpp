#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "system/clock.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera {

/// The values that an operator gives one real buffer.
///
/// An input counts until it is as old as `stale`, in real time. Then the panel is *neutral*: every bool is
/// false, and every number is zero, or the number of its range that is next to zero. While the input of one
/// operator counts, the panel refuses every other operator.
///
/// Threads: `feed` any; `latest` the subsystem's.
class Panel {
 public:
  /// A number or a bool, and where it is in the encoded value.
  struct Control {
    std::string field;
    std::string type;  ///< "bool", "int8", "float64"
    std::size_t offset = 0;
    double minimum = 0, maximum = 0;
    std::string unit{};  ///< empty: none
  };
  /// An input of the script of a simulated run.
  struct Step {
    Time at;
    std::string field;
    command::Panel::Value value;
  };
  /// size: of the encoded value in bytes. script: in the order of its times; if there is one, it is the only
  /// operator: each of its inputs counts until the next one changes it.
  /// Throws DriverError if an input of the script does not fit.
  Panel(std::string path, std::vector<Control> controls, std::size_t size, Duration stale,
        std::vector<Step> script = {});

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] Duration stale() const { return stale_; }
  [[nodiscard]] const std::vector<std::byte>& neutral() const { return neutral_; }

  /// Returns the mistake in the input; nullopt: it counts from now on. now_ns: of monotonic_ns().
  [[nodiscard]] std::optional<Problem> feed(const command::Panel& input, std::int64_t now_ns);

  /// The values that count, or the neutral ones.
  [[nodiscard]] Offered::Panel offered(std::int64_t now_ns) const;

  struct Input {
    std::vector<std::byte> bytes;          ///< the encoded value
    std::optional<std::int64_t> given_ns;  ///< nullopt: no operator uses the panel
  };
  /// Copies the newest input. Never waits: while another thread feeds the panel, `input` stays as it is.
  void latest(Input& input);
  [[nodiscard]] bool counts(const Input& input, std::int64_t now_ns) const {
    return input.given_ns && (!script_.empty() || now_ns - *input.given_ns < stale_.count());
  }
  /// Gives the inputs of the script that are due. now: of the run's clock. Threads: the subsystem's.
  void play(Time now);

 private:
  [[nodiscard]] std::optional<Problem> put(const std::string& field, const command::Panel::Value& value,
                                           std::vector<std::byte>& bytes) const;
  const std::string path_;
  const std::vector<Control> controls_;
  const Duration stale_;
  const std::vector<Step> script_;
  std::size_t played_ = 0;  // steps of the script
  std::vector<std::byte> neutral_;
  mutable std::mutex mutex_;  // guards the members below
  Input input_;
  std::string who_;
};

/// The driver of a real buffer with a panel. It has no value before the first input. When the input expires,
/// it gives the neutral value once, and has no value after that.
class PanelReceptor final : public RealReceptor {
 public:
  using Now = std::int64_t (*)();
  PanelReceptor(std::shared_ptr<Panel> panel, const ValueEncoding* encoding, Now now);

  [[nodiscard]] const std::shared_ptr<Panel>& panel() const { return panel_; }
  /// The clock of the script. It must live longer. Without a clock, the script gives nothing.
  void follow(const Clock& clock) { clock_ = &clock; }
  [[nodiscard]] bool read(std::span<std::byte> value) override;

 private:
  std::shared_ptr<Panel> panel_;
  const ValueEncoding* encoding_;
  Now now_;
  const Clock* clock_ = nullptr;
  Panel::Input input_;
  bool operated_ = false;  // the last value was an operator's
};

/// The panels of a controller. Threads: any.
class Panels {
 public:
  /// Replaces the panel of the same real buffer, whose process begins again.
  void add(std::shared_ptr<Panel> panel);
  [[nodiscard]] std::vector<std::string> paths() const;
  [[nodiscard]] bool knows(const std::string& path) const;
  [[nodiscard]] std::vector<Offered::Panel> offered() const;
  /// As Panel::feed; also for a path that names no panel.
  [[nodiscard]] std::optional<Problem> feed(const command::Panel& input) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Panel>> panels_;
};

}  // namespace tessera
