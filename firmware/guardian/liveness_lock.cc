// SPDX-License-Identifier: Apache-2.0
#include "firmware/guardian/liveness_lock.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "firmware/loop/release_schedule.h"
#include "model/time_ns.h"

namespace tact::firmware::guardian {
namespace {

/// Maps the page that both processes share.
LivenessPage* map(int fd) {
  void* memory = mmap(nullptr, sizeof(LivenessPage), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<LivenessPage*>(memory);
}

/// Halfway between two deadlines of the loop, so that a check falls into no tick (RT-14).
timespec next_check(std::int64_t after_ns, std::int64_t period_ns) {
  timespec at{};
  clock_gettime(CLOCK_MONOTONIC, &at);
  const std::int64_t now_ns = at.tv_sec * model::kSecond_ns + at.tv_nsec;
  const std::int64_t check_ns = loop::next_half_way_ns(now_ns + after_ns, period_ns);
  return {.tv_sec = check_ns / model::kSecond_ns, .tv_nsec = check_ns % model::kSecond_ns};
}

model::Error refused(int fd, int error) {
  if (fd >= 0) close(fd);
  return model::Error{fmt::format("no memory can be shared with the guardian ({}): free some",
                                  std::strerror(error))};
}

}  // namespace

model::Result<LivenessLock> LivenessLock::make() {
  const int fd = memfd_create("tact-liveness", MFD_CLOEXEC);
  if (fd < 0 || ftruncate(fd, sizeof(LivenessPage)) != 0) return refused(fd, errno);
  LivenessPage* page = map(fd);
  if (page == nullptr) return refused(fd, errno);
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  // Shared between processes; robust: the kernel passes it on when the holder's thread ends
  // (RT-18).
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST);
  const int error = pthread_mutex_init(&page->mutex, &attributes);
  pthread_mutexattr_destroy(&attributes);
  // From here on the destructor closes and unmaps both.
  LivenessLock liveness(fd, page);
  if (error != 0) return refused(-1, error);
  return liveness;
}

model::Result<LivenessLock> LivenessLock::take(int fd) {
  LivenessPage* page = map(fd);
  if (page == nullptr) return refused(fd, errno);
  return LivenessLock(fd, page);
}

LivenessLock::LivenessLock(LivenessLock&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), page_(std::exchange(other.page_, nullptr)) {}

LivenessLock::~LivenessLock() {
  if (page_ != nullptr) munmap(page_, sizeof(LivenessPage));
  if (fd_ >= 0) close(fd_);
}

void LivenessLock::hold() { pthread_mutex_lock(&page_->mutex); }

void LivenessLock::let_go() { pthread_mutex_unlock(&page_->mutex); }

// The kernel reports the death as EOWNERDEAD; any other error of the lock counts as a death, too.
LivenessLock::End LivenessLock::await(std::int64_t silence_ns, std::int64_t period_ns) {
  constexpr int kChecks = 2;  // in the time of a silence
  std::uint64_t before = 0;
  for (int same = 0;;) {
    const timespec until = next_check(silence_ns / kChecks, period_ns);
    const int ended = pthread_mutex_clocklock(&page_->mutex, CLOCK_MONOTONIC, &until);
    if (ended == 0) {
      pthread_mutex_unlock(&page_->mutex);
      return End::kLetGo;
    }
    if (ended != ETIMEDOUT) return End::kDied;
    page_->waiter_count.fetch_add(1, std::memory_order_relaxed);
    const std::uint64_t now = page_->holder_count.load(std::memory_order_relaxed);
    same = now == before && now != 0 ? same + 1 : 0;
    before = now;
    if (same >= kChecks) return End::kSilent;
  }
}

}  // namespace tact::firmware::guardian
