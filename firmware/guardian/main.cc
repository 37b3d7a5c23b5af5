// SPDX-License-Identifier: Apache-2.0
// tact-guardian: zeroes the device of a tactd that has died. tactd starts it.
#include <unistd.h>

#include "firmware/guardian/guardian_process.h"
#include "firmware/guardian/orders.h"

// _exit: no exit handler may run, because the filter would refuse a library's calls there.
int main() {
  close_range(STDERR_FILENO + 1, ~0u, 0);  // descriptors that tactd had inherited
  _exit(tact::firmware::guardian::stand_guard(tact::firmware::guardian::kOrdersFd));
}
