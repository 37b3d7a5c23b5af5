// SPDX-License-Identifier: Apache-2.0
// tissue.h - a loaded scene made ready to touch: law, surface and its triangle tree in one owner.
#pragma once

#include <memory>

#include "model/contact/contact.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue_law.h"

namespace tact::model::scene {

class Tissue {
 public:
  /// What a Contact needs; valid as long as this object and its scene. One contact at a time: the
  /// law may remember.
  const contact::ContactScene& contact_scene() const { return contact_; }
  const TissueLaw& law() const { return *law_; }

 private:
  friend Result<std::unique_ptr<Tissue>> make_tissue(const Scene&);
  explicit Tissue(std::unique_ptr<TissueLaw> law) : law_(std::move(law)) {}

  std::unique_ptr<TissueLaw> law_;
  contact::TriangleTree tree_;
  contact::ContactScene contact_;
};

/// `scene` must outlive the tissue. An error if the law's parameters have no meaning.
Result<std::unique_ptr<Tissue>> make_tissue(const Scene& scene);

/// A tissue that a check may press before the loop starts.
struct CheckTissue {
  const Tissue* tissue = nullptr;
  std::unique_ptr<Tissue> own{};
};
/// `tissue` itself where nothing remains of a contact that has ended; of a net of masses and
/// springs another one, since the loop would start with the net as the check has left it.
Result<CheckTissue> tissue_for_check(const Scene& scene, const Tissue& tissue);

}  // namespace tact::model::scene
