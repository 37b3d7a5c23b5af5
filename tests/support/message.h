// SPDX-License-Identifier: Apache-2.0
// message.h - what an error says, so that a test that fails shows it.
#pragma once

#include <optional>
#include <string>

#include "model/result.h"

namespace tact::tests {

/// Empty: no error.
inline std::string message_of(const std::optional<model::Error>& error) {
  return error ? error->message : std::string();
}

/// Empty: there is a value.
template <typename T>
std::string message_of(const model::Result<T>& result) {
  return result ? std::string() : result.error().message;
}

}  // namespace tact::tests
