// SPDX-License-Identifier: Apache-2.0
// tact-guardian: zeroes the device of a tactd that has died. Started by it, never by a person.
#include <unistd.h>

#include "firmware/guardian/guardian_process.h"
#include "firmware/guardian/orders.h"

// Nothing runs after the duty: the filter would refuse what a library does at an exit.
int main() {
  close_range(STDERR_FILENO + 1, ~0u, 0);  // what its tactd itself was started with
  _exit(tact::firmware::guardian::stand_guard(tact::firmware::guardian::kOrdersFd));
}
