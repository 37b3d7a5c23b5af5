// SPDX-License-Identifier: Apache-2.0
// device_facts.h - what a device states in its own folder: its section of a scene, its numbers on
// USB and its udev rule. hal/registry has a row for it.
//
// Settings are a struct of plain numbers and names with a constant kSection and a function
//     void visit(model::ParameterVisitor& k)
// that states every key once: name with its unit, range, meaning, variable (model/parameters.h).
// What only the owner of a device can know has no default: a scene must name it. Other defaults are
// those of the vendors' manuals.
#pragma once

#include "model/parameters.h"

namespace tact::hal {

/// [device.KEY]
struct Section {
  const char* key;
  const char* meaning;
  bool required = false;  // of a scene that chooses this device
};

/// By what it is known when it is plugged in, and who may open it.
struct UsbPart {
  const char* kind;               // device.kind of a scene
  const char* vendor;             // idVendor
  const char* product = nullptr;  // null: any
  const char* name;
  const char* path_key = nullptr;  // names it by its port; null: its vendor's SDK finds it
  const char* rule;                // of tools/deploy/60-tact.rules, word for word; man 7 udev
  const char* absence = nullptr;   // where it was looked for and how it shows up; once a kind
};

}  // namespace tact::hal
