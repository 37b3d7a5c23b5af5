// SPDX-License-Identifier: Apache-2.0
#include "host/ros/growing_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

namespace tact::host::ros {
namespace {

namespace protocol = firmware::protocol;
using model::Error;
using protocol::ChunkHeader;

constexpr std::size_t kMaxHead_bytes = 1 << 24;   // JSON: some kilobytes
constexpr std::size_t kMaxChunk_bytes = 1 << 20;  // many times a tick
constexpr std::size_t kRead_bytes = 1 << 16;

bool is_good(const ChunkHeader& header) {
  return header.header_crc == protocol::crc_of({reinterpret_cast<const char*>(&header),
                                                offsetof(ChunkHeader, header_crc)});
}

}  // namespace

std::optional<Error> GrowingLog::read() {
  if (file_ < 0) {
    if (auto error = open()) return error;
    was_here_ = false;
  }
  if (file_ < 0) return std::nullopt;
  // Asked before the last read: what was written before it was replaced is read, too.
  const bool is_old = is_replaced();
  read_chunks();
  if (!is_old) return std::nullopt;
  close();
  return read();
}

/// No error where there is no file yet, or not yet its head.
std::optional<Error> GrowingLog::open() {
  const int fd = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0 && errno == ENOENT) return std::nullopt;
  struct stat status{};
  if (fd < 0 || fstat(fd, &status) != 0) {
    const int why = errno;
    if (fd >= 0) ::close(fd);
    return Error{fmt::format("{}: {}; name the file of tactd --record, and check who may read it",
                             path_, std::strerror(why))};
  }
  file_ = fd;
  if (!S_ISREG(status.st_mode))
    return Error{path_ + ": is no regular file; name the file of tactd --record"};
  device_ = status.st_dev;
  inode_ = status.st_ino;
  bytes_.resize(protocol::kMagic.size() + sizeof(ChunkHeader));
  const ssize_t got = pread(fd, bytes_.data(), bytes_.size(), 0);
  if (got < static_cast<ssize_t>(bytes_.size())) return close(), std::nullopt;
  ChunkHeader head;
  std::memcpy(&head, &bytes_[protocol::kMagic.size()], sizeof head);
  const bool is_head =
      bytes_.starts_with(protocol::kMagic) && is_good(head) && head.content_bytes <= kMaxHead_bytes;
  // Of another file the first bytes are enough: the reader says what is wrong.
  return begin(bytes_.size() + (is_head ? head.content_bytes : 0));
}

std::optional<Error> GrowingLog::begin(std::size_t head_bytes) {
  std::string head(head_bytes, '\0');
  const ssize_t got = pread(file_, head.data(), head.size(), 0);
  if (got < static_cast<ssize_t>(head.size())) return close(), std::nullopt;
  auto run = protocol::RunReader::of_bytes(std::move(head));
  if (!run) return Error{path_ + ": " + run.error().message};
  auto ticks = run->unpacker<protocol::LoggedTick>();
  if (!ticks) return Error{path_ + ": " + ticks.error().message};
  if (!ticks->missing().empty())
    return Error{
        fmt::format("{}: has no {} of each tick; name the file of tactd --record, of "
                    "this version of tact",
                    path_, ticks->missing().front())};
  ticks_ = std::move(*ticks);
  bytes_.clear();
  lseek(file_, was_here_ ? 0 : static_cast<off_t>(head_bytes), was_here_ ? SEEK_END : SEEK_SET);
  events_.start(run->header());
  return std::nullopt;
}

bool GrowingLog::is_replaced() const {
  struct stat status{};
  return stat(path_.c_str(), &status) == 0 && (status.st_dev != device_ || status.st_ino != inode_);
}

void GrowingLog::read_chunks() {
  for (;;) {
    const std::size_t kept = bytes_.size();
    bytes_.resize(kept + kRead_bytes);
    const ssize_t got = ::read(file_, &bytes_[kept], kRead_bytes);
    bytes_.resize(kept + static_cast<std::size_t>(got > 0 ? got : 0));
    if (got <= 0) return;
    std::size_t at = 0;
    while (const std::size_t taken = take_chunk(at)) at += taken;
    bytes_.erase(0, at);
  }
}

std::size_t GrowingLog::take_chunk(std::size_t at) {
  const std::string_view rest = std::string_view(bytes_).substr(at);
  ChunkHeader header;
  if (rest.size() < sizeof header) return 0;
  std::memcpy(&header, rest.data(), sizeof header);
  if (!is_good(header) || header.content_bytes > kMaxChunk_bytes) return 1;
  const std::size_t size = sizeof header + header.content_bytes;
  if (rest.size() < size) return 0;
  const auto chunk = protocol::chunk_in(rest.substr(0, size));
  protocol::LoggedTick tick;
  if (chunk && chunk->kind == protocol::ChunkKind::kTick && ticks_->unpack(chunk->content, &tick))
    events_.tick(tick);
  return size;
}

void GrowingLog::close() {
  if (file_ >= 0) ::close(std::exchange(file_, -1));
}

}  // namespace tact::host::ros
