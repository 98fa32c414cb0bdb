#pragma once

#include <optional>
#include <string>
#include <utility>

namespace tessera {

/// The reason why something was not done, as text for people.
struct Problem {
  std::string text;
};

/// A value, or the problem that prevented it. A function without a value returns std::optional<Problem>.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Problem problem) : problem_(std::move(problem)) {}

  [[nodiscard]] explicit operator bool() const { return value_.has_value(); }
  /// Precondition of these: there is a value.
  [[nodiscard]] T& operator*() { return *value_; }
  [[nodiscard]] const T& operator*() const { return *value_; }
  [[nodiscard]] T* operator->() { return &*value_; }
  [[nodiscard]] const T* operator->() const { return &*value_; }
  /// Empty if there is a value.
  [[nodiscard]] const std::string& problem() const { return problem_.text; }

 private:
  std::optional<T> value_;
  Problem problem_;
};

}  // namespace tessera
