// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/real_device/consent.h"

#include <fmt/format.h>

namespace tact::tools::limits {

std::string warning_text(const std::string& device_name, double force_limit_N, bool has_lines) {
  return fmt::format(
      "WARNING: {} will push with up to {:g} N, by itself, in jumps and to and fro at 200 Hz.\n"
      "One person holds the handle firmly in the middle of the workspace, all others keep away.\n"
      "{}\n"
      "It pushes from the moment it is armed; Ctrl-C ends it with zero force.\n",
      device_name, force_limit_N,
      has_lines ? "A second hand stays on the emergency stop."
                : "The scene wires no emergency stop: a second hand stays on the power switch.");
}

std::string consent_text(double force_limit_N) {
  return fmt::format("I hold the device and allow {:g} N", force_limit_N);
}

std::optional<model::Error> read_consent(std::istream& in, double force_limit_N) {
  std::string line;
  std::getline(in, line);
  if (line == consent_text(force_limit_N)) return std::nullopt;
  return model::Error{"not agreed to: nothing moved; type the words exactly as they are shown"};
}

}  // namespace tact::tools::limits
