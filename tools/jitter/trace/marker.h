// SPDX-License-Identifier: Apache-2.0
// marker.h - a line in the kernel's own trace for each late tick, so that ftrace shows what ran.
#pragma once

#include <string>

#include "firmware/pc/pc_files.h"

namespace tact::tools::jitter {

/// /sys/kernel/tracing/trace_marker, where it may be written (root; tracefs mounted). Written by an
/// ordinary thread some milliseconds after the tick, so the line itself says when that was.
class TraceMarker {
 public:
  /// `stop`: the first line also ends the kernel's recording, while what led to it is still there.
  TraceMarker(const firmware::pc::PcFiles& files, bool stop);
  ~TraceMarker();
  TraceMarker(const TraceMarker&) = delete;
  TraceMarker& operator=(const TraceMarker&) = delete;

  bool is_open() const { return fd_ >= 0; }
  void write(const std::string& line);

 private:
  int fd_ = -1, stop_fd_ = -1;
};

}  // namespace tact::tools::jitter
