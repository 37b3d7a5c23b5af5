// SPDX-License-Identifier: Apache-2.0
// result.h - a value, or an error with the sentence that a person needs. As std::expected of C++23,
// but an Error converts by itself, and value() of an error is a mistake of the caller. Set-up code
// only. What gives no value returns std::optional<Error>: empty is good.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace tact::model {

/// One line: what, where (file:line where there is one), and the cure.
struct Error {
  std::string sentence;
};

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }
  T& value() { return *std::get_if<T>(&content_); }
  const T& value() const { return *std::get_if<T>(&content_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const { return *std::get_if<Error>(&content_); }

 private:
  std::variant<T, Error> content_;
};

}  // namespace tact::model
