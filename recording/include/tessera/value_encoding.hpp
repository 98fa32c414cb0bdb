#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

/// The encoding of values of buffers in recordings: field after field, numbers little-endian, without the
/// padding of the compiler, so that equal values have equal bytes. A text describes the type
/// (tessera/value_text.hpp reads it):
///
///     bool  int8 .. int64  uint8 .. uint64  float32  float64
///     string(N)            uint32 length and so many bytes
///     TYPE[N]              N of them
///     TYPE[<=N]            uint32 length and so many of them
///     {name: TYPE, ...}    the fields in this order
///   bytes(N)             a type that does not list its fields
namespace tessera {

template <class T>
concept Sequence = requires(T& value) {
  value.begin();
  value.end();
};
/// A structure that lists its fields: a function `tessera_fields_of(const T&)` beside it gives a std::tuple
/// of pointers to members (tessera/fields.hpp defines one). The names of the fields are numbers unless
/// `tessera_field_names_of(const T&)` gives names.
template <class T>
concept WithFields = std::is_class_v<T> && requires(T& value) {
  tessera_fields_of(value);
};
/// BoundedString and similar types.
template <class T>
concept BoundedText = requires(const T& value) {
  T::capacity();
  { value.view() } -> std::convertible_to<std::string_view>;
};

/// BoundedSequence and similar types.
template <class T>
concept BoundedList = Sequence<T> && !BoundedText<T> && requires(T & value) {
  T::capacity();
  value.resize(value.size());
};

/// Takes the bytes of a value. It keeps them if there are at most `limit`, and otherwise only their number
/// and a hash.
class ValueSink {
 public:
  explicit ValueSink(std::size_t limit) : limit_(limit), bytes_(std::make_unique<std::byte[]>(limit)) {}

  void clear() { filled_ = total_ = hash_ = 0; }
  void put(const void* bytes, std::size_t count);

  [[nodiscard]] bool whole() const { return total_ <= limit_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return {bytes_.get(), filled_}; }  ///< if complete
  [[nodiscard]] std::uint64_t size() const { return total_; }
  [[nodiscard]] std::uint64_t hash() const;
  friend bool operator==(const ValueSink& a, const ValueSink& b) {
    if (a.total_ != b.total_ || a.whole() != b.whole()) return false;
    return a.whole() ? std::memcmp(a.bytes_.get(), b.bytes_.get(), a.total_) == 0 : a.hash() == b.hash();
  }

 private:
  void spill(const void* bytes, std::size_t count);
  std::size_t limit_, filled_ = 0;
  std::uint64_t total_ = 0, hash_ = 0;
  std::unique_ptr<std::byte[]> bytes_;
};

/// Hands the bytes out again. If too few are left, it hands out nothing from then on.
class ValueSource {
 public:
  explicit ValueSource(std::span<const std::byte> bytes) : left_(bytes) {}
  void take(void* to, std::size_t count) {
    if (count > left_.size()) {
      sufficed_ = false;
      left_ = {};
      return;
    }
    if (count == 0) return;  // there may be no bytes at all to copy from
    std::memcpy(to, left_.data(), count);
    left_ = left_.subspan(count);
  }
  /// Whether exactly the bytes of the value were there, and no more.
  [[nodiscard]] bool exact() const { return sufficed_ && left_.empty(); }

