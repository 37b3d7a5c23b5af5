// tissue.h - a loaded scene made ready to touch: law, table, surface and seeds in one owner.
#pragma once

#include <memory>

#include "model/contact.h"
#include "model/result.h"
#include "model/rhombus_chain.h"
#include "model/scene.h"
#include "model/tabulated_law.h"

namespace tact::model {

class Tissue {
 public:
  /// What a Contact needs; valid as long as this object and its scene.
  const ContactScene& contact_scene() const { return contact_; }
  const TabulatedLaw& law() const { return table_; }
  const RhombusChain& direct_law() const { return *chain_; }

 private:
  friend Result<std::unique_ptr<Tissue>> make_tissue(const Scene&);
  Tissue(std::unique_ptr<RhombusChain> chain, const TabulatedLaw& table)
      : chain_(std::move(chain)), table_(table) {}

  std::unique_ptr<RhombusChain> chain_;  // the table points to it
  TabulatedLaw table_;
  SeedGrid seeds_;
  ContactScene contact_;
};

/// `scene` must outlive the tissue. An error if the law's parameters have no meaning.
Result<std::unique_ptr<Tissue>> make_tissue(const Scene& scene);

}  // namespace tact::model
