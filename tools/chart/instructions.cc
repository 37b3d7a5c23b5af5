#include "tools/chart/instructions.h"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tact::tools {

InstructionCounter::InstructionCounter() {
  perf_event_attr wanted{};
  wanted.type = PERF_TYPE_HARDWARE;
  wanted.size = sizeof(wanted);
  wanted.config = PERF_COUNT_HW_INSTRUCTIONS;
  wanted.exclude_kernel = 1;
  wanted.exclude_hv = 1;
  constexpr int kThisThread = 0, kAnyCore = -1, kNoGroup = -1;
  file_ =
      static_cast<int>(syscall(SYS_perf_event_open, &wanted, kThisThread, kAnyCore, kNoGroup, 0));
}

InstructionCounter::~InstructionCounter() {
  if (file_ >= 0) close(file_);
}

std::uint64_t InstructionCounter::read() const {
  std::uint64_t count = 0;
  const bool whole = file_ >= 0 && ::read(file_, &count, sizeof(count)) == sizeof(count);
  return whole ? count : 0;
}

}  // namespace tact::tools
