// SPDX-License-Identifier: Apache-2.0
// The tissue's springs along the surface, and when a sphere slips: see contact.h.
#include <algorithm>
#include <cmath>

#include "model/contact/contact.h"

namespace tact::model::contact {
namespace {

constexpr double kRounding_ratio = 1e-12;  // of a force at its cap

}  // namespace

Vec3 Contact::spring_N(const Shear& shear, std::size_t i) const RT_SAFE {
  std::array<Vec3, kMaxSpheres> shift_m;
  for (std::size_t j = 0; j < kMaxSpheres; ++j) shift_m[j] = touch_[j].shift_m;
  return tangential(shear.force_N(shift_m, i), touch_[i].normal);
}

// By a Hertz contact of its own dent; a held patch is as wide as the sphere.
OwnGive Contact::own_give(std::size_t i) const RT_SAFE {
  constexpr double kLeastRadius_ratio = 0.1;
  const double fixed_N_per_m = scene_.parameters.sliding_stiffness_N_per_m;
  if (fixed_N_per_m > 0.0) return {1.0 / fixed_N_per_m, 1.0 / fixed_N_per_m};
  const double radius_m = scene_.spheres[i].radius_m;
  Indentation in = indentation(i);
  const double contact_m = std::clamp(std::sqrt(radius_m * std::max(in.depth_m, 0.0)),
                                      kLeastRadius_ratio * radius_m, radius_m);
  const double now = scene_.law->sideways_m_per_N(in, in.held ? radius_m : contact_m);
  in.held = true;
  return {now, scene_.law->sideways_m_per_N(in, radius_m)};
}

// In steps of 1 %. Each keeps its force, so it needs less shift.
void Contact::stiffen() RT_SAFE {
  constexpr double kStep_ratio = 0.99;
  const OwnGives before = own_;
  bool is_stiffer = false;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    if (!presses_[i]) continue;
    const double now = std::max(own_give(i).m_per_N, own_[i].least_m_per_N);
    if (!(now < kStep_ratio * own_[i].m_per_N)) continue;
    own_[i].m_per_N = now;
    is_stiffer = true;
  }
  if (!is_stiffer) return;
  std::array<Vec3, kMaxSpheres> change_m{};
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)
    change_m[i] = (own_[i].m_per_N - before[i].m_per_N) * spring_N(shear_, i);
  shear_ = Shear(own_, sideways_, presses_);
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    touch_[i].shift_m += change_m[i];
    probe_[i].held_shift_m += change_m[i];
  }
}

// t up to |f| = mu F. One sphere's slip changes what the next one carries: kSweeps over all, and
// what they leave above the cap is cut from the force alone.
void Contact::resist_sliding() RT_SAFE {
  constexpr int kSweeps = 4;
  for (int sweep = 0; sweep <= kSweeps; ++sweep) {
    bool slipped = false;
    for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
      shear_N_[i] = touch_[i].state == TouchState::kFree ? Vec3{} : spring_N(shear_, i);
      const Vec3 excess_N = beyond_friction_N(i, shear_N_[i]);
      if (excess_N == Vec3{}) continue;
      slipped = true;
      if (sweep == kSweeps)
        shear_N_[i] -= excess_N;
      else
        touch_[i].shift_m -= excess_N / shear_.own_N_per_m(i);
    }
    if (!slipped) return;
  }
}

// What of f is above mu F; held tissue has no cap.
Vec3 Contact::beyond_friction_N(std::size_t i, const Vec3& f_N) const RT_SAFE {
  if (touch_[i].state != TouchState::kTouching) return {};
  const double cap_N = scene_.parameters.friction_ratio * pressing_[i].response.law.force_N;
  const double spring_N = norm(f_N);
  return spring_N > cap_N * (1.0 + kRounding_ratio) ? (1.0 - cap_N / spring_N) * f_N : Vec3{};
}

}  // namespace tact::model::contact
