// SPDX-License-Identifier: Apache-2.0
// proxy.h - the point of the surface that a pressing sphere belongs to, with memory.
//
// The nearest point of the surface is no anchor for a deep press: beyond the middle of a lobe it
// jumps to the other side and pushes the tool out there. A proxy stays where the tool went in and
// leaves only by sliding [C. Zilles, J. Salisbury, IROS 1995; W. Harwin, N. Melder, EuroHaptics
// 2002]. It goes to the nearest point as long as that
//
//     PX-1   moves at most kSlide_ratio times as far as the tool moves sideways; what it has not
//            used is saved, up to one radius of the sphere, so that it can cross a facet
//
// and else stays: then distance and normal are those of the line from the sphere's centre to it. A
// law beyond its range keeps the proxy where it is. Moves only ever shorten the line: where the law
// is the same everywhere, none makes energy. The tool is out again where it is above the tangent
// plane of the place where it went in; outside the surface the proxy is the nearest point.
#pragma once

#include "model/contact/site.h"

namespace tact::model::contact {

/// A nearest point d below a surface of radius R goes R / (R - d) times as far.
inline constexpr double kSlide_ratio = 1.5;

class Proxy {
 public:
  const Site& site() const RT_SAFE { return site_; }
  /// It does not follow the tool: what differs from place to place is not felt.
  bool stays() const RT_SAFE { return stays_; }

  /// Forget where it went in: the sphere is free, or its centre is outside again.
  void restart(const Site& site, double radius_m) RT_SAFE;
  /// The sphere's centre is at p now and has moved there since the last tick.
  void follow(const SurfaceView& surface, const Vec3& p_m, const Vec3& moved_m, double radius_m,
              bool is_beyond_the_law) RT_SAFE;

 private:
  Site site_;
  Site entry_;                // the last one on this side, less than half a radius deep
  double may_slide_m_ = 0.0;  // saved
  bool stays_ = false;
};

}  // namespace tact::model::contact
