// SPDX-License-Identifier: Apache-2.0
#include "model/io/program/program_end.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

namespace tact::model::io {
namespace {

constexpr int kBadOutput = 2;
std::array<char, 32> program_name{};  // read after main(), by value: no destructor changes it

void keep_name(const char* program) {
  std::snprintf(program_name.data(), program_name.size(), "%s", program);
}

/// A full disk shows when the last bytes leave, after main().
void check_standard_output() {
  // A write that failed before has set the mark; errno may be of something else by now.
  const bool failed_before = std::ferror(stdout) != 0;
  if (std::fflush(stdout) == 0 && !failed_before) return;
  std::fprintf(stderr, "%s: standard output cannot be written: %s; check where it goes\n",
               program_name.data(), failed_before && errno == 0 ? "error" : std::strerror(errno));
  std::fflush(nullptr);
  // exit() is running already, and may not be called again.
  _exit(kBadOutput);
}

/// std::terminate by itself would leave a core dump, and words of the library's.
[[noreturn]] void report_and_end() {
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program_name.data(), error.what());
    _exit(kBadOutput);
  } catch (...) {
    std::fprintf(stderr, "%s: an unknown exception\n", program_name.data());
    _exit(kBadOutput);
  }
  _exit(kBadOutput);  // std::terminate without an exception
}

}  // namespace

void watch_standard_output(const char* program) {
  keep_name(program);
  std::atexit(check_standard_output);
}

void report_uncaught(const char* program) {
  keep_name(program);
  std::set_terminate(report_and_end);
}

}  // namespace tact::model::io
