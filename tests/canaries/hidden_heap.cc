// SPDX-License-Identifier: Apache-2.0
// Real-time code that takes memory where the compiler does not check: the real-time
// sanitizer must end it.
#include "model/rt.h"

#pragma clang diagnostic ignored "-Wfunction-effects"
int* take() RT_SAFE { return new int(1); }

int main() { return *take() - 1; }
