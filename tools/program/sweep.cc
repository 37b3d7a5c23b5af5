// SPDX-License-Identifier: Apache-2.0
#include "tools/program/sweep.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"

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

/// What the workers share with the process that began them.
struct Board {
  std::atomic<std::size_t> next{0}, done{0};
};

/// Memory that stays one after fork.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t bytes)
      : bytes_(bytes),
        at_(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {}
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory() {
    if (at_ != MAP_FAILED) munmap(at_, bytes_);
  }
  void* get() const { return at_ == MAP_FAILED ? nullptr : at_; }

 private:
  std::size_t bytes_;
  void* at_;
};

/// Waits for all, and shows how far they are. After Ctrl-C, or when one did not end well, it ends
/// the others: then it is false.
bool wait_for(std::vector<pid_t> workers, const Progress& progress, const Board& board) {
  using namespace std::chrono_literals;
  bool good = true;
  while (!workers.empty()) {
    if (!good || is_interrupted())
      for (const pid_t worker : workers) kill(worker, SIGKILL);
    std::erase_if(workers, [&](pid_t worker) {
      int status = 0;
      if (waitpid(worker, &status, WNOHANG) == 0) return false;
      good &= status == 0;
      return true;
    });
    progress.show(board.done.load());
    std::this_thread::sleep_for(50ms);
  }
  return good;
}

}  // namespace

bool run_jobs(std::size_t jobs, const SweepOptions& options,
              const std::function<void(std::size_t job)>& work) {
  using namespace std::chrono_literals;
  Board board;
  const auto worker = [&] {
    while (!is_interrupted()) {
      const std::size_t job = board.next.fetch_add(1);
      if (job >= jobs) return;
      work(job);
      board.done.fetch_add(1);
    }
  };
  {
    const Progress progress(options.label, jobs);
    std::vector<std::jthread> threads;
    for (unsigned i = worker_count(jobs, options); i > 0; --i) threads.emplace_back(worker);
    for (; board.done.load() < jobs && !is_interrupted(); std::this_thread::sleep_for(50ms))
      progress.show(board.done.load());
  }  // joined
  return board.done.load() == jobs;
}

std::optional<model::Error> run_in_processes(
    std::size_t jobs, std::span<float> results, const SweepOptions& options,
    const std::function<void(std::size_t job, std::span<float> result)>& work) {
  if (jobs == 0) return std::nullopt;
  const SharedMemory memory(results.size_bytes()), board_memory(sizeof(Board));
  if (memory.get() == nullptr || board_memory.get() == nullptr)
    return model::Error{"no memory for the results of the workers; close programs"};
  const std::span<float> shared(static_cast<float*>(memory.get()), results.size());
  Board& board = *new (board_memory.get()) Board;
  const std::size_t each = results.size() / jobs;
  const pid_t parent = getpid();
  const auto worker = [&] {
    for (;;) {
      const std::size_t job = board.next.fetch_add(1);
      if (job >= jobs) return;
      work(job, shared.subspan(job * each, each));
      board.done.fetch_add(1);
    }
  };
  std::vector<pid_t> workers;
  for (unsigned i = worker_count(jobs, options); i > 0; --i) {
    const pid_t child = fork();
    if (child == 0) {
      // Ctrl-C is for the parent, which ends its workers; none of them outlives it.
      for (const int signal : {SIGINT, SIGQUIT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() == parent) worker();
      _exit(0);
    }
    if (child > 0) workers.push_back(child);
  }
  if (workers.empty()) return model::Error{"no process can be started; close programs"};
  const Progress progress(options.label, jobs);
  const bool good = wait_for(std::move(workers), progress, board);
  if (is_interrupted()) return interruption();
  if (!good || board.done.load() != jobs)
    return model::Error{"a worker ended early: perhaps no memory was left; use fewer cores"};
  std::copy(shared.begin(), shared.end(), results.begin());
  return std::nullopt;
}

std::optional<model::Error> run_until_error(
    std::size_t jobs, const SweepOptions& options,
    const std::function<std::optional<model::Error>(std::size_t job)>& work) {
  std::mutex mutex;
  std::optional<model::Error> first_error;
  const auto work_or_leave = [&](std::size_t job) {
    {
      const std::lock_guard lock(mutex);
      if (first_error) return;
    }
    // Without the lock: a job may take minutes.
    auto error = work(job);
    const std::lock_guard lock(mutex);
    if (!first_error) first_error = std::move(error);
  };
  const bool whole = run_jobs(jobs, options, work_or_leave);
  if (first_error) return first_error;
  if (!whole) return interruption();
  return std::nullopt;
}

}  // namespace tact::tools::program
