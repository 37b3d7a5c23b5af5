// SPDX-License-Identifier: Apache-2.0
// tick_log.h - a run on disk, tick by tick: inputs and outputs.
//
// The header holds the scene's hash and the gate's force share. One LoggedTick per tick follows, in
// the machine's own byte order, each with its CRC; then the seal of the whole file. A log from the
// first tick on is enough to compute every force again, bit for bit (replay.h). A black box has the
// last seconds before a fault, and frames of them for the viewer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/loop/tick_record.h"
#include "firmware/telemetry/recording_format.h"
#include "model/io/seal.h"
#include "model/limits.h"
#include "model/result.h"

namespace tact::firmware::telemetry {

struct LogHeader : LogStart {
  std::int64_t period_ns = 0;
  model::Limits limits{};    // of scene and device together
  double force_share = 1.0;  // of the scene's limits; below 1 without hard real time
  std::uint8_t non_rt = 0;
  char scene_hash[23] = {};
  char overrides[1024] = {};  // --set values of the run, its law included; one per line
  char scene_name[64] = {}, law[64] = {}, revision[64] = {}, host[64] = {};
  char began_utc[24] = {};       // 2026-01-31T12:00:00Z
  std::uint32_t header_crc = 0;  // of all before it
  std::uint32_t pad = 0;

  /// False if they are too long.
  bool keep_overrides(const std::vector<std::string>& of_run);
  std::vector<std::string> overrides_of_run() const;
};

struct LoggedTick {
  std::uint64_t tick = 0;
  std::uint8_t non_rt = 0;  // set in every record of a PC without hard real time
  std::int64_t due_ns = 0;
  std::int64_t margin_ns = 0;                              // time left of the tick before
  std::array<std::int32_t, loop::kPhaseCount> phase_ns{};  // publish and total of the tick before
  loop::TickInput input;
  loop::TickOutput output;

  static LoggedTick of(const loop::TickRecord& record, bool non_rt);
};

/// Layout in the file.
struct LogRecord {
  LoggedTick tick;
  std::uint32_t crc = 0;  // of tick
  std::uint32_t pad = 0;
};

/// Writes in an ordinary thread. A full disk ends the log, but not the run.
class TickLogWriter {
 public:
  static model::Result<TickLogWriter> create(const std::string& path, const LogHeader& header);
  void add(const loop::TickRecord& record) { add(LoggedTick::of(record, non_rt_)); }
  void add(const LoggedTick& tick);
  /// After the ticks that the header announces: a part of the recording.
  void append(const std::string& bytes);
  /// The error after which nothing more is written, if any.
  const std::optional<model::Error>& trouble() const { return trouble_; }
  /// Closes the file. An error if data did not reach the disk.
  std::optional<model::Error> close();

 private:
  TickLogWriter(model::io::SealedWriter file, bool non_rt)
      : file_(std::move(file)), non_rt_(non_rt) {}

  void put(const void* bytes, std::size_t size, const std::string& where);

  std::optional<model::io::SealedWriter> file_;
  bool non_rt_;
  std::optional<model::Error> trouble_;
};

class TickLogReader {
 public:
  static model::Result<TickLogReader> open(const std::string& path);
  const LogHeader& header() const { return header_; }
  /// The next good tick; skips damaged ones. False at the end.
  bool next(LoggedTick& tick);
  /// Call after the last tick: empty, or the damage and the number of good ticks.
  std::string damage();

 private:
  TickLogReader(model::io::SealedFile file, const LogHeader& header)
      : file_(std::move(file)), header_(header) {}

  model::io::SealedFile file_;
  LogHeader header_;
  std::uint64_t read_ = 0, good_ = 0, first_damaged_ = 0;
  bool torn_ = false;
};

}  // namespace tact::firmware::telemetry
