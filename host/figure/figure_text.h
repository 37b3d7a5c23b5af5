// SPDX-License-Identifier: Apache-2.0
// figure_text.h - messages about the operator's trackers, and a figure that cannot follow them.
#pragma once

#include <string>

#include "host/figure/figure.h"

namespace tact::host::figure {

/// "head", "left ankle": the name in the description (tracking_setup.h), as words.
std::string text_of(BodyRole role);
/// "silent", "too few points seen": why a body has no pose.
const char* text_of(TrackingTrouble trouble);
/// Sets a pose's `trouble` and `words` from the worst of its bodies, its arm and its legs.
void report(const TrackedOperator& bodies, FigurePose& pose);

}  // namespace tact::host::figure
