// SPDX-License-Identifier: Apache-2.0
#include "model/io/file_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

#include "model/io/input_file.h"
#include "model/io/one_line.h"

namespace tact::model::io {
namespace {

// Chosen: one call for many ticks; what identifies a format fits into 16 bytes.
constexpr std::size_t kBuffer_bytes = 1 << 16, kBeginning_bytes = 16;
// Of one process in one folder at a time.
constexpr int kMaxParts = 100;
constexpr mode_t kNewMode = 0666;  // less the umask

Error error_of(const std::string& path, std::string_view what) {
  return {fmt::format("{}: {}", path, what)};
}

Error cannot_write(const std::string& path, int number) {
  return error_of(path, fmt::format("cannot be written: {}; check the folder, who may write there "
                                    "and the free space",
                                    std::strerror(number)));
}

Error cannot_add(const std::string& path, int number) {
  if (number != EEXIST) return cannot_write(path, number);
  return error_of(path, "exists already and is never overwritten; choose another name");
}

/// By what a file of ours is known: see the header.
std::string_view first_word(std::string_view text) {
  if (text.starts_with('{')) return text.substr(0, 1);
  const auto ends = [](char c) { return is_control(c) || c == ',' || c == ':'; };
  const auto end = std::find_if(text.begin(), text.end(), ends);
  const auto size = static_cast<std::size_t>(end - text.begin());
  return text.substr(0, std::min(size, kBeginning_bytes));
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// Where the bytes go.
struct Target {
  std::string path;  // with links followed
  mode_t mode = kNewMode;
  bool exists = false;
  bool straight = false;  // a pipe or a character device
};

/// Nothing is opened for writing yet: what must not be replaced is refused before anything changes.
Result<Target> target_of(const std::string& path, std::string_view beginning) {
  Target target{.path = path};
  struct stat status{};
  // Nothing there: the folder must take a new file. A link
  // that leads nowhere is there, and is refused below.
  if (lstat(path.c_str(), &status) != 0) {
    if (errno != ENOENT || path.empty()) return cannot_write(path, errno);
    if (access(folder_of(path).c_str(), W_OK | X_OK) != 0) return cannot_write(path, errno);
    return target;
  }
  char real[PATH_MAX];
  if (stat(path.c_str(), &status) != 0 || realpath(path.c_str(), real) == nullptr) {
    // A link to a pipe of /proc has no path: it is opened by the link's own.
    if (errno != ENOENT || stat(path.c_str(), &status) != 0) return cannot_write(path, errno);
  } else {
    target.path = real;
  }
  target.exists = true;
  target.mode = status.st_mode & 07777;
  target.straight = S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode);
  if (target.straight) return target;
  if (S_ISDIR(status.st_mode)) return error_of(path, "this is a directory; name a file");
  if (!S_ISREG(status.st_mode))
    return error_of(path, "is no regular file, pipe or terminal; name another");
  if (access(target.path.c_str(), W_OK) != 0 ||
      access(folder_of(target.path).c_str(), W_OK | X_OK) != 0)
    return cannot_write(path, errno);
  // What mktemp or touch made for the result.
  if (status.st_size == 0) return target;
  auto file = InputFile::open(target.path, "name another file to write");
  if (!file) return file.error();
  char head[kBeginning_bytes];
  const auto read = file->read(head, sizeof head);
  if (!read) return read.error();
  if (first_word({head, *read}) == first_word(beginning)) return target;
  return error_of(path,
                  "holds something else than what would be written, and is kept; name another "
                  "file, or remove this one");
}

/// A temporary file of this process alone, in the folder of the target.
Result<std::pair<std::string, int>> open_part(const std::string& path, const Target& target) {
  for (int n = 0; n < kMaxParts; ++n) {
    // In the same folder: only then a rename is one step. O_EXCL and O_NOFOLLOW: neither another's
    // file nor a link that another user placed there.
    std::string part = fmt::format("{}.{}-{}.part", target.path, getpid(), n);
    const int fd =
        open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, kNewMode);
    if (fd >= 0) {
      if (target.exists) fchmod(fd, target.mode);  // as the one that it replaces
      return std::pair{std::move(part), fd};
    }
    if (errno != EEXIST) break;
  }
  return cannot_write(path, errno);
}

Result<int> open_straight(const std::string& path, const Target& target) {
  // Not blocking: open() would wait for a reader of a pipe.
  const int fd = open(target.path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (fd < 0 && errno == ENXIO)
    return error_of(path, "this pipe has no reader; start its reader first");
  if (fd < 0 || fcntl(fd, F_SETFL, O_WRONLY) != 0) return cannot_write(path, errno);
  return fd;
}

}  // namespace

Result<FileWriter> FileWriter::create(const std::string& path) {
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewMode);
  if (fd >= 0) return FileWriter(path, path, {}, fd);
  return cannot_add(path, errno);
}

