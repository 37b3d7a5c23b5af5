// SPDX-License-Identifier: Apache-2.0
#include "model/contact/proxy.h"

#include <algorithm>

namespace tact::model::contact {

namespace {
constexpr double kSameSide_cosine = 0.7;  // between outward normals; 45 degrees, chosen
}  // namespace

void Proxy::restart(const Site& site, double radius_m) RT_SAFE {
  site_ = entry_ = site;
  may_slide_m_ = radius_m;
  stays_ = false;
}

void Proxy::follow(const SurfaceView& surface, const Vec3& p_m, const Vec3& moved_m,
                   double radius_m, bool is_beyond_the_law) RT_SAFE {
  if (dot(p_m - entry_.point_m, entry_.outward) >= 0.0)
    return restart(contact::follow(surface, entry_.place.triangle, p_m), radius_m);
  const Site nearest = contact::follow(surface, site_.place.triangle, p_m);
  Site here = seen_from(site_, p_m);
  // The centre is above the proxy's own tangent plane, and not above that of the entry.
  if (!(here.distance_m < 0.0)) {
    if (here.distance_m <= radius_m) return restart(nearest, radius_m);
    here.distance_m = -here.distance_m;  // it came out on another side
    here.normal = -here.normal;
  }
  // PX-1  |q' - q| <= saved,   saved <- min(saved + 1.5 |sideways|, radius)
  const double sideways_m = norm(tangential(moved_m, site_.normal));
  may_slide_m_ = std::min(may_slide_m_ + kSlide_ratio * sideways_m, radius_m);
  const double way_m = norm(nearest.point_m - site_.point_m);
  stays_ = is_beyond_the_law || way_m > may_slide_m_;
  site_ = stays_ ? here : nearest;
  if (stays_) return;
  may_slide_m_ -= way_m;
  // While it is shallow the place where it goes in slides with the tool.
  if (site_.distance_m > -0.5 * radius_m && dot(site_.outward, entry_.outward) > kSameSide_cosine)
    entry_ = site_;
}

}  // namespace tact::model::contact
