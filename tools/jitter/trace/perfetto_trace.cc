// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/trace/perfetto_trace.h"

namespace tact::tools::jitter {
namespace {

// Field numbers, by message.
constexpr unsigned kTracePacket = 1;  // Trace
constexpr unsigned kPacketTimestamp = 8, kPacketSequence = 10, kPacketEvent = 11,
                   kPacketSequenceFlags = 13, kPacketDescriptor = 60;  // TracePacket
constexpr unsigned kTrackUuid = 1, kTrackName = 2, kTrackProcess = 3, kTrackParent = 5,
                   kTrackCounter = 8;                  // TrackDescriptor
constexpr unsigned kProcessPid = 1, kProcessName = 6;  // ProcessDescriptor
constexpr unsigned kCounterUnitName = 6;               // CounterDescriptor
constexpr unsigned kEventType = 9, kEventTrack = 11, kEventCategory = 22, kEventName = 23,
                   kEventCounter = 30;  // TrackEvent

constexpr std::uint64_t kSliceBegin = 1, kSliceEnd = 2, kInstant = 3, kCounter = 4;  // its types
constexpr std::uint64_t kOurSequence = 1;  // all packets come from one writer
constexpr std::uint64_t kStateCleared = 1;

void put_varint(std::string& out, std::uint64_t value) {
  // Seven bits a byte, the lowest first; bit 7 says that more follow.
  for (; value >= 0x80; value >>= 7) out += static_cast<char>(value | 0x80);
  out += static_cast<char>(value);
}

void put_number(std::string& out, unsigned field, std::uint64_t value) {
  // Kind 0, a varint, has no bits of its own.
  put_varint(out, std::uint64_t{field} << 3);
  put_varint(out, value);
}

void put_bytes(std::string& out, unsigned field, std::string_view bytes) {
  put_varint(out, std::uint64_t{field} << 3 | 2);
  put_varint(out, bytes.size());
  out += bytes;
}

std::string make_event(std::uint64_t track, std::uint64_t type) {
  std::string event;
  put_number(event, kEventType, type);
  put_number(event, kEventTrack, track);
  return event;
}

std::string make_packet(std::int64_t time_ns, std::string_view event) {
  std::string packet;
  put_number(packet, kPacketTimestamp, static_cast<std::uint64_t>(time_ns));
  put_number(packet, kPacketSequence, kOurSequence);
  put_bytes(packet, kPacketEvent, event);
  return packet;
}

std::string make_descriptor_packet(std::string_view descriptor) {
  std::string packet;
  put_number(packet, kPacketSequence, kOurSequence);
  // The sequence's state begins here: no event refers to anything before it.
  put_number(packet, kPacketSequenceFlags, kStateCleared);
  put_bytes(packet, kPacketDescriptor, descriptor);
  return packet;
}

}  // namespace

std::uint64_t PerfettoTrace::add_process(int process, std::string_view name) {
  std::string about;
  put_number(about, kProcessPid, static_cast<std::uint64_t>(process));
  put_bytes(about, kProcessName, name);
  return add_descriptor(0, {}, kTrackProcess, about);
}

std::uint64_t PerfettoTrace::add_track(std::uint64_t parent, std::string_view name) {
  return add_descriptor(parent, name, 0, {});
}

std::uint64_t PerfettoTrace::add_counter_track(std::uint64_t parent, std::string_view name,
                                               std::string_view unit) {
  std::string about;
  put_bytes(about, kCounterUnitName, unit);
  return add_descriptor(parent, name, kTrackCounter, about);
}

std::uint64_t PerfettoTrace::add_descriptor(std::uint64_t parent, std::string_view name,
                                            unsigned field, std::string_view about) {
  std::string descriptor;
  put_number(descriptor, kTrackUuid, ++tracks_);
  if (parent != 0) put_number(descriptor, kTrackParent, parent);
  if (!name.empty()) put_bytes(descriptor, kTrackName, name);
  if (field != 0) put_bytes(descriptor, field, about);
  add_packet(make_descriptor_packet(descriptor));
  return tracks_;
}

void PerfettoTrace::begin_slice(std::uint64_t track, std::int64_t time_ns, std::string_view name) {
  add_event(track, time_ns, kSliceBegin, name);
}

void PerfettoTrace::end_slice(std::uint64_t track, std::int64_t time_ns) {
  add_event(track, time_ns, kSliceEnd, {});
}

void PerfettoTrace::mark(std::uint64_t track, std::int64_t time_ns, std::string_view name) {
  add_event(track, time_ns, kInstant, name);
}

void PerfettoTrace::count(std::uint64_t track, std::int64_t time_ns, std::int64_t value) {
  std::string event = make_event(track, kCounter);
  // int64 in protobuf: two's complement in ten bytes where it is negative.
  put_number(event, kEventCounter, static_cast<std::uint64_t>(value));
  add_packet(make_packet(time_ns, event));
}

void PerfettoTrace::add_event(std::uint64_t track, std::int64_t time_ns, std::uint64_t type,
                              std::string_view name) {
  std::string event = make_event(track, type);
  if (!name.empty()) {
    put_bytes(event, kEventCategory, "tact");
    put_bytes(event, kEventName, name);
  }
  add_packet(make_packet(time_ns, event));
}

void PerfettoTrace::add_packet(const std::string& packet) {
  put_bytes(bytes_, kTracePacket, packet);
}

}  // namespace tact::tools::jitter
