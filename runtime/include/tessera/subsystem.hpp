#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "tessera/bound_goal.hpp"
#include "tessera/buffer.hpp"
#include "tessera/context.hpp"
#include "tessera/kept.hpp"
#include "tessera/scalar.hpp"
#include "tessera/value_encoding.hpp"
#include "tessera/write_trace.hpp"

namespace tessera {

/// Whether a T contains a floating-point number, as far as its type tells.
template <class T>
[[nodiscard]] constexpr bool has_floats() {
  if constexpr (std::is_floating_point_v<T>) {
    return true;
  } else if constexpr (Sequence<T>) {
    return has_floats<std::remove_cvref_t<decltype(*std::declval<T&>().begin())>>();
  } else if constexpr (WithFields<T>) {
    return []<class... Members>(std::type_identity<std::tuple<Members T::*...>>) {
      return (has_floats<Members>() || ...);
    }(std::type_identity<decltype(tessera_fields_of(std::declval<const T&>()))>{});
  } else {
    return false;
  }
}

/// Whether no number in `value` is infinite or NaN.
template <class T>
[[nodiscard]] bool all_finite(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
  } else if constexpr (!has_floats<T>()) {
    return true;
  } else if constexpr (Sequence<T>) {
    return std::all_of(value.begin(), value.end(), [](const auto& element) { return all_finite(element); });
  } else {
    return std::apply([&](auto... member) { return (all_finite(value.*member) && ...); },
                      tessera_fields_of(value));
  }
}

/// Stores `number` in every floating-point number of `value`, to plant a fault.
template <class T>
void fill_floats(T& value, double number) {
  if constexpr (std::is_floating_point_v<T>) {
    value = static_cast<T>(number);
  } else if constexpr (!has_floats<T>()) {
    return;
  } else if constexpr (Sequence<T>) {
    for (auto& element : value) fill_floats(element, number);
  } else {
    std::apply([&](auto... member) { (fill_floats(value.*member, number), ...); }, tessera_fields_of(value));
  }
}

/// How an iteration ended: which of the transitions t4, t5, t6 of the behaviour is to fire.
enum class Outcome : std::uint8_t { go_on, terminal, error };

/// Whether an iteration sends an output.
enum class Sending : std::uint8_t {
  sends,
  skips,
  by_function  ///< it is sent unless the transition function has skipped it, or has never written it
};

/// nullopt: `T` is neither a number nor a bool.
template <class T>
[[nodiscard]] constexpr std::optional<Scalar> scalar_of() {
  if constexpr (std::is_same_v<T, bool>) return Scalar::boolean;
  if constexpr (std::is_same_v<T, std::int8_t>) return Scalar::int8;
  if constexpr (std::is_same_v<T, std::int16_t>) return Scalar::int16;
  if constexpr (std::is_same_v<T, std::int32_t>) return Scalar::int32;
  if constexpr (std::is_same_v<T, std::int64_t>) return Scalar::int64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return Scalar::uint8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return Scalar::uint16;
  if constexpr (std::is_same_v<T, std::uint32_t>) return Scalar::uint32;
  if constexpr (std::is_same_v<T, std::uint64_t>) return Scalar::uint64;
  if constexpr (std::is_same_v<T, float>) return Scalar::float32;
  if constexpr (std::is_same_v<T, double>) return Scalar::float64;
  return std::nullopt;
}

/// How to store values of a type that is not trivially copyable, such as a LargeArray.
struct ValueType {
  void (*construct)(void* where);
  void (*assign)(void* to, const void* from);
  void (*destroy)(void* where);
};
/// nullptr: the bytes are the value.
template <class T>
[[nodiscard]] const ValueType* value_type_of() {
  if constexpr (std::is_trivially_copyable_v<T>) {
    return nullptr;
  } else {
    static constexpr ValueType type{
        [](void* where) { ::new (where) T(); },
        [](void* to, const void* from) { *static_cast<T*>(to) = *static_cast<const T*>(from); },
        [](void* where) { static_cast<T*>(where)->~T(); }};
    return &type;
  }
}

