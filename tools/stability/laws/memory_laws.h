// SPDX-License-Identifier: Apache-2.0
// memory_laws.h - a law as the loop meets it, tick by tick, and the laws with memory that the maps
// probe: springs and masses, and relaxation.
//
// All at 1 kHz, on a square plate of 100 mm with triangles of 5 mm. Two terms fade so fast (30 and
// 100 ms) that a run of 3 s sees all of them.
#pragma once

#include <functional>
#include <memory>

#include "model/contact/contact_law.h"
#include "model/law/law.h"

namespace tact::tools::stability {

/// Makes a law with memory, at rest, on that plate.
using ContactLawMaker = std::function<std::unique_ptr<model::contact::ContactLaw>()>;

class RenderedTissue {
 public:
  /// A closed-form law, or one with memory if `make` is there.
  RenderedTissue(std::shared_ptr<const model::law::Law> law, const ContactLawMaker& make)
      : law_(std::move(law)), site_(make ? make() : nullptr) {}

  /// One tick of 1 ms at this depth, in the middle of the plate; a pull holds the tissue.
  model::law::LawResponse tick(double depth_m) {
    if (!site_) return law_->respond(depth_m);
    const model::contact::ContactLawResponse now = site_->respond({.surface_point = kMiddle,
                                                                   .normal = {0.0, 0.0, 1.0},
                                                                   .indentation_m = depth_m,
                                                                   .held = depth_m < 0.0});
    site_->advance();
    return now.law;
  }

  /// Held until nothing moves or fades any more.
  model::law::LawResponse settle(double depth_m) {
    constexpr int kTicks = 2000;
    for (int i = 0; site_ && i < kTicks; ++i) tick(depth_m);
    return tick(depth_m);
  }

 private:
  static constexpr model::contact::SurfacePoint kMiddle{420, {0.3, 0.3, 0.4}};

  std::shared_ptr<const model::law::Law> law_;
  std::unique_ptr<model::contact::ContactLaw> site_;
};

inline constexpr double kPatchRange_m = 0.01;

/// Vendors of a mass-spring patch, and of a closed-form law that relaxes.
ContactLawMaker patch_maker(bool relaxes);
ContactLawMaker relaxing_maker(const std::shared_ptr<const model::law::Law>& law);

}  // namespace tact::tools::stability
