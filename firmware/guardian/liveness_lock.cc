// SPDX-License-Identifier: Apache-2.0
#include "firmware/guardian/liveness_lock.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace tact::firmware::guardian {
namespace {

/// Maps the page that both processes share.
pthread_mutex_t* map(int fd) {
  void* memory = mmap(nullptr, sizeof(pthread_mutex_t), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<pthread_mutex_t*>(memory);
}

model::Error refused(int fd, int error) {
  if (fd >= 0) close(fd);
  return model::Error{fmt::format("no memory can be shared with the guardian ({}): free some",
                                  std::strerror(error))};
}

}  // namespace

model::Result<LivenessLock> LivenessLock::make() {
  const int fd = memfd_create("tact-liveness", MFD_CLOEXEC);
  if (fd < 0 || ftruncate(fd, sizeof(pthread_mutex_t)) != 0) return refused(fd, errno);
  pthread_mutex_t* mutex = map(fd);
  if (mutex == nullptr) return refused(fd, errno);
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  // Shared between processes; robust: the kernel passes it on when the holder's thread ends
  // (RT-18).
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST);
  const int error = pthread_mutex_init(mutex, &attributes);
  pthread_mutexattr_destroy(&attributes);
  // From here on the destructor closes and unmaps both.
  LivenessLock liveness(fd, mutex);
  if (error != 0) return refused(-1, error);
  return liveness;
}

model::Result<LivenessLock> LivenessLock::take(int fd) {
  pthread_mutex_t* mutex = map(fd);
  if (mutex == nullptr) return refused(fd, errno);
  return LivenessLock(fd, mutex);
}

LivenessLock::LivenessLock(LivenessLock&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), mutex_(std::exchange(other.mutex_, nullptr)) {}

LivenessLock::~LivenessLock() {
  if (mutex_ != nullptr) munmap(mutex_, sizeof(pthread_mutex_t));
  if (fd_ >= 0) close(fd_);
}

void LivenessLock::hold() { pthread_mutex_lock(mutex_); }

void LivenessLock::let_go() { pthread_mutex_unlock(mutex_); }

// The kernel reports the death as EOWNERDEAD; any other error of the lock counts as a death, too.
LivenessLock::End LivenessLock::await() {
  if (pthread_mutex_lock(mutex_) != 0) return End::kDied;
  pthread_mutex_unlock(mutex_);
  return End::kLetGo;
}

}  // namespace tact::firmware::guardian
