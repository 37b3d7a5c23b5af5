// SPDX-License-Identifier: Apache-2.0
// device_lock.h - one program per device: two that write to one drive would each undo the other.
//
// The lock is an abstract Unix socket with the device's name, so no file stays behind, and the
// kernel names the process that listens there. A program keeps it until it ends or is killed. Names
// are those of one network namespace, as CAN interfaces are; between programs of several namespaces
// the kernel's own claim keeps a USB device apart, but names no holder. The simulated device needs
// no lock. Set-up code only.
#pragma once

#include <optional>
#include <string>

#include "model/result.h"

namespace tact::hal {

/// Takes the device of this name, such as "can0, node 1", for this process until it ends; once more
/// is no error. Else a message with the pid of the program that has it.
std::optional<model::Error> lock_device(const std::string& name);

}  // namespace tact::hal
