// SPDX-License-Identifier: Apache-2.0
// run_program.h - runs another program without a shell: no quoting, a time limit, Ctrl-C ends it
// too.
//
// The program's standard output and standard error go to one file, which stays when it fails. It
// reads nothing. It is a process group of its own, and the whole group is killed when its leader
// has ended. At its time limit, at Ctrl-C, SIGTERM or a closed terminal (interrupt.h) it is asked
// to end first, by SIGTERM, and has 3 s for what it has started and written itself. A second
// Ctrl-C kills it at once and removes the scratch folders; a SIGKILL of ours leaves both: the
// program goes on to its own end, without a time limit.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/result.h"

namespace tact::tools::program {

struct ProgramCall {
  std::string program;  // looked for in PATH
  std::vector<std::string> arguments;
  std::string directory;      // where it runs
  std::string log_path;       // absolute, of everything it prints
  std::string package;        // the Debian package that has it, for the message when it is missing
  double time_limit_s = 0.0;  // 0: none
  std::function<void(std::string_view)> on_line{};  // each line that it prints, as it comes
};

/// What the program printed, if it ended with status 0. Otherwise a message: not installed (and
/// what to install), interrupted, over its time, or its last lines and where all of them are.
model::Result<std::string> run_program(const ProgramCall& call);

/// A program that runs beside us until its object goes: then its whole group is killed. A time
/// limit and the status do not count here.
class RunningProgram {
 public:
  /// An error says what to install.
  static model::Result<RunningProgram> start(const ProgramCall& call);
  RunningProgram(RunningProgram&& other) noexcept : child_(std::exchange(other.child_, -1)) {}
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  RunningProgram& operator=(RunningProgram&&) = delete;
  ~RunningProgram();

  /// False once it has ended by itself.
  bool is_running() const;

 private:
  explicit RunningProgram(int child) : child_(child) {}
  int child_ = -1;  // leads its group
};

/// The error of a Ctrl-C, which is no failure of the program.
model::Error interruption();
inline bool was_interrupted(const model::Error& error) {
  return error.code == model::ErrorCode::kInterrupted;
}

/// A new empty folder below the system's temporary one, gone when this object is.
class ScratchFolder {
 public:
  static model::Result<ScratchFolder> make(const std::string& name);
  ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace tact::tools::program
