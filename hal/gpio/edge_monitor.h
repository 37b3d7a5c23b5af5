// SPDX-License-Identifier: Apache-2.0
// edge_monitor.h - when a GPIO line rose and fell, by the kernel's clock in its interrupt: a scope
// pin wired back to a second line of the same chip is measured without a scope. Set-up and ordinary
// threads only; the loop never uses it.
//
// Times are CLOCK_MONOTONIC, as Linux stamps line events since 5.7. The kernel keeps 16 edges; who
// reads too slowly loses the newest. The thread of the line's interrupt (irq/N-tact-jitter)
// distinguishes rise from fall by the level that it finds: on the loop's own core, below the loop,
// it sees one edge of a tick.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "hal/gpio/gpio_chips.h"
#include "hal/gpio/line_request.h"
#include "model/result.h"

namespace tact::hal::gpio {

class EdgeMonitor {
 public:
  EdgeMonitor() = default;
  EdgeMonitor(const EdgeMonitor&) = delete;
  EdgeMonitor& operator=(const EdgeMonitor&) = delete;
  virtual ~EdgeMonitor() = default;

  /// Waits at most so long for an edge, and returns all that are there, in order.
  virtual std::vector<Edge> read(std::chrono::milliseconds longest) = 0;
};

/// The line becomes an input. `chip`: label, name or path, as device.lines.chip has it. An error
/// says which line, who uses it, or what the chip is. `who`: the name of the interrupt's thread,
/// irq/N-who.
model::Result<std::unique_ptr<EdgeMonitor>> open_edge_monitor(const std::string& chip, int line,
                                                              const std::string& who,
                                                              const SystemRoots& roots = {});

}  // namespace tact::hal::gpio
