// SPDX-License-Identifier: Apache-2.0
// forked.h - a second process of the test's own, which does one thing and stays until it is killed.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace tact::tests {

class Forked {
 public:
  /// Returns once the child has done it.
  template <typename Does>
  explicit Forked(Does does) {
    int done[2] = {-1, -1};
    if (pipe(done) != 0) std::abort();
    process_ = fork();
    if (process_ == 0) {
      does();
      close(done[1]);
      while (true) pause();
    }
    close(done[1]);
    char none = 0;
    [[maybe_unused]] const auto ended = ::read(done[0], &none, 1);
    close(done[0]);
  }
  Forked(const Forked&) = delete;
  Forked& operator=(const Forked&) = delete;
  ~Forked() { kill_now(); }

  pid_t process() const { return process_; }
  void kill_now() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }

 private:
  pid_t process_ = -1;
};

}  // namespace tact::tests
