// SPDX-License-Identifier: Apache-2.0
// law.h - what every force law promises.
//
// A law turns the signed displacement of the touched site into a force and a displacement profile:
//
//     d    depth, m: press inward positive, pull outward negative (only while the site is held)
//     F    force on the tool along the outward normal, N: F = dU/dd, F(0) = 0
//     K    dF/dd, N/m      U   stored energy, J, U(0) = 0
//     u_j  displacement of ring j into the tissue, m, at radius j * ring_pitch_m; u_0 = d
//
// Valid on [range.pull_m, range.press_m]; beyond, the force stays at its limit and the status says
// so. NaN in gives zero force and kInvalid. Contract tests: tests/model/law/law_contract.h.
#pragma once

#include <cstdint>
#include <span>

#include "model/rt.h"

namespace tact::model::law {

enum class LawStatus : std::uint8_t {
  kOk,
  kNoContact,
  kSaturated,
  kSingular,
  kInvalid,
};

struct LawResponse {
  double force_N = 0.0;
  double stiffness_N_per_m = 0.0;
  double energy_J = 0.0;
  LawStatus status = LawStatus::kOk;
};

struct LawRange {
  double pull_m = 0.0;   // <= 0; 0: this law cannot pull
  double press_m = 0.0;  // > 0
};

class Law {
 public:
  virtual ~Law() = default;
  virtual LawResponse respond(double depth_m) const RT_SAFE = 0;
  virtual LawRange range() const RT_SAFE = 0;
  /// Fills u_0 .. u_N and returns N + 1; entries beyond the span are dropped.
  virtual std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE = 0;
  virtual double ring_pitch_m() const RT_SAFE = 0;
};

}  // namespace tact::model::law
