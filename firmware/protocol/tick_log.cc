// SPDX-License-Identifier: Apache-2.0
#include "firmware/protocol/tick_log.h"

#include <fmt/format.h>

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
    if (chunk_.kind != ChunkKind::kTick || !unpacker_.unpack(chunk_.content, &tick)) continue;
    ++good_;
    return true;
  }
  return false;
}

std::string TickLog::damage() {
  const std::string damage = reader_.damage();
  return damage.empty() ? damage : damage + fmt::format("{} good ticks were read", good_);
}

}  // namespace tact::firmware::protocol