Result<FileWriter> FileWriter::replace(const std::string& path, std::string_view beginning) {
  auto target = target_of(path, beginning);
  if (!target) return target.error();
  if (target->straight) {
    const auto fd = open_straight(path, *target);
    if (!fd) return fd.error();
    return FileWriter(path, {}, {}, *fd);
  }
  auto part = open_part(path, *target);
  if (!part) return part.error();
  return FileWriter(path, std::move(target->path), std::move(part->first), part->second);
}

FileWriter& FileWriter::operator=(FileWriter&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(target_, other.target_);
  std::swap(part_, other.part_);
  std::swap(waiting_, other.waiting_);
  std::swap(fd_, other.fd_);
  return *this;
}

FileWriter::~FileWriter() {
  // What grows keeps all that was put; what replaces was not finished, so it never was. Who
  // wants to hear of an error has called finish().
  if (fd_ >= 0 && part_.empty()) static_cast<void>(flush());
  if (fd_ >= 0) close(fd_);
  if (!part_.empty()) unlink(part_.c_str());
}

std::optional<Error> FileWriter::fail(int number) {
  waiting_.clear();
  if (fd_ >= 0) close(std::exchange(fd_, -1));
  if (!part_.empty()) unlink(std::exchange(part_, {}).c_str());
  return cannot_write(path_, number);
}

std::optional<Error> FileWriter::put(std::string_view bytes) {
  waiting_ += bytes;
  return waiting_.size() < kBuffer_bytes ? std::nullopt : flush();
}

std::optional<Error> FileWriter::flush() {
  if (fd_ < 0) return fail(EBADF);
  std::size_t done = 0;
  while (done < waiting_.size()) {
    const ssize_t n = ::write(fd_, waiting_.data() + done, waiting_.size() - done);
    if (n > 0)
      done += static_cast<std::size_t>(n);
    else if (n == 0 || errno != EINTR)
      return fail(n == 0 ? EIO : errno);
  }
  waiting_.clear();
  return std::nullopt;
}

std::optional<Error> FileWriter::finish() {
  if (auto error = flush()) return error;
  const bool is_file = !target_.empty();
  // The bytes before the name: after a crash the name leads to all of them, or to the older file.
  if (is_file && fsync(fd_) != 0) return fail(errno);
  if (close(std::exchange(fd_, -1)) != 0) return fail(errno);
  if (!is_file) return std::nullopt;
  if (!part_.empty()) {
    if (rename(part_.c_str(), target_.c_str()) != 0) return fail(errno);
    part_.clear();
  }
  const int folder = open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return std::nullopt;  // a folder that cannot be listed; the file itself is there
  // The name itself is on the disk only now.
  fsync(folder);
  close(folder);
  return std::nullopt;
}

std::optional<Error> write_file(const std::string& path, std::string_view content) {
  auto file = FileWriter::replace(path, content);
  if (!file) return file.error();
  if (auto error = file->put(content)) return error;
  return file->finish();
}

std::optional<Error> check_target(const std::string& path, std::string_view beginning) {
  const auto target = target_of(path, beginning);
  return target ? std::nullopt : std::optional(target.error());
}

}  // namespace tact::model::io
