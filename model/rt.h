// SPDX-License-Identifier: Apache-2.0
// rt.h - the one mark of real-time code.
//
// RT_SAFE follows every function that the loop is allowed to reach: it does not allocate,
// lock, throw or print. But for the clock's sleep and the loops themselves it does not wait and its
// work is bounded. tools/tick_size lists which ones a tick does reach. clang 20 and later check the
// promise at compile time (-Wfunction-effects) and at run time (-fsanitize=realtime); gcc sees
// noexcept.
#pragma once

#if defined(__clang__) && __clang_major__ >= 20
#define RT_SAFE noexcept [[clang::nonblocking]]
#else
#define RT_SAFE noexcept
#endif
