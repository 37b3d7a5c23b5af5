// SPDX-License-Identifier: Apache-2.0
// operator_signals.h - the signals that end a running loop: INT, TERM, HUP (a closed terminal),
// QUIT, TSTP and ABRT set the force to zero, then tactd ends. What every other signal does is in
// README.md.
#pragma once

#include <csignal>
#include <cstdint>

namespace tact::firmware::console {

/// First of all in main: no signal that somebody sends by mistake ends or halts a process whose
/// loop pushes. A file that may not grow is an error of its writer. A crash of its own ends it all
/// the same: the kernel lets no process ignore that.
void outlive_stray_signals();

class OperatorSignals {
 public:
  /// Blocks them in this thread and in all that it starts: wait_for_end() takes them.
  OperatorSignals();
  ~OperatorSignals();
  OperatorSignals(const OperatorSignals&) = delete;
  OperatorSignals& operator=(const OperatorSignals&) = delete;

  /// True: a signal asks to end. Waits at most so long for one, or until `other_fd` is readable.
  bool wait_for_end(std::int64_t longest_ns, int other_fd = -1) const;

 private:
  sigset_t signals_{};
  int signal_fd_ = -1;  // readable while one waits; without it they are seen when the time is up
};

}  // namespace tact::firmware::console
