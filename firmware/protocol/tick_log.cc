// SPDX-License-Identifier: Apache-2.0
#include "firmware/protocol/tick_log.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::firmware::protocol {

model::Result<TickLog> TickLog::open(const std::string& path) {
  auto reader = RunReader::open(path, "name a file that tactd --record wrote");
  if (!reader) return reader.error();
  auto unpacker = reader->unpacker<LoggedTick>();
  if (!unpacker) return model::Error{path + ": " + unpacker.error().message};
  if (unpacker->missing().size() == LoggedTick::fields().size())
    return model::Error{path +
                        ": has no ticks, only frames for a viewer; name a file that tactd --record "
                        "wrote, or a black box"};
  return TickLog(std::move(*reader), std::move(*unpacker));
}

bool TickLog::next(LoggedTick& tick) {
  skipped_ = false;
  while (reader_.next(chunk_)) {
    skipped_ = skipped_ || reader_.skipped();
    if (chunk_.kind == ChunkKind::kVariant) keep_variant();
    if (chunk_.kind != ChunkKind::kTick || !unpacker_.unpack(chunk_.content, &tick)) continue;
    ++good_;
    return true;
  }
  return false;
}

// Invalid JSON is as if it were not there: its ticks then have no numbers.
void TickLog::keep_variant() {
  const auto parsed = model::io::parse_json(chunk_.content, "changes of the law");
  if (!parsed || !parsed->is_object()) return;
  const nlohmann::json& json = *parsed;
  if (!json.value("variant", nlohmann::json()).is_number_unsigned()) return;
  std::vector<std::string> set;
  for (const auto& each : json.value("set", nlohmann::json::array()))
    if (each.is_string()) set.push_back(each);
  variants_[json["variant"]] = std::move(set);
}

const std::vector<std::string>* TickLog::variant(std::uint32_t number) const {
  const auto found = variants_.find(number);
  return found == variants_.end() ? nullptr : &found->second;
}

std::string TickLog::damage() {
  const std::string damage = reader_.damage();
  return damage.empty() ? damage : damage + fmt::format("{} good ticks were read", good_);
}

}  // namespace tact::firmware::protocol
