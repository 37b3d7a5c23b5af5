// SPDX-License-Identifier: Apache-2.0
// random_path.h - the ways of a tool round, into, through and out of an organ; from a seed.
//
// A path is a start and straight legs to absolute points, so that each leg can be taken out and the
// rest is still a path. It knows the mesh and the reference (brute_force.h), not the contact.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/brute_force.h"

namespace tact::tests {

struct Leg {
  model::Vec3 to_m;
  double speed_mps = 0.1;  // 0: rest, for rest_ticks
  int rest_ticks = 0;
  double pause_at = 0.0;            // share of the leg after which periods are skipped
  std::uint32_t pause_periods = 0;  // skipped
};

struct Path {
  model::Vec3 start_m;
  std::vector<Leg> legs;
};

/// As C++ that makes it: for a test of its own.
inline std::string as_code(const Path& path) {
  std::ostringstream out;
  out.precision(17);
  const auto vec = [&](const model::Vec3& v) {
    out << "{" << v.x << ", " << v.y << ", " << v.z << "}";
  };
  out << "Path{.start_m = ";
  vec(path.start_m);
  out << ", .legs = {";
  for (const Leg& leg : path.legs) {
    out << "\n  {.to_m = ";
    vec(leg.to_m);
    out << ", .speed_mps = " << leg.speed_mps << ", .rest_ticks = " << leg.rest_ticks
        << ", .pause_at = " << leg.pause_at << ", .pause_periods = " << leg.pause_periods << "},";
  }
  out << "}}";
  return out.str();
}

/// One period of a path.
struct PathTick {
  model::Vec3 position_m;
  std::size_t leg = 0;
  bool is_skipped = false;
};

inline std::vector<PathTick> ticks_of(const Path& path, double period_s = 1e-3) {
  std::vector<PathTick> out{{path.start_m, 0, false}};
  model::Vec3 from_m = path.start_m;
  for (std::size_t k = 0; k < path.legs.size(); ++k) {
    const Leg& leg = path.legs[k];
    const double steps = norm(leg.to_m - from_m) / (leg.speed_mps * period_s);
    const int n = leg.speed_mps > 0.0 ? std::max(1, int(std::ceil(steps - 1e-9))) : leg.rest_ticks;
    const int pause = int(leg.pause_at * n), end = pause + int(leg.pause_periods);
    const model::Vec3 to_m = leg.speed_mps > 0.0 ? leg.to_m : from_m;
    for (int i = 1; i <= n; ++i)
      out.push_back({from_m + i / double(n) * (to_m - from_m), k, i > pause && i <= end && i < n});
    from_m = to_m;
  }
  return out;
}

class PathMaker {
 public:
  PathMaker(std::span<const model::Vec3> vertex_m, std::span<const BruteForce::Corners> triangle,
            const BruteForce& body, double radius_m, std::uint32_t seed)
      : vertex_m_(vertex_m), triangle_(triangle), body_(body), radius_m_(radius_m), random_(seed) {}

  Path make(int acts) {
    path_ = {.start_m = start_m(), .legs = {}};
    at_m_ = path_.start_m;
    for (int i = 0; i < acts; ++i) add_act();
    if (is(0.7)) leave();
    for (Leg& leg : path_.legs) {
      if (!is(0.15)) continue;
      leg.pause_at = from(0.0, 0.9);
      leg.pause_periods = std::uint32_t(from(1.0, 19.99));
    }
    return path_;
  }

