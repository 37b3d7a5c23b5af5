// SPDX-License-Identifier: Apache-2.0
// Status bytes leave a transfer, data stays in its order, and nothing is written beyond its end.
#include <vector>

#include "hal/falcon/ftdi_requests.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* input, std::size_t size) {
  using namespace tact;
  using fuzz::require;
  if (size == 0) return 0;
  const fuzz::Bytes transfer(input + 1, size - 1);
  std::vector<std::uint8_t> data(input[0]);  // often too small
  const auto read = hal::falcon::ftdi_strip(transfer, data);
  if (!read) return 0;
  require(read->size <= data.size());
  std::vector<std::uint8_t> expected;
  for (std::size_t at = 0; at < transfer.size(); ++at)
    if (at % hal::falcon::kFtdiPacketSize >= hal::falcon::kFtdiStatusSize)
      expected.push_back(transfer[at]);
  require(read->size == expected.size());
  require(std::equal(expected.begin(), expected.end(), data.begin()));

  std::vector<std::uint8_t> same(transfer.begin(), transfer.end());  // in its own place
  const auto again = hal::falcon::ftdi_strip(same, same);
  require(again && again->size == expected.size());
  require(std::equal(expected.begin(), expected.end(), same.begin()));
  return 0;
}
