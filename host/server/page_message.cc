// SPDX-License-Identifier: Apache-2.0
#include "host/server/page_message.h"

#include "model/io/json.h"

namespace tact::host::server {

nlohmann::json object_in(const std::string& text, const char* key) {
  const auto message = model::io::parse_json(text, "request");
  if (!message || !message->is_object()) return {};
  const auto found = message->find(key);
  return found != message->end() && found->is_object() ? *found : nlohmann::json();
}

}  // namespace tact::host::server
