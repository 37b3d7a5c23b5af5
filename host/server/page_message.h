// SPDX-License-Identifier: Apache-2.0
// page_message.h - a message of a page, before anybody believes what it says.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tact::host::server {

/// The object that a message has under this key; null: none, or the message is no JSON object.
nlohmann::json object_in(const std::string& text, const char* key);

}  // namespace tact::host::server
