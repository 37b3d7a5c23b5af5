// SPDX-License-Identifier: Apache-2.0
// contact_rules.h - what must hold of every tick of a sphere's contact, for any path.
//
//   a  overlapping from the first tick on: kInside and no force until it has once been outside
//   b  outside, and nothing of the body between it and its contact point: no force, after one range
//      of the law of way, or 0.2 s, in which the contact lets go
//   c  outside and beyond the law's range: no force after 2 ranges of way, or after 0.2 s
//   d  came from outside and not let go: going deeper with its centre inside gives force, by the
//      third tick, and only saturation or a loss lets it go
//   e  |dF| <= 10 K way + 1 mN; while a contact lets go, the way grows by the range in 0.1 s, while
//      its force lags, in 0.5 s
//   f  finite; with its centre outside and its contact point nearest: pulls it in by friction at
//      most (the line to the proxy is not beside the surface, the force in the cone about it),
//      unless it lets go or its force lags
//   h  from free to free the tool is given no more than a sum over steps can be wrong by: the
//      largest force times the largest step, or half of the sum of |dF| |dc|; and for each time
//      that its force lags, F F / (20 K), a tenth of what the largest force can store
//
//   i  a force lags for at most 0.11 s in a row
//
// (g, pauses, is in path_run.h.) Outside: distance >= r and winding number 0, by brute_force.h.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "model/contact/contact.h"
#include "tests/support/brute_force.h"

namespace tact::tests {

struct RuleSettings {
  double radius_m = 0.0, max_slope_N_per_m = 0.0, limit_N = 0.0, range_m = 0.0, period_s = 1e-3;
  bool is_alone = true;         // no other sphere presses the tissue: d, e, f, h
  double friction_ratio = 0.0;  // mu; where it is 0: e
};

struct Breach {
  char rule = '?';
  std::string what;
};

class ContactRules {
 public:
  struct Tick {
    model::Vec3 centre_m;
    std::uint32_t periods = 1;  // since the last
    model::contact::SphereContact sphere_contact;
    bool is_saturated = false, is_lost = false, is_unsettled = false;
  };

  ContactRules(const BruteForce& body, const RuleSettings& settings) : body_(body), s_(settings) {}

  /// The rules that the tick breaks.
  std::vector<Breach> check(const Tick& now) {
    if (!is_finite(now.sphere_contact.force_N)) return {{'f', "force is no number"}};
    force_N_ = norm(now.sphere_contact.force_N);
    moved_m_ = before_ && !now.is_lost ? norm(now.centre_m - before_->centre_m) : 0.0;
    find_side(now);
    std::vector<Breach> breaches;
    for (const auto rule : {&ContactRules::a, &ContactRules::b, &ContactRules::c, &ContactRules::d,
                            &ContactRules::e, &ContactRules::f, &ContactRules::h, &ContactRules::i})
      if (auto found = (this->*rule)(now)) breaches.push_back(*found);
    before_ = now;
    was_outside_ = is_outside_;
    return breaches;
  }

  int lags() const { return lags_; }  // how often b's allowance was used

 private:
  using ContactState = model::ContactState;
  static constexpr double kTiny_m = 1e-9, kEnding_s = 0.1, kAfter_s = 0.2;
  enum class Side { kIn, kOut, kUnknown };

  Side side_of(const model::Vec3& p_m, const BruteForce::Nearest& nearest) const {
    if (!body_.is_near(p_m)) return Side::kOut;
    const double w = body_.winding(p_m);
    if (body_.is_closed()) return w > 0.5 ? Side::kIn : Side::kOut;
    // Near the holes of an open surface, inside is no fact.
    if (w > 0.3 && w < 0.7) return Side::kUnknown;
    const bool is_in = w > 0.5;
    if (std::isfinite(nearest.distance_m) && body_.is_behind(nearest, p_m) != is_in)
      return Side::kUnknown;
    return is_in ? Side::kIn : Side::kOut;
  }