/// The addresses of a subsystem's buffers, memory and parameters. Subsystem::bind fills it, the executor uses it.
struct Bindings {
  struct Incoming {
    std::string_view name;
    void* value;
    std::size_t size;
    Arrival* arrival;
    const ValueType* type;                    ///< nullptr: bytes
    const ValueEncoding* encoding = nullptr;  ///< nullptr: cannot be recorded
    void* part = nullptr;                     ///< for a real buffer: its member of `real`, or nullptr
  };
  struct Outgoing {
    std::string_view name;
    void* value;
    std::size_t size;
    Departure* departure;
    const ValueType* type;                               ///< nullptr: bytes
    bool (*finite)(const void* value) = nullptr;         ///< nullptr: always
    void (*fill)(void* value, double number) = nullptr;  ///< fill_floats; nullptr: there are none
    const ValueEncoding* encoding = nullptr;             ///< nullptr: cannot be recorded
    const WriteTrace* trace = nullptr;                   ///< of its type
    bool* skipped = nullptr;  ///< whether the transition function has skipped it; nullptr: it cannot
  };
  struct RealOutgoing : Outgoing {
    std::shared_ptr<const void> safe;  ///< the safe command, of the same type
    void* part = nullptr;              ///< its member of `real`, or nullptr
  };
  /// The limits that commands must keep.
  struct Limits {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    double minimum = -infinity, maximum = infinity;
    double per_second = infinity;  ///< the largest change of a command within a second
    bool fault = false;  ///< a command beyond the limit is a fault; otherwise the limit is sent in its place
  };
  /// Limits of a number in a real output, or of each element of an array in it.
  struct RealLimit {
    std::string_view name;   ///< "left", "pose.x"
    std::size_t output = 0;  ///< into real_outputs
    std::size_t offset = 0;  ///< in the value, and in the safe command
    std::size_t elements = 1;
    bool whole = false;  ///< integers
    double (*get)(const void* at, std::size_t element);
    void (*set)(void* at, std::size_t element, double number);  ///< for integers: a whole number
    Limits limits;
  };
  /// The structure of all real buffers, for a driver that serves all of them at once.
  struct Real {
    std::shared_ptr<void> value;  ///< nullptr: there is no such driver
    std::size_t size = 0;
  };
  struct Parameter {
    std::string_view name;
    std::optional<Scalar>
        scalar;  ///< of a number, a bool, or the elements of an array; nullopt: anything else
    void* value;
    std::size_t size;
    double minimum, maximum;   ///< of each element
    std::size_t capacity = 0;  ///< of a string; otherwise 0
    std::size_t elements = 0;  ///< number of elements if it is an array of `scalar`; otherwise 0
    std::string_view unit{};   ///< of a number, as declared; empty: none
  };
  /// The demands on a given value of a parameter.
  struct Accepted {
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
    std::string_view unit{};
  };
  /// A field of the memory, for display.
  struct Remembered {
    std::string_view name;
    const void* value;
    const ValueEncoding* encoding;  ///< nullptr: cannot be shown
  };
  /// A field of the memory that the net changes.
  struct KeptCell {
    std::string_view name;
    void* value;
    /// position: among the values in the order of the specification.
    void (*set)(void* value, std::uint32_t position);
  };
  std::vector<Incoming> inputs, real_inputs;
  std::vector<Outgoing> outputs;
  std::vector<RealOutgoing> real_outputs;
  std::vector<RealLimit> limits;
  std::vector<Remembered> memory;
  std::vector<KeptCell> kept;
  std::vector<BoundGoal> goals;
  std::vector<Parameter> parameters;
  Real real;

