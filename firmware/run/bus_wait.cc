// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/bus_wait.h"

#include "firmware/console/say.h"
#include "hal/registry/open_device.h"
#include "model/time_ns.h"

namespace tact::firmware::run {

bool wait_for_bus(const model::scene::Scene& scene, const console::OperatorSignals& signals) {
  std::string reported;
  for (;;) {
    const std::string missing = hal::registry::missing_interface(scene.device);
    if (missing.empty()) return true;
    if (reported != missing)
      console::say(stderr, "tactd: waiting for {}: it is not there, or not up; ip link shows it\n",
                   missing);
    reported = missing;
    if (signals.wait_for_end(model::kSecond_ns)) return false;
  }
}

}  // namespace tact::firmware::run
