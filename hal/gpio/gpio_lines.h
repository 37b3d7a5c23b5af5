// SPDX-License-Identifier: Apache-2.0
// gpio_lines.h - safety lines on a GPIO chip, by libgpiod (GP-2).
//
// Inputs are one request and outputs are one request, so a tick costs one ioctl for all levels and
// one for all outputs; the scope line has its own request and costs two more. Outputs start low and
// go low in stop(); what they do after a crash is up to their pull-down resistors. Once the chip
// has failed to answer, the lines stay lost until they are opened again.
//
// Source: libgpiod (gpiod.h), linux/gpio.h.
#pragma once

#include <memory>

#include "hal/gpio/gpio_chips.h"
#include "hal/lines_settings.h"
#include "hal/safety_lines.h"
#include "model/result.h"

namespace tact::hal::gpio {

/// Lines of scene.device.lines, outputs low; NoSafetyLines when none is wired. Set-up only.
model::Result<std::unique_ptr<SafetyLines>> open_safety_lines(const LinesSettings& settings,
                                                              const SystemRoots& roots = {});

/// The lines of a chip that is chosen and checked. Every line that the scene wires is there, or
/// this is an error that names it.
model::Result<std::unique_ptr<SafetyLines>> open_lines_of(const GpioChip& chip,
                                                          const LinesSettings& settings);

/// The first thing wrong with the line numbers: outside the chip, used twice, none at all.
model::Result<bool> check_offsets(const LinesSettings& settings, const GpioChip& chip);

}  // namespace tact::hal::gpio
