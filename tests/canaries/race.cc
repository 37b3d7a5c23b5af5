// SPDX-License-Identifier: Apache-2.0
// Two threads, one plain int: the thread sanitizer must report it.
#include <thread>

int shared = 0;

int main() {
  std::thread other([] { ++shared; });
  ++shared;
  other.join();
}
