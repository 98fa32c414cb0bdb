#pragma once

#include <optional>
#include <string>
#include <utility>

namespace tessera {

/// Why something was not done, for people.
struct Problem {
  std::string text;
};

/// A value, or the problem that kept it from being made. Of what makes no value: std::optional<Problem>.
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
