// SPDX-License-Identifier: Apache-2.0
// result.h - a value, or an error with the message that a person needs. As std::expected of C++23,
// but an Error converts by itself, and value() of an error ends the program with its message.
// Set-up code only. What gives no value returns std::optional<Error>: empty is good.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <variant>

namespace tact::model {

/// What a caller acts on; the message is for people alone.
enum class ErrorCode : std::uint8_t { kOther, kInterrupted, kProgramCrashed };

/// The message is one line: what, where (file:line where there is one), and the remedy.
struct Error {
  std::string message;
  ErrorCode code = ErrorCode::kOther;
};

/// A programming error: ends the program in every build type, as there is no valid value.
[[noreturn]] inline void end_with(const std::string& mistake) {
  static_cast<void>(std::fputs((mistake + "\n").c_str(), stderr));
  std::abort();
}

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}

  bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }
  T& value() { return const_cast<T&>(std::as_const(*this).value()); }
  const T& value() const {
    if (const T* value = std::get_if<T>(&content_)) return *value;
    end_with("value() of an error: " + error().message);
  }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const {
    if (const Error* error = std::get_if<Error>(&content_)) return *error;
    end_with("error() of a value");
  }

 private:
  std::variant<T, Error> content_;
};

}  // namespace tact::model
