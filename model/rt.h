// SPDX-License-Identifier: Apache-2.0
// rt.h - the one mark of real-time code.
//
// RT_SAFE stands after every function that the loop may reach: it does not allocate, lock, wait,
// throw or print, and its work is bounded. clang 20 and later check the promise at compile time
// (-Wfunction-effects) and at run time (-fsanitize=realtime); gcc sees noexcept.
#pragma once

#if defined(__clang__) && __clang_major__ >= 20
#define RT_SAFE noexcept [[clang::nonblocking]]
#else
#define RT_SAFE noexcept
#endif
