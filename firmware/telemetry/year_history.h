// SPDX-License-Identifier: Apache-2.0
// year_history.h - how this PC kept its deadlines: a record each 5 minutes, of the last 365
// days, in one file of at most 2 MB.
//
//     head     "tacthist" u32 version 1, u32 interval 300 s, u32 records 105120, u32 bytes 19
//     record n at 24 + 19 (n mod 105120), n = UTC / 300 s; little endian:
//       u32 n + 1; 0: empty        u16 wake, tick, deadline to force, the largest, 0.1 us
//       u16 skipped, late periods  u16 limits: bit of each reason code 1..15 that acted
//       u8  first fault; 0: none   u16 FNV-1a of the bytes before, folded
//
// What is too large for its field is its largest value. A record that a power cut has torn fails
// its checksum; the others are as they were. Only the telemetry thread calls it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "firmware/loop/tick_record.h"
#include "model/result.h"

namespace tact::firmware::telemetry {

inline constexpr std::int64_t kHistoryInterval_s = 300;
inline constexpr std::uint32_t kHistoryRecords = 105'120;  // 365 days
inline constexpr std::size_t kHistoryHead_bytes = 24, kHistoryRecord_bytes = 19;

/// What a record holds, of one interval.
struct Interval {
  std::int64_t wake_max_ns = 0, tick_max_ns = 0, deadline_to_force_max_ns = 0;
  std::uint64_t skipped = 0, late = 0;
  std::uint16_t limits = 0;  // bit k: reason code k has acted
  std::uint16_t fault = 0;   // the first that latched

  /// The other one came after it.
  void merge(const Interval& later);
};

class YearHistory {
 public:
  /// Opens, or makes with its folder. An error names the file and the remedy.
  static model::Result<YearHistory> open(const std::string& path);
  YearHistory(YearHistory&& other) noexcept;
  YearHistory& operator=(YearHistory&&) = delete;
  YearHistory(const YearHistory&) = delete;
  ~YearHistory();

  void add(const loop::TickRecord& record);
  /// Call once a second: when an interval has ended, its record is put on the disk. The error of a
  /// write, once; nothing is written after it.
  std::optional<std::string> work(std::int64_t utc_s);
  /// The interval so far, at the end of a run.
  std::optional<std::string> finish();

 private:
  YearHistory(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
  std::optional<std::string> write();

  std::string path_;
  int fd_ = -1;
  std::int64_t at_ = 0;  // UTC / 300 s; 0: not known yet
  bool has_ticks_ = false;
  std::uint64_t skipped_before_ = 0, late_before_ = 0;
  model::Fault fault_before_ = model::Fault::kNone;
  Interval now_;
};

using HistoryRecord = std::array<unsigned char, kHistoryRecord_bytes>;
HistoryRecord pack(std::uint32_t interval, const Interval& of);
/// Nothing if it is empty, torn, or of another interval.
std::optional<Interval> unpack(const HistoryRecord& record, std::uint32_t interval);

}  // namespace tact::firmware::telemetry
