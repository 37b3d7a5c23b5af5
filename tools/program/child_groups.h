// SPDX-License-Identifier: Apache-2.0
// child_groups.h - the programs that run for us and the folders they write to, known to the signal
// handler that must end them.
//
// A program of run_program.h leads a process group of its own, so a signal from the terminal does
// not reach it. The table is of atomics and fixed in size: a signal handler may read it at any
// time. A group stays in it until its leader is reaped: until then no other process has its number.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <string>

namespace tact::tools::program {

/// While it lives, this thread takes no signal and end_child_groups() waits: between the start of
/// a program and its entry in the table nothing may be missed.
class StartOfChild {
 public:
  StartOfChild();
  ~StartOfChild();
  StartOfChild(const StartOfChild&) = delete;
  StartOfChild& operator=(const StartOfChild&) = delete;

  /// False if the table is full.
  bool remember(pid_t group);
  /// The signals that this thread held back already, for the program to begin with.
  const sigset_t& signals_before() const { return before_; }

 private:
  sigset_t before_{};
};

void forget_child_group(pid_t group);

/// A folder that goes, too, if it still has a place in the table; a longer path has none.
void remember_scratch(const std::string& path);
void forget_scratch(const std::string& path);

/// Kills all of them and removes the folders. Safe in a signal handler.
void end_child_groups();

}  // namespace tact::tools::program
