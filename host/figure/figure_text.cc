// SPDX-License-Identifier: Apache-2.0
#include "host/figure/figure_text.h"

#include <algorithm>
#include <array>

#include "host/tracking/tracking_setup.h"

namespace tact::host::figure {

std::string text_of(BodyRole role) {
  std::string out = tracking::name_of(role);
  std::ranges::replace(out, '_', ' ');
  return out;
}

const char* text_of(TrackingTrouble trouble) {
  static constexpr std::array kTexts{"no pose",
                                     "silent",
                                     "too few points seen",
                                     "points on a line",
                                     "a number that is none",
                                     "no pose fits",
                                     "it jumps",
                                     "frozen",
                                     "out of order"};
  static_assert(kTexts.size() == static_cast<std::size_t>(TrackingTrouble::kOutOfOrder) + 1);
  return kTexts[static_cast<std::size_t>(trouble)];
}

void report(const TrackedOperator& bodies, FigurePose& pose) {
  pose.trouble = FigureTrouble::kNone;
  pose.words.clear();
  const auto say = [&pose](FigureTrouble trouble, const std::string& words) {
    // Reports the worst; of equal ones the first.
    if (trouble > pose.trouble) pose.words = words;
    pose.trouble = std::max(pose.trouble, trouble);
  };
  for (std::size_t i = 0; i < kBodyRoles; ++i) {
    const TrackedBody& body = bodies.bodies[i];
    const auto role = static_cast<BodyRole>(i);
    // "Tracked" with an invalid pose: bound_bone.h holds the bone, so it is reported as held.
    const bool bad = body.state == BodyState::kTracked && !is_good(body.pose);
    const auto words = [&](const char* what) {
      const TrackingTrouble why = bad ? TrackingTrouble::kInvalid : body.trouble;
      return text_of(role) + ' ' + what + " (" + text_of(why) + ')';
    };
    if (body.state == BodyState::kLost) say(FigureTrouble::kLost, words("lost"));
    if (body.state == BodyState::kHeld || bad) say(FigureTrouble::kHeld, words("held"));
  }
  if (pose.shoulder_too_far)
    say(FigureTrouble::kHeld, "the tracked shoulder is too far off to be believed");
  if (!pose.arm.reached) say(FigureTrouble::kOutOfReach, "the arm cannot reach the tool");
  for (const bool right : {false, true}) {
    if (pose.leg_reached[right ? 1 : 0]) continue;
    say(FigureTrouble::kOutOfReach,
        std::string("the leg cannot reach the ") + (right ? "right" : "left") + " ankle");
  }
  if (!pose.left_hand_reached)
    say(FigureTrouble::kOutOfReach, "the arm cannot reach the left hand");
}

}  // namespace tact::host::figure