  void find_side(const Tick& now) {
    // A distance changes by no more than the way: between two points it is at most the mean of both
    // plus half the way.
    constexpr double kStep_m = 0.5e-3;
    const int n = before_ && !now.is_lost ? std::max(1, int(std::ceil(moved_m_ / kStep_m))) : 1;
    if (!before_ || now.is_lost) has_overlapped_ = true;
    stayed_out_ = true;
    for (int k = 1; k <= n; ++k) {
      const model::Vec3 p_m =
          k == n ? now.centre_m
                 : before_->centre_m + k / double(n) * (now.centre_m - before_->centre_m);
      nearest_ = body_.nearest(p_m, s_.radius_m + 2 * kStep_m);
      const Side side = side_of(p_m, nearest_);
      const double away_m = std::min(nearest_.distance_m, s_.radius_m + 2 * kStep_m);
      const double phi_m = side == Side::kIn ? -away_m : away_m;
      const bool is_first = !before_ || now.is_lost;
      const double most_m = is_first ? phi_m : 0.5 * (phi_m + phi_m_ + moved_m_ / n);
      if (side == Side::kUnknown || !(most_m < s_.radius_m - kTiny_m)) has_overlapped_ = false;
      // Through a hole it comes in without contact.
      if (side == Side::kUnknown || (side == Side::kIn && side_ == Side::kOut && !is_first &&
                                     !body_.is_closed() && !body_.crosses(last_m_, p_m)))
        entered_ = false;
      stayed_out_ = stayed_out_ && side == Side::kOut && away_m > s_.radius_m;
      side_ = side;
      phi_m_ = phi_m;
      last_m_ = p_m;
    }
    is_outside_ = side_ == Side::kOut && nearest_.distance_m > s_.radius_m + kTiny_m;
  }

  std::optional<Breach> a(const Tick& now) {
    if (!has_overlapped_) return {};
    if (now.sphere_contact.state != ContactState::kInside)
      return say('a', "never outside and not kInside");
    if (force_N_ != 0.0) return say('a', "force without having been outside");
    return {};
  }

  std::optional<Breach> b(const Tick& now) {
    const model::Vec3& q_m = now.sphere_contact.surface_point_m;
    const bool has_contact = now.sphere_contact.state == ContactState::kInContact ||
                             now.sphere_contact.state == ContactState::kHeld;
    bool is_lag = is_outside_ && force_N_ > 0.0;
    if (is_lag && has_contact) {
      const double way_m = norm(now.centre_m - q_m);
      const double share = way_m > 0.0 ? std::min(1.0, 1e-6 / way_m) : 1.0;
      is_lag = !body_.crosses(q_m + share * (now.centre_m - q_m), now.centre_m);
    }
    if (!is_lag) {
      lag_m_ = lag_s_ = -1.0;
      return {};
    }
    if (lag_m_ < 0.0) {
      ++lags_;
      lag_m_ = lag_s_ = 0.0;
      return {};
    }
    lag_m_ += moved_m_;
    lag_s_ += now.periods * s_.period_s;
    if (lag_m_ > s_.range_m || lag_s_ > kAfter_s)
      return say('b', "force outside, with nothing between it and the contact point");
    return {};
  }

  std::optional<Breach> c(const Tick& now) {
    if (!is_outside_ || !now.is_saturated || force_N_ == 0.0) {
      was_beyond_ = false;
      beyond_m_ = beyond_s_ = 0.0;
      return {};
    }
    // Within a pause it is not known when it began, nor whether there was contact in between.
    if (now.periods > 1 && (!std::exchange(was_beyond_, true) || !stayed_out_)) {
      beyond_m_ = beyond_s_ = 0.0;
      return {};
    }
    was_beyond_ = true;
    beyond_m_ += moved_m_;
    beyond_s_ += now.periods * s_.period_s;
    if (beyond_m_ > 2 * s_.range_m || beyond_s_ > kAfter_s)
      return say('c', "force outside, beyond the law");
    return {};
  }

  std::optional<Breach> d(const Tick& now) {
    if (!s_.is_alone) return {};
    const bool was_entered = entered_;
    if (is_outside_ && force_N_ == 0.0) entered_ = true;
    if (now.is_lost || now.is_saturated || now.sphere_contact.state == ContactState::kInside)
      entered_ = false;
    if (was_entered && !now.is_lost && !now.is_saturated && !is_outside_ &&
        now.sphere_contact.state == ContactState::kInside)
      return say('d', "let go though neither lost nor saturated");
    if (!entered_ || !was_entered || force_N_ > 0.0 || side_ != Side::kIn) {
      without_ = 0;
      return {};
    }
    // Only where it seems broken: the search is wide.
    const double wide_m = s_.radius_m + s_.range_m;
    const double here_m = body_.nearest(now.centre_m, wide_m).distance_m;
    const bool was_in = before_ && body_.winding(before_->centre_m) > 0.5;
    const double there_m = was_in ? body_.nearest(before_->centre_m, wide_m).distance_m : 0.0;
    // From one piece of the organ to another the contact changes within two ticks.
    without_ = here_m > there_m + kTiny_m ? without_ + 1 : 0;
    if (without_ > 2) return say('d', "goes deeper without force");
    return {};
  }

