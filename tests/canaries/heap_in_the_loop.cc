// SPDX-License-Identifier: Apache-2.0
// Real-time code that takes memory: the compiler must refuse it.
#include "model/rt.h"

int* take() RT_SAFE { return new int(1); }

int main() { return *take() - 1; }
