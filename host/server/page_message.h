// SPDX-License-Identifier: Apache-2.0
// page_message.h - parses a message of a page, before any check of its content.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "model/io/json.h"

namespace tact::host::server {

/// The object that a message has under this key; null: none, or the message is no JSON object.
inline nlohmann::json object_in(const std::string& text, const char* key) {
  const auto message = model::io::parse_json(text, "request");
  if (!message || !message->is_object()) return {};
  const auto found = message->find(key);
  return found != message->end() && found->is_object() ? *found : nlohmann::json();
}

}  // namespace tact::host::server
