// SPDX-License-Identifier: Apache-2.0
// tact-rig-lines - what is wired to the safety lines of the kernel's simulated chip (gpio-sim).
//
//     tact-rig-lines press PULL --grid-ns T --phase-us N    opens a contact, N after a deadline
//     tact-rig-lines copy VALUE PULL                        a wire from an output to an input
//
// PULL is the file `pull` of an input line, VALUE the file `value` of an output line, both in sysfs
// (Documentation/admin-guide/gpio/gpio-sim.rst). Both run above the controller's loop, as a finger
// and a wire do: on a machine of one core their own instructions make the loop's way longer.
#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tests/rig/emulators/run/real_time.h"

namespace {

using namespace tact::rig;

constexpr const char* kProgram = "tact-rig-lines";
constexpr std::int64_t kUs = 1'000, kMs = 1'000'000;
constexpr std::string_view kUp = "pull-up", kDown = "pull-down";

struct Options {
  std::string value, pull;
  std::int64_t grid_ns = 0;
  int priority = 90, phase_us = 0, period_us = 20;
};

int refuse(const std::string& message) {
  std::fprintf(stderr, "%s: %s\n", kProgram, message.c_str());
  return 2;
}

void sleep_until(std::int64_t time_ns) {
  while (!stop_asked() && monotonic_ns() < time_ns) wait_readable(-1, time_ns);
}

bool set(int fd, std::string_view level) {
  return pwrite(fd, level.data(), level.size(), 0) == static_cast<ssize_t>(level.size());
}

/// The edge lies between the two times: the earlier one makes no delay look shorter than it is.
int press(int pull, std::int64_t phase_ns) {
  sleep_until((monotonic_ns() / kMs + 2) * kMs + phase_ns);
  if (stop_asked()) return refuse("stopped before the contact opened; it is as it was");
  const std::int64_t before_ns = monotonic_ns();
  if (!set(pull, kDown)) return refuse("the line cannot be pulled down");
  const std::int64_t after_ns = monotonic_ns();
  leave_real_time();
  std::puts(nlohmann::json{{"before_ns", before_ns}, {"after_ns", after_ns}}.dump().c_str());
  return 0;
}

/// How late the copy of an edge may be: since the start of the last look that did not see it.
int copy(int value, int pull, std::int64_t period_ns) {
  std::vector<std::int64_t> latency_ns;
  latency_ns.reserve(1'000'000);
  char level = '?';
  std::int64_t looked_ns = monotonic_ns();
  std::fprintf(stderr, "%s: ready\n", kProgram);
  while (!stop_asked()) {
    const std::int64_t now_ns = monotonic_ns();
    char seen = level;
    if (pread(value, &seen, 1, 0) == 1 && seen != level) {
      if (!set(pull, seen == '1' ? kUp : kDown)) return refuse("the line cannot be pulled");
      const bool first = level == '?';
      level = seen;
      if (!first && latency_ns.size() < latency_ns.capacity())
        latency_ns.push_back(monotonic_ns() - looked_ns);
    }
    looked_ns = now_ns;
    wait_readable(-1, now_ns + period_ns);
  }
  leave_real_time();
  const auto longest = std::max_element(latency_ns.begin(), latency_ns.end());
  std::puts(nlohmann::json{{"edges", latency_ns.size()},
                           {"latency_max_ns", latency_ns.empty() ? 0 : *longest}}
                .dump()
                .c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What is wired to the safety lines of a simulated GPIO chip", kProgram);
  Options options;
  app.require_subcommand(1);
  app.add_option("--priority", options.priority, "SCHED_FIFO priority; 0: as it is")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  CLI::App* presses = app.add_subcommand("press", "open a contact once, and report when");
  presses->add_option("PULL", options.pull, "file `pull` of the input line")->required();
  presses->add_option("--grid-ns", options.grid_ns, "a deadline of the loop, CLOCK_MONOTONIC")
      ->check(CLI::NonNegativeNumber);
  presses->add_option("--phase-us", options.phase_us, "of a deadline's millisecond")
      ->check(CLI::Range(0, 999));
  CLI::App* copies = app.add_subcommand("copy", "an output line's level to an input line");
  copies->add_option("VALUE", options.value, "file `value` of the output line")->required();
  copies->add_option("PULL", options.pull, "file `pull` of the input line")->required();
  copies->add_option("--period-us", options.period_us, "from look to look")
      ->check(CLI::Range(5, 1000))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  const int pull = open(options.pull.c_str(), O_WRONLY | O_CLOEXEC);
  if (pull < 0) return refuse(options.pull + " cannot be written: name the line's file `pull`");
  const int value = copies->parsed() ? open(options.value.c_str(), O_RDONLY | O_CLOEXEC) : -1;
  if (copies->parsed() && value < 0)
    return refuse(options.value + " cannot be read: name the line's file `value`");
  std::string error;
  if (!enter_real_time(options.priority, error)) return refuse(error);
  catch_stop_signals();
  return presses->parsed() ? press(pull, (options.grid_ns + kUs * options.phase_us) % kMs)
                           : copy(value, pull, kUs * options.period_us);
}
