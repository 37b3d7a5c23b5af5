// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/trace/marker.h"

#include <fcntl.h>
#include <unistd.h>

namespace tact::tools::jitter {

TraceMarker::TraceMarker(const firmware::pc::PcFiles& files, bool stop) {
  for (const char* folder : {"/sys/kernel/tracing/", "/sys/kernel/debug/tracing/"}) {
    if (fd_ >= 0) break;
    const std::string path = files.root() + folder;
    fd_ = open((path + "trace_marker").c_str(), O_WRONLY | O_CLOEXEC);
    if (fd_ >= 0 && stop) stop_fd_ = open((path + "tracing_on").c_str(), O_WRONLY | O_CLOEXEC);
  }
}

TraceMarker::~TraceMarker() {
  for (const int fd : {fd_, stop_fd_})
    if (fd >= 0) close(fd);
}

// A marker that the kernel does not take is missed by its reader alone.
void TraceMarker::write(const std::string& line) {
  if (fd_ < 0) return;
  [[maybe_unused]] ssize_t reported = ::write(fd_, line.data(), line.size());
  if (stop_fd_ < 0) return;
  reported = ::write(stop_fd_, "0", 1);
  close(stop_fd_);
  stop_fd_ = -1;
}

}  // namespace tact::tools::jitter
