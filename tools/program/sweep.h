// SPDX-License-Identifier: Apache-2.0
// sweep.h - many independent jobs on all cores, results in the order of the jobs.
//
// Jobs are numbered 0 .. n-1. A shard i/n of a sweep that is split over machines does the jobs
// whose number leaves the remainder i when divided by n: long and short jobs spread evenly, and no
// machine needs to know of the others. A job must not depend on another or on the thread that runs
// it. Progress goes to standard error, and only if that is a terminal.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/result.h"

namespace tact::tools::program {

struct Shard {
  std::size_t index = 0;  // i, below count
  std::size_t count = 1;  // n

  bool is_whole() const { return count == 1; }
  bool owns(std::size_t job) const { return job % count == index; }
  /// The jobs of this shard, in order: index, index + count, ...
  std::size_t job(std::size_t k) const { return index + k * count; }
  std::size_t jobs_of(std::size_t all) const {
    return all > index ? (all - index - 1) / count + 1 : 0;
  }
};

/// "i/n" with 0 <= i < n.
model::Result<Shard> parse_shard(const std::string& text);

struct SweepOptions {
  std::string label;     // before the progress
  Shard shard{};         // which jobs are ours
  unsigned threads = 0;  // 0: as many as there are cores
};

/// Calls work(job) once for every job of the shard. False if Ctrl-C ended it early (interrupt.h).
bool run_jobs(std::size_t jobs, const SweepOptions& options,
              const std::function<void(std::size_t job)>& work);

/// As run_jobs, until a job returns an error: then no other begins, and the first error is
/// returned; after Ctrl-C it is interruption() of run_program.h.
std::optional<model::Error> run_until_error(
    std::size_t jobs, const SweepOptions& options,
    const std::function<std::optional<model::Error>(std::size_t job)>& work);

/// As run_jobs, and keeps what each job returns; empty if Ctrl-C ended it early.
template <typename T>
std::optional<std::vector<T>> sweep(std::size_t jobs, const SweepOptions& options,
                                    const std::function<T(std::size_t job)>& work) {
  std::vector<T> results(options.shard.jobs_of(jobs));
  const auto keep = [&](std::size_t job) { results[job / options.shard.count] = work(job); };
  if (!run_jobs(jobs, options, keep)) return std::nullopt;
  return results;
}

}  // namespace tact::tools::program
