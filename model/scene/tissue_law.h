// SPDX-License-Identifier: Apache-2.0
// tissue_law.h - a scene's law made ready to touch: the one owner of curves, tables and memory.
//
// Set-up code; what it hands out (ContactLaw) is what the loop calls.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/contact/contact_law.h"
#include "model/contact/moved_contact.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/tissue/elastic_field.h"

namespace tact::model::scene {

class TissueLaw {
 public:
  contact::ContactLaw& contact_law() const { return *contact_law_; }
  /// The closed-form law felt where nothing varies, or in the middle of a family; null if stepped.
  const law::Law* curve() const { return curves_.empty() ? nullptr : curves_[curves_.size() / 2]; }
  /// Working range of curve(), less near the held side; of a stepped law, what its parameters say.
  law::LawRange range() const { return range_; }
  /// Largest pull it can give, at its stiffest place, N; 0: it cannot pull, or its parameters do
  /// not say.
  double pull_limit_N() const { return pull_limit_N_; }
  /// Largest dF/dd inside the range and short of the tear force, N/m: what device and rate must be
  /// able to render.
  double stiffness_N_per_m() const {  // NaN stays NaN
    return pull_is_stiffer() ? pull_stiffness_N_per_m_ : press_stiffness_N_per_m_;
  }
  /// The stiffest slope is one of pull, where [pull] or the law itself makes it.
  bool pull_is_stiffer() const {
    return pull_stiffness_N_per_m_ > press_stiffness_N_per_m_ ||
           std::isnan(pull_stiffness_N_per_m_);
  }
  /// Largest damping of a sphere, N s/m; 0: the law does not depend on speed.
  double damping_Ns_per_m() const { return damping_Ns_per_m_; }
  /// The organ, where it bends far; else null. Its curve() is then that of the tip alone.
  const contact::BendingOrgan* organ() const { return organ_ ? &*organ_ : nullptr; }
  /// A net of masses and springs: its motion and its cuts outlive a contact.
  bool has_net() const { return organ_law_ != nullptr || curves_.empty(); }
  /// Bytes that the loop may touch.
  std::size_t memory_bytes() const { return memory_bytes_; }
  /// For people.
  const std::string& title() const { return title_; }

 private:
  friend class TissueLawBuilder;

  std::vector<std::unique_ptr<law::Law>> owned_;  // direct laws first, then those built on them
  std::vector<const law::Law*> curves_;           // what the field reads
  std::vector<float> press_coordinate_;           // of each vertex in the family; empty: one curve
  std::vector<float> pull_coordinate_;
  std::vector<float> rings_times_E_per_m_;  // what its contact points are to each other
  std::vector<float> curve_rings_times_E_per_m_;
  std::vector<tissue::TangentTensors> tangent_times_E_per_m_;
  std::vector<Vec3> tilt_times_E_per_m2_;
  std::vector<float> regular_times_E_per_m_;
  std::vector<contact::SurfaceCorner> corner_;         // of the smooth surface
  std::vector<contact::VertexCompliance> compliance_;  // of each vertex, where the organ bends
  std::optional<contact::BendingOrgan> organ_;
  std::unique_ptr<contact::ContactLaw> organ_law_;  // under the tool, where contact_law_ is a net
  std::unique_ptr<contact::ContactLaw> contact_law_;
  law::LawRange range_;
  double pull_limit_N_ = 0.0;
  double press_stiffness_N_per_m_ = 0.0, pull_stiffness_N_per_m_ = 0.0;
  double damping_Ns_per_m_ = 0.0;
  std::size_t memory_bytes_ = 0;
  std::string title_;
};

/// The law of this name (laws.h) with the scene's numbers, regardless of scene.law;
/// the scene outlives it. The error names the scene's file and what its parameters lack.
Result<std::unique_ptr<TissueLaw>> make_tissue_law(const Scene& scene, std::string_view name);

}  // namespace tact::model::scene
