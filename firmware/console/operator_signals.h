// SPDX-License-Identifier: Apache-2.0
// operator_signals.h - the signals that end a running loop: INT, TERM, HUP (a closed terminal),
// QUIT, TSTP and ABRT set the force to zero, then tactd ends. README.md lists all other signals.
#pragma once

#include <csignal>
#include <cstdint>

namespace tact::firmware::console {

/// Call first in main: ignores signals that would otherwise end or halt the process while the loop
/// renders force. A write beyond the file size limit becomes an error (XFSZ). A crash still ends
/// the process, because the kernel does not let it ignore that signal.
void ignore_other_signals();

class OperatorSignals {
 public:
  /// Blocks these signals in this thread and in all that it starts; wait_for_end() takes them.
  OperatorSignals();
  ~OperatorSignals();
  OperatorSignals(const OperatorSignals&) = delete;
  OperatorSignals& operator=(const OperatorSignals&) = delete;

  /// True: a signal asks to end. Waits at most `longest_ns`, or until `other_fd` is readable.
  bool wait_for_end(std::int64_t longest_ns, int other_fd = -1) const;

 private:
  sigset_t signals_{};
  int signal_fd_ = -1;  // wakes the wait; without it a signal is taken at the timeout
};

}  // namespace tact::firmware::console
