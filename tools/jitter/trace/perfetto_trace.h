// SPDX-License-Identifier: Apache-2.0
// perfetto_trace.h - a trace that ui.perfetto.dev opens: native TrackEvent packets.
//
// Only the few messages that slices and counters need, in protobuf's wire format: a message is a
// row of fields; a field is the varint number << 3 | kind, then a varint (kind 0) or a length and
// bytes (kind 2). Field numbers are those of perfetto's protos/perfetto/trace/*.proto.
// Times are CLOCK_BOOTTIME, ns, perfetto's default clock.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tact::tools::jitter {

class PerfettoTrace {
 public:
  /// A process: the tracks below it belong together. Returns the number of its own track.
  std::uint64_t add_process(int process, std::string_view name);
  /// A track of slices below another.
  std::uint64_t add_track(std::uint64_t parent, std::string_view name);
  /// A track of numbers over time.
  std::uint64_t add_counter_track(std::uint64_t parent, std::string_view name,
                                  std::string_view unit);

  /// Slices of one track nest: what begins last ends first.
  void begin_slice(std::uint64_t track, std::int64_t time_ns, std::string_view name);
  void end_slice(std::uint64_t track, std::int64_t time_ns);
  /// A moment with a name.
  void mark(std::uint64_t track, std::int64_t time_ns, std::string_view name);
  void count(std::uint64_t track, std::int64_t time_ns, std::int64_t value);

  /// The whole file.
  const std::string& bytes() const { return bytes_; }

 private:
  void add_event(std::uint64_t track, std::int64_t time_ns, std::uint64_t type,
                 std::string_view name);
  std::uint64_t add_descriptor(std::uint64_t parent, std::string_view name, unsigned field,
                               std::string_view about);
  void add_packet(const std::string& packet);

  std::string bytes_;
  std::uint64_t tracks_ = 0;
};

}  // namespace tact::tools::jitter