  /// Makes `real`. Its members are the parts of the real buffers.
  template <class T>
  [[nodiscard]] T& all_real() {
    auto made = std::make_shared<T>();
    T& value = *made;
    real = {std::move(made), sizeof(T)};
    return value;
  }
  template <class T>
  void input(std::string_view name, Input<T>& buffer) {
    inputs.push_back(incoming(name, buffer));
  }
  /// One for each member of a fleet: "request[0]", "request[1]" ...
  template <class T, std::size_t Count>
  void each_input(std::string_view name, std::array<Input<T>, Count>& buffers) {
    for (std::size_t member = 0; member < Count; ++member) input(name_of(name, member), buffers[member]);
  }
  template <class T>
  void real_input(std::string_view name, Input<T>& buffer, T* part = nullptr) {
    real_inputs.push_back(incoming(name, buffer));
    real_inputs.back().part = part;
  }
  template <class T>
  void output(std::string_view name, Output<T>& buffer) {
    outputs.push_back(outgoing(name, buffer));
  }
  template <class T, class Status, std::size_t Count>
  void each_output(std::string_view name, std::array<Buffer<T, Status>, Count>& buffers) {
    for (std::size_t member = 0; member < Count; ++member) output(name_of(name, member), buffers[member]);
  }
  template <class T>
  void output(std::string_view name, SkippableOutput<T>& buffer) {
    outputs.push_back(outgoing(name, buffer));
    outputs.back().skipped = &buffer.tessera_skipped;
  }
  template <class T>
  void real_output(std::string_view name, Output<T>& buffer, const T& safe, T* part = nullptr) {
    real_outputs.push_back({outgoing(name, buffer), std::make_shared<const T>(safe), part});
  }
  /// Selects the numbers that must be finite in the real output that was bound last. Without this call, all of
  /// them must be. check: a lambda without captures that says whether those numbers of a value are finite.
  template <class T, class Check>
  void only_finite(const Output<T>& /*output*/, Check /*check*/) {
    real_outputs.back().finite = [](const void* at) { return Check{}(*static_cast<const T*>(at)); };
  }
  /// number: a member of the real output that was bound last: an arithmetic type, or a std::array of one.
  template <class T>
  void limit(std::string_view name, T& number, const Limits& its) {
    const auto offset = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&number) -
                                                 static_cast<const std::byte*>(real_outputs.back().value));
    RealLimit made{.name = name,
                   .output = real_outputs.size() - 1,
                   .offset = offset,
                   .get = nullptr,
                   .set = nullptr,
                   .limits = its};
    made.whole = !has_floats<T>();
    if constexpr (std::is_arithmetic_v<T>) {
      made.get = [](const void* at, std::size_t) { return static_cast<double>(*static_cast<const T*>(at)); };
      made.set = [](void* at, std::size_t, double value) { *static_cast<T*>(at) = static_cast<T>(value); };
    } else {
      using Element = typename T::value_type;
      static_assert(std::is_arithmetic_v<Element> && std::is_trivially_copyable_v<T>);
      made.elements = number.size();
      made.get = [](const void* at, std::size_t element) {
        return static_cast<double>((*static_cast<const T*>(at))[element]);
      };
      made.set = [](void* at, std::size_t element, double value) {
        (*static_cast<T*>(at))[element] = static_cast<Element>(value);
      };
    }
    limits.push_back(made);
  }
  template <class T>
  void remember(std::string_view name, const T& value) {
    memory.push_back({name, &value, value_encoding_of<T>()});
  }
  /// A Kept or a Counter.
  template <class T>
  void keep(std::string_view name, T& cell) {
    if constexpr (std::is_convertible_v<const T&, int>)
      memory.push_back({name, &cell.value_, value_encoding_of<int>()});
    else
      memory.push_back({name, &cell, encoding_of_name<T>()});
    kept.push_back(
        {name, &cell, [](void* value, std::uint32_t position) { static_cast<T*>(value)->set(position); }});
  }
  template <class T>
  void parameter(std::string_view name, T& value) {
    parameter(name, value, Accepted{});
  }
  template <class T>
  void parameter(std::string_view name, T& value, const Accepted& accepted) {
    static_assert(std::is_trivially_copyable_v<T>);
    Parameter made{name, std::nullopt, &value, sizeof(T), accepted.minimum, accepted.maximum, 0,
                   0,    accepted.unit};
    if constexpr (requires { T::capacity(); }) {
      made.capacity = T::capacity();
    } else if constexpr (requires { std::tuple_size<T>::value; }) {
      made.scalar = scalar_of<typename T::value_type>();
      made.elements = std::tuple_size_v<T>;
    } else {
      made.scalar = scalar_of<T>();
    }
    parameters.push_back(made);
  }

 private:
  std::vector<std::shared_ptr<const std::string>> names_;  // of the buffers of members

  std::string_view name_of(std::string_view family, std::size_t member) {
    names_.push_back(
        std::make_shared<const std::string>(std::string(family) + '[' + std::to_string(member) + ']'));
    return *names_.back();
  }
  template <class T>
  static Incoming incoming(std::string_view name, Input<T>& buffer) {
    return {name, &payload(buffer), sizeof(T), &buffer, value_type_of<T>(), value_encoding_of<T>()};
  }
  /// Only written: nobody reads the memory of a recording back.
  template <class T>
  static const ValueEncoding* encoding_of_name() {
    static constexpr ValueEncoding encoding{
        [] { return encoding::type_text<T>(); }, encoding::most<T>(),
        [](const void* value, ValueSink& to) { encoding::put(*static_cast<const T*>(value), to); },
        [](void*, std::span<const std::byte>) { return false; }};
    return &encoding;
  }
  template <class T, class Status>
  static Outgoing outgoing(std::string_view name, Buffer<T, Status>& buffer) {
    Outgoing made{name, &payload(buffer), sizeof(T), &buffer, value_type_of<T>()};
    made.encoding = value_encoding_of<T>();
    made.trace = write_trace_of<T>();
    if constexpr (has_floats<T>()) {
      made.finite = [](const void* at) { return all_finite(*static_cast<const T*>(at)); };
      made.fill = [](void* at, double number) { fill_floats(*static_cast<T*>(at), number); };
    }
    return made;
  }
};

