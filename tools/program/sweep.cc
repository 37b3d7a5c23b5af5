// SPDX-License-Identifier: Apache-2.0
#include "tools/program/sweep.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>

#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"

namespace tact::tools::program {
namespace {

bool parse_number(const std::string& text, std::size_t& number) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && rest == end;
}

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

model::Result<Shard> parse_shard(const std::string& text) {
  const auto slash = text.find('/');
  Shard shard;
  const bool good = slash != std::string::npos &&
                    parse_number(text.substr(0, slash), shard.index) &&
                    parse_number(text.substr(slash + 1), shard.count);
  if (good && shard.index < shard.count) return shard;
  return model::Error{fmt::format(
      "shard \"{}\" is not i/n with 0 <= i < n; split in four, the shards are 0/4, 1/4, 2/4, 3/4",
      text)};
}

bool run_jobs(std::size_t jobs, const SweepOptions& options,
              const std::function<void(std::size_t job)>& work) {
  const std::size_t mine = options.shard.jobs_of(jobs);
  std::atomic<std::size_t> next{0}, done{0};
  const auto worker = [&] {
    while (!is_interrupted()) {
      const std::size_t k = next.fetch_add(1);
      if (k >= mine) return;
      work(options.shard.job(k));
      done.fetch_add(1);
    }
  };
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted = options.threads > 0 ? options.threads : cores;
  {
    std::vector<std::jthread> threads;
    threads.reserve(std::min(wanted, mine));
    for (std::size_t i = 0; i < std::min(wanted, mine); ++i) threads.emplace_back(worker);
    show_progress(options.label, done, mine);
  }  // joined
  return done.load() == mine;
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
