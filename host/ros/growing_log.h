// SPDX-License-Identifier: Apache-2.0
// growing_log.h - follows the tick log that tactd --record writes: each tick once, as it comes.
//
// tactd hands over what it has written at its frame rate. A log that is there already is followed
// from its end; one that begins later, and one that begins again (RunWriter), from its first tick.
// Bytes that are no whole chunk are skipped.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_file.h"
#include "model/result.h"

namespace tact::host::ros {

struct LogEvents {
  std::function<void(const firmware::protocol::RunHeader&)> start;  // of each log
  std::function<void(const firmware::protocol::LoggedTick&)> tick;
};

class GrowingLog {
 public:
  GrowingLog(std::string path, LogEvents events)
      : path_(std::move(path)), events_(std::move(events)) {}
  ~GrowingLog() { close(); }
  GrowingLog(const GrowingLog&) = delete;
  GrowingLog& operator=(const GrowingLog&) = delete;

  /// Reads what is new. An error if the file is no tick log of this version.
  std::optional<model::Error> read();
  bool is_open() const { return file_ >= 0; }

 private:
  std::optional<model::Error> open();
  std::optional<model::Error> begin(std::size_t head_bytes);
  bool is_replaced() const;
  void read_chunks();
  /// Takes the chunk at `at`; its bytes, 1 where none begins, 0 where it is not whole yet.
  std::size_t take_chunk(std::size_t at);
  void close();

  std::string path_;
  LogEvents events_;
  int file_ = -1;
  dev_t device_ = 0;
  ino_t inode_ = 0;
  bool was_here_ = true;  // the log that was there when this began
  std::string bytes_;     // read, not yet taken
  std::optional<firmware::protocol::Unpacker> ticks_;
};

}  // namespace tact::host::ros
