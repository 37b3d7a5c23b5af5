// SPDX-License-Identifier: Apache-2.0
// tick_log.h - a run on disk, tick by tick: what came in and what went out.
//
// A header that names the scene (by hash) and the gate's force share, then one LoggedTick per tick
// in the machine's own byte order. From the first tick on it is enough to compute every force
// again, bit for bit (replay.h). A black box holds the last seconds before a fault, and pictures of
// them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/loop/tick_record.h"
#include "firmware/telemetry/recording_format.h"
#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/limits.h"
#include "model/result.h"

namespace tact::firmware::telemetry {

struct LogHeader : LogStart {
  std::int64_t period_ns = 0;
  model::Limits limits{};    // of scene and device together
  double force_share = 1.0;  // of the scene's limits; below 1 without hard real time
  std::uint8_t non_rt = 0;
  char scene_hash[23] = {};
  char overrides[1024] = {};  // of the run, its law included; one a line

  /// False if they are too long.
  bool keep_overrides(const std::vector<std::string>& of_run);
  std::vector<std::string> overrides_of_run() const;
};

struct LoggedTick {
  std::uint64_t tick = 0;
  std::uint8_t non_rt = 0;  // stamped on every record of a PC without hard real time
  std::int64_t due_ns = 0;
  std::int32_t wake_late_ns = 0;
  loop::TickInput input;
  loop::TickOutput output;

  static LoggedTick of(const loop::TickRecord& record, bool non_rt);
};

/// Writes in an ordinary thread. A full disk ends the log, never the run.
class TickLogWriter {
 public:
  static model::Result<TickLogWriter> create(const std::string& path, const LogHeader& header);
  void add(const loop::TickRecord& record) { add(LoggedTick::of(record, non_rt_)); }
  void add(const LoggedTick& tick);
  /// After the ticks that the header counts: a part of the recording.
  void append(const std::string& bytes);
  /// Since when it writes no more, and why.
  const std::optional<model::Error>& trouble() const { return trouble_; }
  /// Closes the file. An error if not everything reached the disk.
  std::optional<model::Error> close();

 private:
  TickLogWriter(model::io::FileWriter file, bool non_rt)
      : file_(std::move(file)), non_rt_(non_rt) {}

  void put(const void* bytes, std::size_t size, const std::string& where);

  std::optional<model::io::FileWriter> file_;
  bool non_rt_;
  std::optional<model::Error> trouble_;
};

class TickLogReader {
 public:
  static model::Result<TickLogReader> open(const std::string& path);
  const LogHeader& header() const { return header_; }
  /// False at the end. A torn last tick counts as the end; see truncated().
  bool next(LoggedTick& tick);
  bool truncated() const { return truncated_; }

 private:
  TickLogReader(model::io::InputFile file, const LogHeader& header)
      : file_(std::move(file)), header_(header) {}

  model::io::InputFile file_;
  LogHeader header_;
  std::uint64_t read_ = 0;
  bool truncated_ = false;
};

}  // namespace tact::firmware::telemetry
