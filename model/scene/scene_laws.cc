// SPDX-License-Identifier: Apache-2.0
// The keys that say what the tissue is: its laws, their options, the elastic body they stand for.
#include <fmt/format.h>

#include <vector>

#include "model/law/hermite_table.h"
#include "model/scene/laws.h"
#include "model/scene/scene_keys.h"

namespace tact::model::scene {
namespace {

// LW-1 names 17, 33 and 65 knots; fewer were not measured.
constexpr std::size_t kMinKnots = 17;
constexpr std::size_t kMaxSites = 64, kMaxInclusions = 8;
constexpr std::size_t kMaxSiteVertex = 100'000'000;

void visit_pull(Keys& k, law::LinearPullParameters& pull) { visit(k, pull); }

void visit_elastic(Keys& k, ElasticSettings& elastic) {
  visit(k, elastic);
  k.vector("fixed_min_m", {-1e6, 1e6}, "low corner of the box whose triangles are held",
           elastic.fixed_min_m);
  k.vector("fixed_max_m", {-1e6, 1e6}, "high corner; both of the turned mesh, without position_m",
           elastic.fixed_max_m);
  k.entries(
      "inclusion", {0, kMaxInclusions}, "a round lump of another modulus, to be found",
      [&](Keys& keys) {
        Inclusion& lump = elastic.inclusions.emplace_back();
        keys.vector("center_m", {-1e6, 1e6}, "deeper than its radius, as the box", lump.center_m);
        keys.number("radius_m", {1e-4, 0.1}, "of the lump", lump.radius_m);
        keys.number("youngs_modulus_Pa", kYoungs_modulus_Pa, "E in it", lump.youngs_modulus_Pa);
      });
}

void visit_tolerance(Keys& k, ToleranceSettings& tolerance) {
  k.number("force_error_ratio", {0.001, 10.0}, "RMS error of the force over its peak",
           tolerance.force_error_ratio);
  k.number("shape_error_ratio", {0.001, 10.0}, "RMS error of the shape over the depth",
           tolerance.shape_error_ratio);
  k.number("tick_budget_us", {0.1, 1e4}, "of a tick in contact: p99.9; non-rt: median",
           tolerance.tick_budget_us);
}

}  // namespace

void visit(ParameterVisitor& v, ElasticSettings& elastic) {
  v.number("youngs_modulus_Pa", kYoungs_modulus_Pa, "E", elastic.youngs_modulus_Pa);
  v.number("poisson_ratio", kPoisson_ratio, "nu", elastic.poisson_ratio);
}

void visit_laws(Keys& k, Scene& scene) {
  k.count("table_knots", {kMinKnots, law::kMaxKnots}, "of the loop's look-up table, each side",
          scene.table_knots, kOptional);
  k.flag("varies_by_place", "closed-form laws in series with [compliance], spring_patch by it",
         scene.varies_by_place, kOptional);
  k.flag("exact_tip", "the law is the organ alone, below the tip's own indentation",
         scene.exact_tip, kOptional);
  std::vector<Choice> choices;
  for (const LawRow& row : all_laws()) choices.push_back({row.name, row.meaning});
  choices.push_back({kAutoLaw, "the least law that meets [tolerance], by tact-lab plan"});
  std::size_t chosen = 0;
  k.choice("law", choices, "of the tissue", chosen);
  scene.law = choices[chosen].name;
  for (const LawRow& row : all_laws())
    if (k.section(row.name, row.meaning, [&](Keys& keys) { row.visit(keys, scene); }, kOptional))
      scene.described.emplace_back(row.name);

  // After all sections: which of them are there is known only now.
  if (scene.varies_by_place && !scene.describes("compliance"))
    k.refuse({"varies_by_place"},
             "varies_by_place = true needs a section [compliance]; write it or leave the key out");
  if (scene.exact_tip && scene.varies_by_place)
    k.refuse({"exact_tip", "varies_by_place"},
             "exact_tip = true takes the law for the organ, varies_by_place = true for the tip; "
             "leave one of the two out");
  if (scene.law == kAutoLaw || scene.describes(scene.law)) return;
  k.refuse({"law"}, fmt::format("law = \"{}\" has no section [{}]; write it or choose another law",
                                scene.law, scene.law));
}

void visit_law_options(Keys& k, Scene& scene) {
  k.section("pull",
            "held sites pull on this spring; compliance and spring_patch keep their own pull",
            visit_pull, scene.pull);
  k.entries("relaxation", {0, law::kMaxPronyTerms}, "a Prony term: force that fades at held depth",
            [&](Keys& keys) {
              law::PronyTerm& term = scene.relaxation.emplace_back();
              keys.number("share_ratio", {1e-6, 1.0}, "of the force at once", term.share);
              keys.number("time_s", {1e-4, 1e5}, "in which it fades to 1/e", term.time_s);
            });
}

void visit_truth(Keys& k, Scene& scene) {
  k.section("elastic", "the organ as a linear elastic body, for tact-lab reference and compliance",
            visit_elastic, scene.elastic);
  k.entries("reference_site", {0, kMaxSites}, "a vertex where tact-lab reference solves",
            [&](Keys& keys) {
              ReferenceSite& site = scene.reference_sites.emplace_back();
              keys.count("vertex", {0, kMaxSiteVertex}, "of the organ's mesh, from 0", site.vertex);
              keys.flag("held_out", "not used by tact-lab fit, only to evaluate", site.held_out);
            });
  k.section("tolerance", "what is good enough: tact-lab plan chooses by it", visit_tolerance,
            scene.tolerance);
}

}  // namespace tact::model::scene
