// SPDX-License-Identifier: Apache-2.0
// phase.h - one phase of long work, told on standard error: what it is, how long it has gone on and
// about how long it takes. At a terminal that is one line, written over itself each half second.
#pragma once

#include <string>
#include <thread>

namespace tact::tools::program {

class Phase {
 public:
  Phase(std::string label, double expected_s);

 private:
  std::jthread teller_;  // ends with this object, and says how long it was
};

}  // namespace tact::tools::program