 private:
  struct Spot {
    model::Vec3 at_m, outward;
  };
  double from(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool is(double probability) { return from(0.0, 1.0) < probability; }
  model::Vec3 direction() {
    for (;;) {
      const model::Vec3 v{from(-1, 1), from(-1, 1), from(-1, 1)};
      if (norm(v) > 0.1 && norm(v) < 1.0) return normalized(v);
    }
  }
  Spot spot() {
    const auto& c = triangle_[random_() % triangle_.size()];
    const model::Vec3 a = vertex_m_[c[0]], b = vertex_m_[c[1]] - a, d = vertex_m_[c[2]] - a;
    double s = from(0, 1), t = from(0, 1);
    if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
    return {a + s * b + t * d, normalized(cross(b, d))};
  }
  double speed_mps() { return 0.02 * std::pow(25.0, from(0.0, 1.0)); }  // to 0.5

  model::Vec3 start_m() {
    const bool begins_inside = is(0.5);
    for (int tries = 0; tries < 1000; ++tries) {
      const Spot s = spot();
      const double deep_m = begins_inside ? std::pow(from(0, 1), 2) * 25e-3 - 0.8 * radius_m_
                                          : -(radius_m_ + from(0.5e-3, 20e-3));
      const model::Vec3 p_m = s.at_m - deep_m * s.outward;
      const bool is_clear =
          body_.winding(p_m) < 0.5 && !(body_.nearest(p_m, 2 * radius_m_).distance_m < radius_m_);
      if (is_clear != begins_inside) return p_m;
    }
    return body_.high_m() + model::Vec3{0.02, 0.02, 0.02};
  }
  void go(const model::Vec3& to_m, double speed_mps) {
    constexpr double kMaxTicks = 2000;
    path_.legs.push_back(
        {.to_m = to_m, .speed_mps = std::max(speed_mps, norm(to_m - at_m_) / (kMaxTicks * 1e-3))});
    at_m_ = to_m;
  }
  void press() {
    const Spot s = spot();
    const model::Vec3 along = normalized(-s.outward + from(0.0, 1.2) * direction());
    const model::Vec3 before_m = s.at_m - (radius_m_ + 8e-3) * along;
    go(before_m, 0.5);
    const double speed = speed_mps(), deep_m = std::pow(from(0, 1), 2) * 45e-3;
    go(s.at_m + deep_m * along, speed);
    if (is(0.4)) drag();
    if (is(0.5)) go(before_m, speed);  // else out on another side, by the next act
  }
  void drag() { go(at_m_ + from(1e-3, 50e-3) * direction(), speed_mps()); }
  void leave() { go(at_m_ + from(30e-3, 200e-3) * direction(), 0.5); }
  void loop() {
    constexpr int kChords = 16;
    const model::Vec3 centre_m = at_m_ + from(2e-3, 25e-3) * direction();
    const model::Vec3 u = at_m_ - centre_m;
    const model::Vec3 v = norm(u) * normalized(cross(u, direction()));
    const double speed = speed_mps();
    for (int i = 1; i <= kChords; ++i) {
      const double angle = 2 * std::numbers::pi * i / kChords;
      go(centre_m + std::cos(angle) * u + std::sin(angle) * v, speed);
    }
  }
  /// Along the axis through the middle: of a torus, through its hole.
  void pass_middle() {
    const model::Vec3 middle_m = 0.5 * (body_.low_m() + body_.high_m());
    const model::Vec3 beside_m =
        from(0.0, 12e-3) * normalized(model::Vec3{from(-1, 1), from(-1, 1), 0.0});
    const model::Vec3 up_m{0, 0, (is(0.5) ? 1.0 : -1.0) * (body_.high_m().z - middle_m.z + 15e-3)};
    go(middle_m + up_m + beside_m, 0.5);
    go(middle_m - up_m + from(0.0, 1.0) * beside_m, speed_mps());
  }
  void add_act() {
    const double which = from(0.0, 1.0);
    if (which < 0.45) return press();
    if (which < 0.6) return drag();
    if (which < 0.7) return leave();
    if (which < 0.8) return loop();
    if (which < 0.9) return pass_middle();
    path_.legs.push_back({.to_m = at_m_, .speed_mps = 0.0, .rest_ticks = int(from(1.0, 300.0))});
  }

  std::span<const model::Vec3> vertex_m_;
  std::span<const BruteForce::Corners> triangle_;
  const BruteForce& body_;
  double radius_m_;
  std::mt19937 random_;
  model::Vec3 at_m_;
  Path path_;
};

}  // namespace tact::tests
