// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/year_history.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>

#include "model/fnv1a.h"

namespace tact::firmware::telemetry {
namespace {

constexpr std::size_t kSealed = kHistoryRecord_bytes - 2;

template <class Number>
void put(std::span<unsigned char> bytes, std::size_t at, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes[at + i] = static_cast<unsigned char>(number >> (8 * i) & 0xFF);
}
std::uint32_t get(std::span<const unsigned char> bytes, std::size_t at, std::size_t count) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < count; ++i) number |= std::uint32_t{bytes[at + i]} << (8 * i);
  return number;
}

std::uint16_t clipped(std::uint64_t number) {
  return static_cast<std::uint16_t>(
      std::min<std::uint64_t>(number, std::numeric_limits<std::uint16_t>::max()));
}
// Rounded up: a largest is never reported too small.
std::uint16_t tenths_us(std::int64_t ns) {
  return clipped(static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0) + 99) / 100);
}
std::uint16_t check_of(std::span<const unsigned char> bytes) {
  const std::uint64_t hash = model::fnv1a(bytes.first(kSealed));
  return static_cast<std::uint16_t>(hash ^ hash >> 16 ^ hash >> 32 ^ hash >> 48);
}

std::string head() {
  std::array<unsigned char, kHistoryHead_bytes> bytes{'t', 'a', 'c', 't', 'h', 'i', 's', 't'};
  put(bytes, 8, 1u);
  put(bytes, 12, static_cast<std::uint32_t>(kHistoryInterval_s));
  put(bytes, 16, kHistoryRecords);
  put(bytes, 20, static_cast<std::uint32_t>(kHistoryRecord_bytes));
  return {bytes.begin(), bytes.end()};
}

off_t offset_of(std::uint32_t interval) {
  return static_cast<off_t>(kHistoryHead_bytes +
                            kHistoryRecord_bytes * (interval % kHistoryRecords));
}

}  // namespace

void Interval::merge(const Interval& later) {
  wake_max_ns = std::max(wake_max_ns, later.wake_max_ns);
  tick_max_ns = std::max(tick_max_ns, later.tick_max_ns);
  deadline_to_force_max_ns = std::max(deadline_to_force_max_ns, later.deadline_to_force_max_ns);
  skipped += later.skipped;
  late += later.late;
  limits = static_cast<std::uint16_t>(limits | later.limits);
  if (fault == 0) fault = later.fault;
}

HistoryRecord pack(std::uint32_t interval, const Interval& of) {
  HistoryRecord out{};
  put(out, 0, interval + 1);
  put(out, 4, tenths_us(of.wake_max_ns));
  put(out, 6, tenths_us(of.tick_max_ns));
  put(out, 8, tenths_us(of.deadline_to_force_max_ns));
  put(out, 10, clipped(of.skipped));
  put(out, 12, clipped(of.late));
  put(out, 14, of.limits);
  put(out, 16, static_cast<std::uint8_t>(of.fault));
  put(out, kSealed, check_of(out));
  return out;
}

std::optional<Interval> unpack(const HistoryRecord& record, std::uint32_t interval) {
  if (get(record, 0, 4) != interval + 1 || get(record, kSealed, 2) != check_of(record))
    return std::nullopt;
  const auto ns = [&](std::size_t at) { return std::int64_t{100} * get(record, at, 2); };
  return Interval{.wake_max_ns = ns(4),
                  .tick_max_ns = ns(6),
                  .deadline_to_force_max_ns = ns(8),
                  .skipped = get(record, 10, 2),
                  .late = get(record, 12, 2),
                  .limits = static_cast<std::uint16_t>(get(record, 14, 2)),
                  .fault = record[16]};
}

model::Result<YearHistory> YearHistory::open(const std::string& path) {
  std::error_code failed;  // open then fails and reports it
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), failed);
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0640);
  const auto fails = [&](const char* why) {
    if (fd >= 0) close(fd);
    return model::Error{
        fmt::format("{}: {}: no history of this PC is kept; move it away", path, why)};
  };
  if (fd < 0) return fails(std::strerror(errno));
  const std::string wanted = head();
  std::string found(wanted.size(), '\0');
  const ssize_t bytes = pread(fd, found.data(), found.size(), 0);
  if (bytes < 0) return fails(std::strerror(errno));
  if (bytes > 0 && found != wanted) return fails("is no history of this version");
  if (bytes == 0 && pwrite(fd, wanted.data(), wanted.size(), 0) != ssize_t(wanted.size()))
    return fails("cannot be written");
  return YearHistory(path, fd);
}

YearHistory::YearHistory(YearHistory&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      at_(other.at_),
      has_ticks_(other.has_ticks_),
      skipped_before_(other.skipped_before_),
      late_before_(other.late_before_),
      fault_before_(other.fault_before_),
      now_(other.now_) {}

YearHistory::~YearHistory() {
  if (fd_ >= 0) close(fd_);
}

void YearHistory::add(const loop::TickRecord& record) {
  const auto phase = [&](loop::Phase p) { return record.phase_ns[static_cast<std::size_t>(p)]; };
  std::int64_t to_force_ns = 0;
  for (std::size_t p = 0; p <= static_cast<std::size_t>(loop::Phase::kWrite); ++p)
    to_force_ns += record.phase_ns[p];
  const model::Fault fault = record.output.fault;
  const auto limit = static_cast<unsigned>(record.output.limit);
  now_.merge(
      {.wake_max_ns = phase(loop::Phase::kWake),
       .tick_max_ns = phase(loop::Phase::kTotal),
       .deadline_to_force_max_ns = to_force_ns,
       .skipped = record.skipped_ticks - skipped_before_,
       .late = record.late_ticks - late_before_,
       .limits = static_cast<std::uint16_t>(limit > 0 && limit < 16 ? 1u << limit : 0u),
       .fault = static_cast<std::uint16_t>(fault == fault_before_ ? model::Fault::kNone : fault)});
  skipped_before_ = record.skipped_ticks;
  late_before_ = record.late_ticks;
  fault_before_ = fault;
  has_ticks_ = true;
}

std::optional<std::string> YearHistory::work(std::int64_t utc_s) {
  const std::int64_t at = utc_s / kHistoryInterval_s;
  if (at == at_) return std::nullopt;
  auto failed = write();
  at_ = at;
  return failed;
}

std::optional<std::string> YearHistory::finish() { return write(); }

std::optional<std::string> YearHistory::write() {
  if (fd_ < 0 || at_ <= 0 || !has_ticks_) return std::nullopt;
  const auto interval = static_cast<std::uint32_t>(at_);
  HistoryRecord record{};
  // A run before this one may have written a part of the same interval.
  if (pread(fd_, record.data(), record.size(), offset_of(interval)) == ssize_t(record.size()))
    if (auto before = unpack(record, interval)) {
      before->merge(now_);
      now_ = *before;
    }
  record = pack(interval, std::exchange(now_, {}));
  has_ticks_ = false;
  if (pwrite(fd_, record.data(), record.size(), offset_of(interval)) == ssize_t(record.size()) &&
      fdatasync(fd_) == 0)
    return std::nullopt;
  const std::string why = std::strerror(errno);
  close(std::exchange(fd_, -1));
  return fmt::format("{}: {}: the history of this PC ends here", path_, why);
}

}  // namespace tact::firmware::telemetry
