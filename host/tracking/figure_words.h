// figure_words.h - what is said of the operator's trackers.
#pragma once

#include <string>

#include "host/tracking/tracked_operator.h"

namespace tact::host {

/// "head", "left ankle": the name in the description (tracking_setup.h), as words.
std::string words_for(BodyRole role);
/// "silent", "too few points seen": why there is no pose.
const char* words_for(TrackingTrouble trouble);

}  // namespace tact::host
