// SPDX-License-Identifier: Apache-2.0
// The keys that say what the tissue is: its laws, their options, the elastic body they stand for.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/law/hermite_table.h"
#include "model/scene/scene_keys.h"

namespace tact::model::scene {
namespace {

// LW-1 names 17, 33 and 65 knots; fewer were not measured.
constexpr std::size_t kMinKnots = 17;
constexpr std::size_t kMaxUnits = 31;  // one ring each, as many as the viewer shows
constexpr std::size_t kMaxSites = 64;
constexpr std::size_t kMaxSiteVertex = 100'000'000;
// Chosen: it keeps out millimetres that were written for metres.
constexpr reader::Range kDepth_m{1e-4, 0.1};

/// From the one table of names, so that no law can lack one.
constexpr std::array<Choice, kLawNames.size()> law_choices() {
  std::array<Choice, kLawNames.size()> out{};
  std::transform(kLawNames.begin(), kLawNames.end(), out.begin(),
                 [](const LawName& law) { return Choice{law.name, law.meaning}; });
  return out;
}
constexpr auto kLaws = law_choices();
static_assert(std::ranges::is_sorted(kLawNames, std::ranges::less_equal{}, &LawName::kind) &&
              kLawNames.back().kind == LawKind{kLawNames.size() - 1});

void visit_rhombus(Keys& k, Scene& scene) {
  indent::RhombusChainParameters& p = scene.rhombus;
  k.number("rod_length_m", {1e-4, 0.1}, "length a of each rod", p.rod_length_m);
  k.number("initial_angle_rad", {0.05, 1.5}, "angle of the rods to the surface at rest",
           p.initial_angle_rad);
  k.number("normal_stiffness_N_per_m", {0.01, 1e5}, "kN, along the normal",
           p.normal_stiffness_N_per_m);
  k.number("tangential_stiffness_N_per_m", {0.0, 1e5}, "kT of the first unit, along the surface",
           p.tangential_stiffness_N_per_m);
  k.number("growth", {0.1, 100.0}, "beta: unit i has kT exp((i - 1) / beta)", p.growth);
  k.count("units", {1, kMaxUnits}, "rhombus units in series", p.units);
  k.number("area_m2", {0.0, 0.01},
           "of the surface under one chain; 0: one chain under the whole tip",
           scene.rhombus_area_m2, kOptional);
}

// Choices are in the order of the enumerations that they fill.
constexpr std::array kDiscForms{
    Choice{"almen-laszlo", "the disc as it is: stiffness jumps at every layer"},
    Choice{"linear", "its secant: one linear spring"},
};
static_assert(kDiscForms.size() == static_cast<std::size_t>(indent::DiscForm::kLinear) + 1);

void visit_disc_stack(Keys& k, indent::DiscStackParameters& p) {
  k.choice("form", kDiscForms, "almen-laszlo: stiffness jumps at each layer; linear: one spring",
           p.form);
  k.number("outer_diameter_m", {1e-6, 0.1}, "D of a disc", p.disc.outer_diameter_m);
  k.number("inner_diameter_m", {1e-6, 0.1}, "d of a disc", p.disc.inner_diameter_m);
  k.number("thickness_m", {1e-7, 0.1}, "l of a disc", p.disc.thickness_m);
  k.number("free_height_m", {1e-7, 0.1}, "H0 of a disc, above its thickness", p.disc.free_height_m);
  k.number("youngs_modulus_Pa", {1.0, 1e13}, "E of a disc", p.disc.youngs_modulus_Pa);
  k.number("poisson_ratio", {0.0, 0.495}, "mu of a disc", p.disc.poisson_ratio);
  k.number("first_delay_s", {1e-9, 1.0}, "t1: layer i is late by t1 q^(i-1)",
           p.delays.first_delay_s);
  k.number("delay_growth_ratio", {0.1, 100.0}, "q", p.delays.delay_ratio);
  k.number("refresh_rate_Hz", {1.0, 1e5}, "no layer moves later than its period",
           p.delays.refresh_rate_Hz);
  k.count("layers", {1, kMaxUnits}, "discs at most", p.delays.layers);
}

constexpr std::array kHexWeights{
    Choice{"node", "a body spring per node: an elastic foundation"},
    Choice{"ring", "a body spring per ring"},
};
static_assert(kHexWeights.size() == static_cast<std::size_t>(indent::HexWeight::kRing) + 1);

void visit_hex_sheet(Keys& k, indent::HexSheetParameters& p) {
  k.choice("weight", kHexWeights, "body springs: one per node, or one per ring", p.weight);
  k.number("ring_pitch_m", {1e-4, 0.05}, "r, length of a surface spring", p.ring_pitch_m);
  k.number("contact_stiffness_N_per_m", {0.0, 1e5}, "K_N0, body spring at the contact",
           p.contact_stiffness_N_per_m);
  k.number("body_stiffness_N_per_m", {0.01, 1e5}, "K_N, the other body springs",
           p.body_stiffness_N_per_m);
  k.number("surface_stiffness_N_per_m", {0.0, 1e6}, "K_T, springs along the surface",
           p.surface_stiffness_N_per_m);
  k.number("tension_N", {0.0, 100.0}, "T0, of the surface springs at rest", p.tension_N);
  k.number("working_depth_m", kDepth_m, "press and pull up to here", p.working_depth_m);
  k.count("rings", {0, indent::kMaxHexRings}, "m; 0: the fewest that meet [tolerance]", p.rings,
          kOptional);
}

void visit_hunt_crossley(Keys& k, indent::HuntCrossleyParameters& p) {
  k.number("force_N", {1e-4, 100.0}, "of a slow press at working_depth_m", p.force_N);
  k.number("working_depth_m", kDepth_m, "press up to here", p.working_depth_m);
  k.number("exponent", {1.0, 4.0}, "n: the force grows as depth^n", p.exponent);
  k.number("dissipation_s_per_m", {0.0, 100.0}, "lambda: damping over force",
           p.dissipation_s_per_m);
}

constexpr std::array kIntegrators{
    Choice{"explicit-euler", "grows without damping; for comparison"},
    Choice{"improved-euler", "semi-implicit: one evaluation, stable to 2 / omega undamped"},
    Choice{"midpoint-averaging", "two evaluations, second order at alpha 1/2"},
    Choice{"rk2", "two evaluations, grows without damping"},
    Choice{"rk4", "four evaluations, fourth order"},
    Choice{"implicit-euler", "stable at every step, damps; a fixed number of iterations"},
};
static_assert(std::ranges::equal(kIntegrators, springs::kIntegratorNames, {}, &Choice::name,
                                 &springs::IntegratorName::name));
static_assert(std::ranges::is_sorted(springs::kIntegratorNames, std::ranges::less_equal{},
                                     &springs::IntegratorName::integrator) &&
              springs::kIntegratorNames.back().integrator ==
                  springs::Integrator{springs::kIntegratorNames.size() - 1});

void visit_spring_patch(Keys& k, springs::SpringPatchParameters& p) {
  k.number("surface_stiffness_N_per_m", {0.01, 1e5}, "of a spring along an edge of the mesh",
           p.tissue.surface_stiffness_N_per_m);
  k.number("body_stiffness_N_per_m", {0.001, 1e5}, "from a vertex to its place at rest",
           p.tissue.body_stiffness_N_per_m);
  k.number("damping_time_s", {0.0, 1.0}, "tau: a surface spring k has the damping tau k",
           p.tissue.damping_time_s);
  k.number("body_damping_time_s", {0.0, 1.0}, "the same for the body springs",
           p.tissue.body_damping_time_s);
  k.number("pretension_ratio", {0.0, 0.5}, "stretch of the edges at rest: opens a cut",
           p.tissue.pretension_ratio);
  k.number("coupling_stiffness_N_per_m", {0.01, 1e5}, "of the spring between tool and vertices",
           p.coupling_stiffness_N_per_m);
  k.number("node_mass_kg", {1e-7, 1.0}, "of a vertex", p.node_mass_kg);
  k.number("working_depth_m", kDepth_m, "press and pull up to here", p.working_depth_m);
  k.count("nodes", {16, springs::kMaxPatchNodes}, "vertices that move, nearest the contact",
          p.nodes);
  k.choice("integrator", kIntegrators, "how a tick is stepped", p.method.integrator);
  k.number("alpha_ratio", {0.1, 1.0}, "of midpoint-averaging; 0.375 makes energy", p.method.alpha,
           kOptional);
  // count() takes std::size_t; the default is the parameter's own.
  const auto small_count = [&k](std::string_view key, reader::CountRange range,
                                std::string_view meaning, int& out_count) {
    auto value = static_cast<std::size_t>(out_count);
    k.count(key, range, meaning, value, kOptional);
    out_count = static_cast<int>(value);
  };
  small_count("iterations", {1, 100}, "of implicit-euler", p.iterations);
  small_count("substeps", {1, 16}, "of a tick", p.substeps);
}

void visit_compliance(Keys& k, SceneText& out) {
  ComplianceSettings& c = out.scene.compliance;
  out.compliance_map.position = k.position_of("map");
  k.text("map", "file of tact-lab condense, absolute or from the scene's folder",
         out.compliance_map.file);
  k.number("working_depth_m", kDepth_m, "press and pull up to here", c.working_depth_m);
  k.count("curves", {2, 65}, "of the family, soft to stiff", c.curves, kOptional);
  k.flag("large_strain", "organ and tip; false: small strain, as a linear reference",
         c.large_strain, kOptional);
}

void visit_pull(Keys& k, law::LinearPullParameters& pull) {
  k.number("stiffness_N_per_m", {0.01, 1e5}, "of a held site pulled outward",
           pull.stiffness_N_per_m);
  k.number("limit_m", kDepth_m, "beyond it the force stays", pull.limit_m);
}

void visit_elastic(Keys& k, ElasticSettings& elastic) {
  k.number("youngs_modulus_Pa", {1.0, 1e9}, "E", elastic.youngs_modulus_Pa);
  k.number("poisson_ratio", {0.0, 0.495}, "nu", elastic.poisson_ratio);
  k.vector("fixed_min_m", {-1e6, 1e6}, "low corner of the box whose triangles are held",
           elastic.fixed_min_m);
  k.vector("fixed_max_m", {-1e6, 1e6}, "high corner; both of the turned mesh, without position_m",
           elastic.fixed_max_m);
}

void visit_tolerance(Keys& k, ToleranceSettings& tolerance) {
  k.number("force_error_ratio", {0.001, 10.0}, "RMS error of the force over its peak",
           tolerance.force_error_ratio);
  k.number("shape_error_ratio", {0.001, 10.0}, "RMS error of the shape over the depth",
           tolerance.shape_error_ratio);
  k.number("tick_budget_us", {0.1, 1e4}, "of the law, p99.9; non-rt: median",
           tolerance.tick_budget_us);
}

}  // namespace

void visit_laws(Keys& k, SceneText& out) {
  Scene& scene = out.scene;
  k.count("table_knots", {kMinKnots, law::kMaxKnots}, "of the loop's look-up table, each side",
          scene.table_knots, kOptional);
  k.flag("varies_by_place", "closed-form laws in series with [compliance], spring_patch by it",
         scene.varies_by_place, kOptional);
  k.choice("law", kLaws, "of the tissue", scene.law);
  const auto section = [&](LawKind kind, std::string_view meaning, auto* visit, auto& law) {
    if (k.section(name_of(kind), meaning, visit, law, kOptional)) scene.described.push_back(kind);
  };
  section(LawKind::kRhombus, "chain of rhombus units under the touched point", visit_rhombus,
          scene);
  section(LawKind::kDiscStack, "coned discs under the touched point, flat one after the other",
          visit_disc_stack, scene.disc_stack);
  section(LawKind::kHexSheet, "a skin of hexagonal rings on body springs", visit_hex_sheet,
          scene.hex_sheet);
  section(LawKind::kHuntCrossley, "a power law that resists speed as well", visit_hunt_crossley,
          scene.hunt_crossley);
  section(LawKind::kSpringPatch, "masses and springs on the organ's mesh near the contact",
          visit_spring_patch, scene.spring_patch);
  section(LawKind::kCompliance, "the elastic organ of [elastic], condensed to its surface",
          visit_compliance, out);

  // After all sections: which of them are there is known only now.
  if (scene.varies_by_place && !scene.describes(LawKind::kCompliance))
    k.refuse({"varies_by_place"},
             "varies_by_place = true needs a section [compliance]; write it or leave the key out");
  if (scene.law == LawKind::kAuto || scene.describes(scene.law)) return;
  k.refuse({"law"}, fmt::format("law = \"{}\" has no section [{}]; write it or choose another law",
                                name_of(scene.law), name_of(scene.law)));
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
              keys.flag("held_out", "not used by tact-lab fit, only to judge", site.held_out);
            });
  k.section("tolerance", "what is good enough: tact-lab plan chooses by it", visit_tolerance,
            scene.tolerance);
}

}  // namespace tact::model::scene
