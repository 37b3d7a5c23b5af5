// SPDX-License-Identifier: Apache-2.0
#include "model/io/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace tact::model::io {
namespace {

constexpr std::size_t kRead_bytes = 1 << 16;

Error error_of(const std::string& path, std::string_view what, std::string_view remedy) {
  return {fmt::format("{}: {}; {}", path, what, remedy)};
}

std::string_view text_of(int number) {
  return number == ENOENT ? "no such file" : std::strerror(number);
}

/// Empty for a regular file.
std::string_view kind_of(mode_t mode) {
  if (S_ISREG(mode)) return {};
  if (S_ISDIR(mode)) return "this is a directory";
  if (S_ISFIFO(mode)) return "this is a pipe, not a regular file";
  if (S_ISSOCK(mode)) return "this is a socket, not a regular file";
  return "this is a device, not a regular file";
}

}  // namespace

Result<InputFile> InputFile::open(const std::string& path, std::string_view remedy) {
  struct stat status{};
  if (stat(path.c_str(), &status) != 0) return error_of(path, text_of(errno), remedy);
  if (const auto kind = kind_of(status.st_mode); !kind.empty()) return error_of(path, kind, remedy);
  // Not blocking, should a pipe have taken its place since.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) return error_of(path, text_of(errno), remedy);
  // Owner of fd from here on. Asked once more: what was
  // opened may be another than what was looked at.
  InputFile file(path, std::string(remedy), fd, 0);
  if (fstat(fd, &status) != 0) return error_of(path, text_of(errno), remedy);
  if (const auto kind = kind_of(status.st_mode); !kind.empty()) return error_of(path, kind, remedy);
  file.size_bytes_ = static_cast<std::uintmax_t>(std::max<off_t>(status.st_size, 0));
  return file;
}

InputFile::~InputFile() {
  if (fd_ >= 0) close(fd_);
}

Result<std::size_t> InputFile::read(void* to, std::size_t bytes) {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t n = ::read(fd_, static_cast<char*>(to) + done, bytes - done);
    if (n == 0) break;
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (errno != EINTR) {
      return error_of(path_, fmt::format("cannot be read to its end ({})", std::strerror(errno)),
                      remedy_);
    }
  }
  return done;
}

Result<std::size_t> InputFile::read_end(void* to, std::size_t bytes) {
  const std::uintmax_t from = size_bytes_ > bytes ? size_bytes_ - bytes : 0;
  if (lseek(fd_, static_cast<off_t>(from), SEEK_SET) < 0)
    return error_of(path_, text_of(errno), remedy_);
  auto got = read(to, bytes);
  if (lseek(fd_, 0, SEEK_SET) < 0) return error_of(path_, text_of(errno), remedy_);
  return got;
}

Result<std::string> read_file(const std::string& path, std::string_view remedy,
                              std::uintmax_t most_bytes) {
  auto file = InputFile::open(path, remedy);
  if (!file) return file.error();
  const auto too_large = [&] {
    return error_of(path, fmt::format("larger than {} bytes", most_bytes), remedy);
  };
  if (file->size_bytes() > most_bytes) return too_large();
  std::string text;
  for (std::size_t end = 0;;) {  // what says no size, or grows, is read to its end too
    // One byte more than is expected: the end is then seen in the same read.
    const std::size_t step = std::max<std::size_t>(kRead_bytes, file->size_bytes() - end + 1);
    text.resize(end + (file->size_bytes() >= end ? step : kRead_bytes));
    const auto read = file->read(text.data() + end, text.size() - end);
    if (!read) return read.error();
    end += *read;
    if (end > most_bytes) return too_large();
    if (end == text.size()) continue;
    text.resize(end);
    return text;
  }
}

}  // namespace tact::model::io
