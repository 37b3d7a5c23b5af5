// SPDX-License-Identifier: Apache-2.0
// program.h - runs one of tact's programs: to its end, with what it printed, or beside the test.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace tact::tests {

struct Outcome {
  int status = -1;     // exit status
  std::string output;  // standard output and standard error together
};

/// Any command of the shell.
inline Outcome run_command(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr)
    outcome.output += part.data();
  const int ended = pclose(pipe);
  outcome.status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  return outcome;
}

/// Where one of the PROGRAMS of this room's tact_test lies: no other is built with the test. `name`
/// may go on with a subcommand: "tact-lab chart".
inline std::string program_path(const std::string& name) {
  const std::string built = " " TACT_PROGRAMS " ";
  EXPECT_NE(built.find(" " + name.substr(0, name.find(' ')) + " "), std::string::npos)
      << name << " may be an old one: name it under PROGRAMS in the CMakeLists.txt of this test";
  return TACT_BINARY_DIR "/" + name;
}

/// `arguments` go through the shell.
inline Outcome run_program(const std::string& name, const std::string& arguments) {
  return run_command(program_path(name) + " " + arguments);
}

/// A program that runs beside the test, at most as long as this object lives.
class StartedProgram {
 public:
  StartedProgram(const std::string& name, std::vector<std::string> arguments) {
    const std::string path = program_path(name);
    arguments.insert(arguments.begin(), name);
    std::vector<char*> words;
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    execv(path.c_str(), words.data());
    _exit(127);
  }
  StartedProgram(const StartedProgram&) = delete;
  StartedProgram& operator=(const StartedProgram&) = delete;
  ~StartedProgram() { interrupt(); }

  pid_t process() const { return process_; }
  /// Ctrl-C; waits for the end. The exit status, -1 if a signal ended it.
  int interrupt() {
    if (process_ <= 0) return status_;
    kill(process_, SIGINT);
    int ended = 0;
    waitpid(process_, &ended, 0);
    process_ = -1;
    return status_ = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  }

 private:
  pid_t process_ = -1;
  int status_ = -1;
};

}  // namespace tact::tests
