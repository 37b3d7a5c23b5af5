// SPDX-License-Identifier: Apache-2.0
// variants.h - what a chart compares: every law of the scene in several sizes, and the peers.
#pragma once

#include <string>
#include <vector>

#include "model/scene/plan_file.h"
#include "model/scene/scene.h"

namespace tact::tools::chart {

enum class PeerKind { kNone, kFem, kSpringMesh, kBulletSurface, kBulletVolume };

struct Variant {
  model::scene::LawSizes sizes{};  // of a law of tact
  PeerKind peer = PeerKind::kNone;
  std::size_t peer_size = 0;  // iterations a tick; of kFem the edge inside the organ, um

  bool is_peer() const { return peer != PeerKind::kNone; }
  std::string family() const;  // "rhombus", "fem"
  std::string size() const;    // "65 knots"
  std::string name() const { return family() + " " + size(); }
};

struct VariantWish {
  std::vector<std::string> laws;  // families; empty: all
  bool quick = false;             // fewer sizes, no peer whose set-up takes long
  bool peers = true;
};

/// In the order of the table. Laws that the scene does not describe are left out.
std::vector<Variant> variants_of(const model::scene::Scene& scene, const VariantWish& wish);
/// Every family there is, for --laws.
std::vector<std::string> all_families();

}  // namespace tact::tools::chart