 private:
  std::span<const std::byte> left_;
  bool sufficed_ = true;
};

namespace encoding {

template <class T>
using Element = std::remove_cvref_t<decltype(*std::declval<T&>().begin())>;

/// The number of elements of a sequence; 0: the type has no fixed number.
template <class T>
[[nodiscard]] constexpr std::size_t extent() {
  if constexpr (requires { std::tuple_size<T>::value; })
    return std::tuple_size_v<T>;
  else if constexpr (requires { std::integral_constant<std::size_t, T::size()>{}; })
    return T::size();
  else
    return 0;
}

/// Calls `visit(std::type_identity<Member>...)` with the types of the fields.
template <class T, class Visit>
constexpr auto with_field_types(Visit visit) {
  return [&]<class... Members>(std::type_identity<std::tuple<Members T::*...>>) {
    return visit(std::type_identity<Members>{}...);
  }(std::type_identity<decltype(tessera_fields_of(std::declval<const T&>()))>{});
}

template <class T>
[[nodiscard]] constexpr bool possible() {
  if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T> || BoundedText<T>)
    return true;
  else if constexpr (BoundedList<T>)
    return possible<Element<T>>();
  else if constexpr (Sequence<T>)
    return extent<T>() != 0 && possible<Element<T>>();
  else if constexpr (WithFields<T>)
    return with_field_types<T>(
        [](auto... member) { return (possible<typename decltype(member)::type>() && ...); });
  else
    return std::is_trivially_copyable_v<T>;
}

/// The size of the longest value in bytes.
template <class T>
[[nodiscard]] constexpr std::size_t most() {
  if constexpr (BoundedText<T>)
    return sizeof(std::uint32_t) + T::capacity();
  else if constexpr (BoundedList<T>)
    return sizeof(std::uint32_t) + T::capacity() * most<Element<T>>();
  else if constexpr (Sequence<T>)
    return extent<T>() * most<Element<T>>();
  else if constexpr (WithFields<T>)
    return with_field_types<T>(
        [](auto... member) { return (std::size_t{0} + ... + most<typename decltype(member)::type>()); });
  else
    return sizeof(T);
}

template <class T>
[[nodiscard]] std::string type_text() {
  if constexpr (std::is_same_v<T, bool>) {
    return "bool";
  } else if constexpr (std::is_enum_v<T>) {
    return type_text<std::underlying_type_t<T>>();
  } else if constexpr (std::is_arithmetic_v<T>) {
    const char* kind = std::is_floating_point_v<T> ? "float" : std::is_signed_v<T> ? "int" : "uint";
    return kind + std::to_string(8 * sizeof(T));
  } else if constexpr (BoundedText<T>) {
    return "string(" + std::to_string(T::capacity()) + ")";
  } else if constexpr (BoundedList<T>) {
    return type_text<Element<T>>() + "[<=" + std::to_string(T::capacity()) + "]";
  } else if constexpr (Sequence<T>) {
    return type_text<Element<T>>() + "[" + std::to_string(extent<T>()) + "]";
  } else if constexpr (WithFields<T>) {
    std::string_view names;
    if constexpr (requires(const T& value) { tessera_field_names_of(value); })
      names = tessera_field_names_of(T{});
    std::string text;
    std::size_t number = 0;
    const auto add = [&](const std::string& type) {
      const std::string name(names.substr(0, names.find(", ")));
      names.remove_prefix(std::min(names.size(), name.size() + 2));
      text += (number == 0 ? "" : ", ") + (name.empty() ? std::to_string(number) : name) + ": " + type;
      ++number;
    };
    with_field_types<T>([&](auto... member) { (add(type_text<typename decltype(member)::type>()), ...); });
    return "{" + text + "}";
  } else {
    return "bytes(" + std::to_string(sizeof(T)) + ")";
  }
}

template <class T>
void put(const T& value, ValueSink& to) {
  if constexpr (BoundedText<T>) {
    const std::string_view text = value.view();
    const auto length = static_cast<std::uint32_t>(text.size());
    to.put(&length, sizeof length);
    to.put(text.data(), text.size());
  } else if constexpr (Sequence<T>) {
    const std::size_t count = static_cast<std::size_t>(value.size());
    if constexpr (BoundedList<T>) {
      const auto length = static_cast<std::uint32_t>(count);
      to.put(&length, sizeof length);
    }
    if constexpr (std::is_arithmetic_v<Element<T>>)
      to.put(value.data(), count * sizeof(Element<T>));
    else
      for (const auto& element : value) put(element, to);
  } else if constexpr (WithFields<T>) {
    std::apply([&](auto... member) { (put(value.*member, to), ...); }, tessera_fields_of(value));
  } else {
    to.put(&value, sizeof value);
  }
}

template <class T>
void take(T& value, ValueSource& from) {
  if constexpr (BoundedText<T>) {
    std::uint32_t length = 0;
    std::array<char, T::capacity()> text;
    from.take(&length, sizeof length);
    length = length < T::capacity() ? length : static_cast<std::uint32_t>(T::capacity());
    from.take(text.data(), length);
    value = std::string_view(text.data(), length);
  } else if constexpr (Sequence<T>) {
    if constexpr (BoundedList<T>) {
      std::uint32_t length = 0;
      from.take(&length, sizeof length);
      // Bytes are left if it is more, so that the value is refused.
      value.clear();
      value.resize(length < T::capacity() ? length : T::capacity());
    }
    if constexpr (std::is_arithmetic_v<Element<T>>)
      from.take(value.data(), static_cast<std::size_t>(value.size()) * sizeof(Element<T>));
    else
      for (auto& element : value) take(element, from);
  } else if constexpr (WithFields<T>) {
    std::apply([&](auto... member) { (take(value.*member, from), ...); }, tessera_fields_of(value));
  } else {
    from.take(&value, sizeof value);
  }
}

}  // namespace encoding

/// Encodes and decodes values of one type for recordings.
struct ValueEncoding {
  std::string (*type)();  ///< as described above
  std::size_t most;       ///< length of the longest value in bytes
  void (*put)(const void* value, ValueSink& to);
  /// false: the bytes do not encode a value of this type. `value` may have changed even then.
  bool (*take)(void* value, std::span<const std::byte> bytes);
};

/// nullptr: values of that type cannot be recorded, because their size is not fixed.
template <class T>
[[nodiscard]] const ValueEncoding* value_encoding_of() {
  if constexpr (!encoding::possible<T>()) {
    return nullptr;
  } else {
    static constexpr ValueEncoding encoding{
        [] { return encoding::type_text<T>(); }, encoding::most<T>(),
        [](const void* value, ValueSink& to) { encoding::put(*static_cast<const T*>(value), to); },
        [](void* value, std::span<const std::byte> bytes) {
          ValueSource from(bytes);
          encoding::take(*static_cast<T*>(value), from);
          return from.exact();
        }};
    return &encoding;
  }
}

}  // namespace tessera
