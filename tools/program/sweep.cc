// SPDX-License-Identifier: Apache-2.0
#include "tools/program/sweep.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "hal/threads/thread.h"
#include "tools/program/interrupt.h"

namespace tact::tools::program {
namespace {

/// One line that is written over itself, if standard error is a terminal.
class Progress {
 public:
  Progress(std::string label, std::size_t jobs) : label_(std::move(label)), jobs_(jobs) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (is_shown_) fmt::print(stderr, "\r\033[K");
  }

  void show(std::size_t done) const {
    if (!is_shown_) return;
    fmt::print(stderr, "\r\033[K{}: {} of {} ({} %) ", label_, done, jobs_, 100 * done / jobs_);
    if (done > 0) {
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun_;
      fmt::print(stderr, "{:.0f} s, about {:.0f} s left ", took.count(),
                 took.count() * static_cast<double>(jobs_ - done) / static_cast<double>(done));
    }
    std::fflush(stderr);
  }

 private:
  std::string label_;
  std::size_t jobs_;
  bool is_shown_ = isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

unsigned worker_count(std::size_t jobs, const SweepOptions& options) {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted = options.threads > 0 ? options.threads : cores;
  return static_cast<unsigned>(std::min(wanted, jobs));
}

}  // namespace

bool run_jobs(std::size_t jobs, const SweepOptions& options,
              const std::function<void(std::size_t job)>& work) {
  using namespace std::chrono_literals;
  std::atomic<std::size_t> next{0}, done{0};
  const auto worker = [&] {
    while (!is_interrupted()) {
      const std::size_t job = next.fetch_add(1);
      if (job >= jobs) return;
      work(job);
      done.fetch_add(1);
    }
  };
  {
    const Progress progress(options.label, jobs);
    std::vector<hal::threads::Thread> threads;
    for (unsigned i = worker_count(jobs, options); i > 0; --i)
      if (auto thread = hal::threads::start_thread("tact-worker", worker))
        threads.push_back(std::move(*thread));
    if (threads.empty()) worker();
    for (; done.load() < jobs && !is_interrupted(); std::this_thread::sleep_for(50ms))
      progress.show(done.load());
  }  // joined
  return done.load() == jobs;
}

}  // namespace tact::tools::program
