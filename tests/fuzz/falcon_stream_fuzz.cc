// SPDX-License-Identifier: Apache-2.0
// From any bytes, cut anywhere, come exactly the reports that stand in them whole.
#include <vector>

#include "hal/falcon/falcon_packets.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace tact;
using fuzz::require;

/// The same by looking at every place: slower, and without a memory.
std::vector<hal::falcon::FalconReport> whole_reports(fuzz::Bytes bytes) {
  std::vector<hal::falcon::FalconReport> found;
  for (std::size_t at = 0; at + hal::falcon::kFalconPacketSize <= bytes.size(); ++at)
    if (const auto report =
            hal::falcon::decode_falcon_report(bytes.subspan(at, hal::falcon::kFalconPacketSize)))
      found.push_back(*report);
  return found;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::Bytes input(data, size);
  hal::falcon::FalconStream stream;
  std::vector<hal::falcon::FalconReport> reports;
  for (const std::uint8_t byte : input)
    if (const auto report = stream.push(byte)) reports.push_back(*report);
  require(reports == whole_reports(input));
  require(stream.reports() == reports.size());
  require(size == hal::falcon::kFalconPacketSize * reports.size() + stream.dropped_bytes() +
                      stream.waiting_bytes());
  for (const hal::falcon::FalconReport& report : reports)
    require(hal::falcon::decode_falcon_report(hal::falcon::encode(report)) == report);
  return 0;
}
