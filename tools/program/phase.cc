// SPDX-License-Identifier: Apache-2.0
#include "tools/program/phase.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>

namespace tact::tools::program {

Phase::Phase(std::string label, double expected_s)
    : teller_([label = std::move(label), expected_s](const std::stop_token& ends) {
        using namespace std::chrono_literals;
        const bool is_terminal = isatty(STDERR_FILENO) != 0;
        const auto begun = std::chrono::steady_clock::now();
        const auto took_s = [begun] {
          return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        };
        std::mutex mutex;
        std::condition_variable_any ended;
        std::unique_lock lock(mutex);
        if (!is_terminal) fmt::print(stderr, "{}: about {:.0f} s\n", label, expected_s);
        do
          if (is_terminal)
            fmt::print(stderr, "\r\033[K{}: {:.0f} s of about {:.0f} s ", label, took_s(),
                       expected_s);
        while (!ended.wait_for(lock, ends, 500ms, [&ends] { return ends.stop_requested(); }));
        fmt::print(stderr, "{}{}: {:.0f} s\n", is_terminal ? "\r\033[K" : "", label, took_s());
      }) {}

}  // namespace tact::tools::program
