// SPDX-License-Identifier: Apache-2.0
#include "tools/report/head.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>

namespace tact::tools::report {

std::string now_utc() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::string host_name() {
  utsname pc{};
  uname(&pc);
  return pc.nodename;
}

}  // namespace tact::tools::report
