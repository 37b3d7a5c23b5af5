// SPDX-License-Identifier: Apache-2.0
// interrupt.h - Ctrl-C as a question that long work asks between its steps.
#pragma once

#include <array>
#include <csignal>

namespace tact::tools::program {

/// While it lives, the first Ctrl-C, SIGTERM or closed terminal is remembered. A second Ctrl-C or
/// SIGTERM ends the program at once, with status 130 or 143, and what runs for it (run_program.h).
class InterruptFlag {
 public:
  InterruptFlag();
  ~InterruptFlag();
  InterruptFlag(const InterruptFlag&) = delete;
  InterruptFlag& operator=(const InterruptFlag&) = delete;

 private:
  std::array<struct sigaction, 4> before_{};
};

/// True once Ctrl-C was pressed under a watch that still lives.
bool is_interrupted();

}  // namespace tact::tools::program
