// SPDX-License-Identifier: Apache-2.0
#include "tools/program/memory_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tact::tools::program {
namespace {

model::Error error_of(int number) {
  return {fmt::format("no file in memory: {}; free some memory, or close programs",
                      std::strerror(number))};
}

}  // namespace

model::Result<MemoryFile> MemoryFile::make() {
  // Open in the programs that we start: they find it under the same number.
  const int fd = memfd_create("tact", 0);
  if (fd < 0) return error_of(errno);
  return MemoryFile(fd);
}

MemoryFile::~MemoryFile() {
  if (fd_ >= 0) close(fd_);
}

std::string MemoryFile::path() const { return fmt::format("/proc/self/fd/{}", fd_); }

std::optional<model::Error> MemoryFile::put(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t n = write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return error_of(n == 0 ? EIO : errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return std::nullopt;
}

}  // namespace tact::tools::program
