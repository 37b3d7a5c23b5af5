// SPDX-License-Identifier: Apache-2.0
// just_noticeable.h - the least difference of force that a person notices.
#pragma once

namespace tact::tools::report {

/// Share of the force, 2.5 to 10 N: X. Pang, H. Tan, N. Durlach 1991 (model/SOURCES.md).
inline constexpr double kJustNoticeable_ratio = 0.07;

}  // namespace tact::tools::report