/// One subsystem as its executor sees it: user functions and conditions by number, data by bindings.
/// Generated code derives from SubsystemOf.
///
/// Threads: one at a time (the subsystem's thread).
class Subsystem {
 public:
  virtual ~Subsystem() = default;
  virtual void bind(Bindings& bindings) = 0;
  /// Calls the transition function of a behaviour, eq. (1) of the paper. Throws what the user's code throws.
  virtual void call(std::uint16_t behaviour) = 0;
  /// Evaluates the error condition, then the terminal condition. failed: the transition function has thrown.
  [[nodiscard]] virtual Outcome decide(std::uint16_t behaviour, bool failed) = 0;
  /// The first entry of `next` whose condition holds, counted from 0; -1: none. failed: the behaviour ended
  /// by error.
  [[nodiscard]] virtual int route(std::uint16_t behaviour, bool failed) = 0;
  /// Whether an iteration of a behaviour sends an output (a number among those bound).
  [[nodiscard]] virtual Sending sends(std::uint16_t /*behaviour*/, std::uint32_t /*output*/) {
    return Sending::sends;
  }
  virtual void keep_outputs() = 0;     ///< remembers the outputs as sent
  virtual void restore_outputs() = 0;  ///< restores the sent outputs after a failed iteration
  [[nodiscard]] virtual Context& context() = 0;
};

template <class Context>
struct SubsystemData;

/// The typed part: the data that the user's transition functions are given.
template <class InputsT, class MemoryT, class OutputsT, class ParametersT, class ContextT>
class SubsystemOf : public Subsystem {
 public:
  void keep_outputs() final { kept_ = out; }
  void restore_outputs() final { out = kept_; }
  [[nodiscard]] Context& context() final { return context_; }

 protected:
  InputsT in{};
  MemoryT memory{};
  OutputsT out{};
  ParametersT parameters{};
  ContextT context_{parameters};

 private:
  friend struct SubsystemData<ContextT>;  // for tests
  OutputsT kept_{};
};

}  // namespace tessera
