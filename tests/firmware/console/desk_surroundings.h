// SPDX-License-Identifier: Apache-2.0
// desk_surroundings.h - what an operator's desk looks at: signals, requests to a loop, its state.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware/console/operator_desk.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware::console {

class DeskSurroundings : public testing::Test {
 protected:
  loop::SimulatedClock clock;
  PuppetDevice device{clock};
  PuppetLines lines;
  loop::Requests requests;
  std::vector<std::string> edges;  // what the loop saw rise
  OperatorSignals signals{[this] {
    if (requests.arm.load()) edges.emplace_back("arm");
    if (requests.reset.load()) edges.emplace_back("reset");
    if (requests.disarm.load()) edges.emplace_back("disarm");
  }};
  OperatorView view{device, lines, false};
  telemetry::Frame frame;
};

}  // namespace tact::firmware::console