  std::optional<Breach> e(const Tick& now) {
    if (!s_.is_alone || s_.friction_ratio > 0.0 || !before_ || now.is_lost) return {};
    const double jump_N = norm(now.sphere_contact.force_N - before_->sphere_contact.force_N);
    // Once begun, it goes on until there is no force.
    is_ending_ = (is_ending_ && before_->is_saturated) ||
                 ((now.is_saturated || before_->is_saturated) && (is_outside_ || was_outside_));
    const bool is_lag = now.is_unsettled || before_->is_unsettled;
    const double fade_s = is_ending_ ? kEnding_s : 5.0 * kEnding_s;
    const double fade_m =
        is_ending_ || is_lag ? s_.range_m * now.periods * s_.period_s / fade_s : 0.0;
    const double most_N = 10.0 * s_.max_slope_N_per_m * (moved_m_ + fade_m) + 1e-3 * now.periods;
    if (jump_N <= most_N) return {};
    return say('e', "force jumps by " + std::to_string(1e3 * jump_N) + " mN, at most " +
                        std::to_string(1e3 * most_N));
  }

  std::optional<Breach> f(const Tick& now) {
    if (!s_.is_alone) return {};
    const bool is_nearest = norm(now.sphere_contact.surface_point_m - nearest_.point_m) < 1e-6;
    if (now.sphere_contact.state != ContactState::kInContact || side_ != Side::kOut ||
        !is_nearest || !(nearest_.distance_m > 1e-6) || !std::isfinite(nearest_.distance_m) ||
        now.is_saturated || now.is_unsettled)
      return {};
    const model::Vec3 outward = (now.centre_m - nearest_.point_m) / nearest_.distance_m;
    // sin(atan(mu)) |F|
    const double sine = s_.friction_ratio / std::hypot(1.0, s_.friction_ratio);
    if (dot(now.sphere_contact.force_N, outward) >= -sine * force_N_ - 1e-6 * (1.0 + force_N_))
      return {};
    return say('f', "pulls a free sphere in");
  }

  std::optional<Breach> h(const Tick& now) {
    if (!s_.is_alone) return {};
    const bool is_free = is_outside_ && force_N_ == 0.0;
    if (before_ && !now.is_lost && in_stroke_) {
      given_energy_J_ += 0.5 * dot(now.sphere_contact.force_N + before_->sphere_contact.force_N,
                                   now.centre_m - before_->centre_m);
      most_N_ = std::max(most_N_, force_N_);
      most_m_ = std::max(most_m_, moved_m_);
      if (now.is_unsettled && !before_->is_unsettled) ++lagged_;
      wrong_J_ +=
          0.5 * norm(now.sphere_contact.force_N - before_->sphere_contact.force_N) * moved_m_;
    }
    if (now.is_lost) in_stroke_ = false;
    if (!is_free) return {};
    const double most_J = std::max(most_N_ * most_m_, wrong_J_) +
                          lagged_ * most_N_ * most_N_ / (20.0 * s_.max_slope_N_per_m);
    const bool is_over = in_stroke_ && given_energy_J_ > most_J + 1e-12;
    std::ostringstream what;
    what << "given " << given_energy_J_ << " J; the sum may be wrong by " << most_J << " J";
    in_stroke_ = true;
    given_energy_J_ = most_N_ = most_m_ = wrong_J_ = 0.0;
    lagged_ = 0;
    if (is_over) return say('h', what.str());
    return {};
  }

  std::optional<Breach> i(const Tick& now) {
    unsettled_s_ = now.is_unsettled ? unsettled_s_ + now.periods * s_.period_s : 0.0;
    constexpr double kLongest_s = 0.11;
    if (unsettled_s_ <= kLongest_s + now.periods * s_.period_s) return {};
    return say('i', "the force lags for too long");
  }

  std::optional<Breach> say(char rule, const std::string& what) const {
    std::ostringstream out;
    out << what << "; force " << force_N_ << " N, centre " << 1e3 * phi_m_
        << " mm outside (as far as that was searched)";
    return Breach{rule, out.str()};
  }

  const BruteForce& body_;
  RuleSettings s_;
  std::optional<Tick> before_;
  double force_N_ = 0.0, moved_m_ = 0.0;
  BruteForce::Nearest nearest_;
  Side side_ = Side::kUnknown;
  double phi_m_ = 0.0;  // signed distance, as far as nearest_ was searched
  model::Vec3 last_m_;
  bool is_outside_ = false, was_outside_ = false, stayed_out_ = false, was_beyond_ = false;
  bool has_overlapped_ = false;  // surely, ever since the start
  bool is_ending_ = false;
  int without_ = 0;       // ticks in a row, deeper and without force
  bool entered_ = false;  // from outside, and not let go since
  double unsettled_s_ = 0.0;
  double lag_m_ = -1.0, lag_s_ = -1.0, beyond_m_ = 0.0, beyond_s_ = 0.0;
  int lags_ = 0;
  bool in_stroke_ = false;
  int lagged_ = 0;
  double given_energy_J_ = 0.0, most_N_ = 0.0, most_m_ = 0.0, wrong_J_ = 0.0;
};

}  // namespace tact::tests
