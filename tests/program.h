// program.h - runs one of tact's programs and keeps what it printed and how it ended.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

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

/// `arguments` go through the shell.
inline Outcome run_program(const std::string& name, const std::string& arguments) {
  return run_command(std::string(TACT_BINARY_DIR) + "/" + name + " " + arguments);
}

}  // namespace tact::tests
