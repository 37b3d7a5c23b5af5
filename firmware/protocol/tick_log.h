// SPDX-License-Identifier: Apache-2.0
// tick_log.h - reads the ticks of a tick log or a black box.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_file.h"

namespace tact::firmware::protocol {

class TickLog {
 public:
  /// An error if the file has no ticks.
  static model::Result<TickLog> open(const std::string& path);
  const RunHeader& header() const { return reader_.header(); }
  /// Fields of this program that the file has not: what it replays would not be the run.
  const std::vector<std::string>& missing() const { return unpacker_.missing(); }
  /// The next good tick; skips damaged ones. False at the end.
  bool next(LoggedTick& tick);
  /// The law's numbers of the ticks with this `variant`, each KEY=VALUE; null if the file has them
  /// not, or not yet.
  const std::vector<std::string>* variant(std::uint32_t number) const;
  /// True if the last tick comes after damage.
  bool skipped() const { return skipped_; }
  /// Call after the last tick: empty, or the damage and the number of good ticks.
  std::string damage();

 private:
  void keep_variant();
  TickLog(RunReader reader, Unpacker unpacker)
      : reader_(std::move(reader)), unpacker_(std::move(unpacker)) {}

  RunReader reader_;
  Unpacker unpacker_;
  Chunk chunk_;
  std::map<std::uint32_t, std::vector<std::string>> variants_;
  std::uint64_t good_ = 0;
  bool skipped_ = false;
};

}  // namespace tact::firmware::protocol
