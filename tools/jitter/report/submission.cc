// SPDX-License-Identifier: Apache-2.0
// A measurement as a row of tools/deploy/PCS.md.
#include <fmt/format.h>

#include <algorithm>

#include "tools/jitter/report/jitter_report.h"

namespace tact::tools::jitter {
namespace {

/// A text from outside stays in its cell.
std::string cell(std::string text) {
  std::ranges::replace_if(text, [](unsigned char c) { return c == '|' || c < ' '; }, '/');
  return text;
}

std::string settings_of(const JitterResult& result) {
  return fmt::format(
      "{}, {:g} Hz, core {}, FIFO {}, {}{}{}", result.subject.substr(0, result.subject.find(',')),
      result.rate_Hz, result.core, result.priority,
      result.load.empty() ? "idle" : "load " + result.load,
      result.environment.boot_parameters.find("isolcpus=") == std::string::npos ? ""
                                                                                : ", isolated core",
      result.non_rt ? ", non-rt" : "");
}

std::string beginning_of(const std::string& cpu) { return fmt::format("| {}, ", cell(cpu)); }

}  // namespace

std::string submission_beginning() { return beginning_of(firmware::pc::read_environment("").cpu); }

std::string make_submission(const JitterResult& result) {
  const auto& pc = result.environment;
  const auto& wake = result.sink->phase(firmware::loop::Phase::kWake).histogram;
  const auto& force = result.sink->deadline_to_force().histogram;
  return fmt::format(
      "{}{} | {}{} | {} | {} | {} | {} | {:.6g} |\n", beginning_of(pc.cpu), pc.cores,
      cell(pc.kernel_release), pc.realtime_kernel ? ", PREEMPT_RT" : "", cell(settings_of(result)),
      in_us(percentile_ns(wake, 0.999)), in_us(percentile_ns(force, 0.999)),
      in_us(std::max<std::uint64_t>(wake.max_ns(), force.max_ns())), result.measured_s);
}

}  // namespace tact::tools::jitter
