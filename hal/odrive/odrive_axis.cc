#include "hal/odrive/odrive_axis.h"

#include <bit>
#include <cmath>

namespace tact::hal {
namespace {

constexpr double kSlack_turns = 0.02;   // backlash of stamps at low speed, encoder ripple
constexpr double kStampError_s = 2e-3;  // the kernel may stamp a frame late
constexpr double kHalfMost_turns_per_s2 = 1000.0;  // half of what a motor of this size can do
constexpr double kMoved_turns = 1e-5;              // an estimate that moved so far has other bits

bool same_bits(double a, double b) RT_SAFE {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

OdriveNews OdriveAxis::take(const OdriveEstimates& now, std::int64_t arrival_ns) RT_SAFE {
  if (has_position_) {
    if (arrival_ns < arrival_ns_) return OdriveNews::kOld;
    const double dt_s = 1e-9 * static_cast<double>(arrival_ns - arrival_ns_);
    const double speed_turns_per_s = std::abs(now.velocity_turns_per_s);
    if (same_bits(now.position_turns, newest_.position_turns) &&
        same_bits(now.velocity_turns_per_s, newest_.velocity_turns_per_s) &&
        speed_turns_per_s * dt_s > kMoved_turns) {
      return OdriveNews::kStale;
    }
    const double moved_turns =
        0.5 * (now.velocity_turns_per_s + newest_.velocity_turns_per_s) * dt_s;
    const double residual_turns =
        std::abs(now.position_turns - newest_.position_turns - moved_turns);
    const double most_turns =
        kSlack_turns + speed_turns_per_s * kStampError_s + kHalfMost_turns_per_s2 * dt_s * dt_s;
    if (!(residual_turns <= most_turns)) {
      ++jumps_;
      return OdriveNews::kJumped;
    }
  }
  jumps_ = 0;
  newest_ = now;
  arrival_ns_ = arrival_ns;
  has_position_ = true;
  return OdriveNews::kNew;
}

}  // namespace tact::hal
