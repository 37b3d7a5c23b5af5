// instructions.h - how many instructions this thread has executed, where Linux lets us count them.
//
// Needs a processor with a counter (virtual machines often hide it) and
// kernel.perf_event_paranoid <= 2. Kernel instructions are not counted.
#pragma once

#include <cstdint>

namespace tact::tools {

class InstructionCounter {
 public:
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  bool is_available() const { return file_ >= 0; }
  /// Since the counter was made; 0 where not available.
  std::uint64_t read() const;

 private:
  int file_ = -1;
};

}  // namespace tact::tools
