// SPDX-License-Identifier: Apache-2.0
// desk_surroundings.h - what an operator's desk looks at: signals, requests to a loop, its state.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <functional>
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
  std::vector<std::string> edges;  // what the loop was asked
  bool refuses = false, stands = false;
  int pauses = 0;
  OperatorSignals signals;
  std::function<void()> tick = [this] {
    ++pauses;
    const std::uint32_t asked = requests.asked.load();
    if (stands) return;
    edges.emplace_back(std::array{"none", "arm", "reset", "disarm"}[asked & 3U]);
    requests.echo(asked, !refuses);
  };
  OperatorView view{device, lines, false};
  telemetry::Frame frame;
};

}  // namespace tact::firmware::console
