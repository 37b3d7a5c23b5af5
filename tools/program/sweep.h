// SPDX-License-Identifier: Apache-2.0
// sweep.h - many independent jobs on all cores, results in the order of the jobs.
//
// Jobs are numbered 0 .. n-1. A job must not depend on another or on the thread that runs it.
// Progress goes to standard error, and only if that is a terminal.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tact::tools::program {

struct SweepOptions {
  std::string label;     // before the progress
  unsigned threads = 0;  // 0: as many as there are cores
};

/// Calls work(job) once for every job, on threads that are made for this call and end with it.
/// False if Ctrl-C ended it early (interrupt.h).
bool run_jobs(std::size_t jobs, const SweepOptions& options,
              const std::function<void(std::size_t job)>& work);

/// As run_jobs, and keeps what each job returns; empty if Ctrl-C ended it early.
template <typename T>
std::optional<std::vector<T>> sweep(std::size_t jobs, const SweepOptions& options,
                                    const std::function<T(std::size_t job)>& work) {
  std::vector<T> results(jobs);
  const auto keep = [&](std::size_t job) { results[job] = work(job); };
  if (!run_jobs(jobs, options, keep)) return std::nullopt;
  return results;
}

}  // namespace tact::tools::program
