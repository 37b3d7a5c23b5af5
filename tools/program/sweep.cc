// SPDX-License-Identifier: Apache-2.0
#include "tools/program/sweep.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>

#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"

namespace tact::tools::program {
namespace {

/// One line that is written over itself, a few times a second.
void show_progress(const std::string& label, const std::atomic<std::size_t>& done,
                   std::size_t all) {
  using namespace std::chrono_literals;
  if (isatty(STDERR_FILENO) == 0) return;
  const auto begun = std::chrono::steady_clock::now();
  while (done.load() < all && !is_interrupted()) {
    const std::size_t now = done.load();
    fmt::print(stderr, "\r\033[K{}: {} of {} ({} %) ", label, now, all, 100 * now / all);
    if (now > 0) {
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
      fmt::print(stderr, "about {:.0f} s left ",
                 took.count() * static_cast<double>(all - now) / static_cast<double>(now));
    }
    std::fflush(stderr);
    std::this_thread::sleep_for(200ms);
  }
  fmt::print(stderr, "\r\033[K");
}

}  // namespace

bool run_jobs(std::size_t jobs, const SweepOptions& options,
              const std::function<void(std::size_t job)>& work) {
  std::atomic<std::size_t> next{0}, done{0};
  const auto worker = [&] {
    while (!is_interrupted()) {
      const std::size_t job = next.fetch_add(1);
      if (job >= jobs) return;
      work(job);
      done.fetch_add(1);
    }
  };
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted = options.threads > 0 ? options.threads : cores;
  {
    std::vector<std::jthread> threads;
    threads.reserve(std::min(wanted, jobs));
    for (std::size_t i = 0; i < std::min(wanted, jobs); ++i) threads.emplace_back(worker);
    show_progress(options.label, done, jobs);
  }  // joined
  return done.load() == jobs;
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
