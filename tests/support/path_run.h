// SPDX-License-Identifier: Apache-2.0
// path_run.h - random paths through one body's contact against contact_rules.h, and the smallest
// path that still breaks a rule.
//
//   g  after a pause of skipped periods in which the tool went straight on by less than r, force is
//      within 5 % + 1 mN of that without the pause, 10 ticks later; not where the contact forks: a
//      path that is 1 nm beside comes to another force there
#pragma once

#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/support/contact_rules.h"
#include "tests/support/organs.h"
#include "tests/support/random_path.h"

namespace tact::tests {

/// The first tick that breaks each rule.
struct PathResult {
  struct At {
    std::size_t tick = 0, leg = 0;
    std::string what;
  };
  std::map<char, At> broken;
  std::size_t ticks = 0;
  int lags = 0, pauses = 0, forks = 0, unsettled = 0;
};

/// How the force after a pause compares with that of a contact that had none.
class PauseRule {
 public:
  /// The periods of the pause, as they are without it.
  void skip(const model::contact::Contact& contact, const model::Tool& tool) {
    if (way_.empty() || after_ > 0) {
      whole_.emplace(contact);
      beside_.emplace(contact);
      way_.assign(1, before_m_);
      after_ = 0;
    }
    way_.push_back(tool.position_m);
    render_force(*whole_, tool);
    render_force(*beside_, shifted(tool));
  }
  /// A period that is not skipped.
  std::optional<Breach> go_on(const model::Tool& tool, const model::Vec3& force_N,
                              double radius_m) {
    before_m_ = tool.position_m;
    if (way_.empty()) return {};
    if (after_ == 0) way_.push_back(tool.position_m);
    const model::Vec3 without_N = render_force(*whole_, tool),
                      beside_N = render_force(*beside_, shifted(tool));
    if (++after_ <= 10) return {};
    const bool counts = is_straight() && norm(way_.back() - way_.front()) < radius_m;
    way_.clear();
    const double most_N = 0.05 * std::max(norm(force_N), norm(without_N)) + 1e-3;
    if (!counts) return {};
    ++pauses_;
    if (norm(force_N - without_N) <= most_N) return {};
    if (norm(beside_N - without_N) > 0.5 * most_N) {
      ++forks_;
      return {};
    }
    return Breach{'g', "force " + std::to_string(norm(force_N)) + " N after a pause, " +
                           std::to_string(norm(without_N)) + " N without, " +
                           std::to_string(norm(force_N - without_N)) + " N between"};
  }
  int pauses() const { return pauses_; }  // compared
  int forks() const { return forks_; }    // of these, forces that were not compared

 private:
  static model::Vec3 render_force(model::contact::Contact& contact, const model::Tool& tool) {
    contact.detect_contact(tool, 1);
    return contact.render_force(tool, false).wrench.force_N;
  }
  static model::Tool shifted(model::Tool tool) {
    constexpr double kBeside_m = 1e-9;
    tool.position_m += kBeside_m * normalized(model::Vec3{1, 1, 1});
    return tool;
  }
  bool is_straight() const {
    const model::Vec3 along = normalized(way_.back() - way_.front());
    for (const model::Vec3& p_m : way_)
      if (norm(tangential(p_m - way_.front(), along)) > 1e-6) return false;
    return true;
  }
  std::optional<model::contact::Contact> whole_, beside_;
  std::vector<model::Vec3> way_;  // from the tick before the pause to the one after
  model::Vec3 before_m_;
  int after_ = 0, pauses_ = 0, forks_ = 0;
};

inline PathResult run_path(SoftBody& soft, const BruteForce& body, const Path& path) {
  PathResult out;
  model::contact::Contact contact(soft.contact_scene());
  std::vector<ContactRules> rules;
  const bool is_alone = soft.spheres.size() == 1;
  for (const model::contact::ProbeSphere& sphere : soft.spheres)
    rules.emplace_back(body, RuleSettings{.radius_m = sphere.radius_m,
                                          .max_slope_N_per_m = soft.max_slope_N_per_m(),
                                          .limit_N = soft.limit_N(),
                                          .range_m = SoftBody::kRange_m,
                                          .period_s = soft.period_s,
                                          .is_alone = is_alone,
                                          .friction_ratio = soft.parameters.friction_ratio});
  PauseRule pause;
  std::uint32_t periods = 0;
  const std::vector<PathTick> ticks = ticks_of(path, soft.period_s);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const model::Tool tool{.position_m = ticks[i].position_m};
    ++periods;
    if (ticks[i].is_skipped) {
      pause.skip(contact, tool);
      continue;
    }
    contact.detect_contact(tool, periods);
    const model::contact::ContactResponse rendered = contact.render_force(tool, false);
    const auto note = [&](const Breach& breach, std::size_t sphere) {
      out.broken.try_emplace(
          breach.rule,
          PathResult::At{i, ticks[i].leg, "sphere " + std::to_string(sphere) + ", " + breach.what});
    };
    for (std::size_t k = 0; k < rules.size(); ++k) {
      const model::contact::SphereContact& sphere_contact = contact.contacts()[k];
      const bool is_beyond = sphere_contact.law_status == model::law::LawStatus::kSaturated;
      for (const Breach& breach :
           rules[k].check({.centre_m = tool.position_m + soft.spheres[k].offset_m,
                           .periods = periods,
                           .sphere_contact = sphere_contact,
                           .is_saturated = is_beyond || (is_alone && rendered.is_saturated),
                           .is_lost = rendered.is_lost,
                           .is_unsettled = rendered.is_unsettled}))
        note(breach, k);
    }
    if (const auto breach = pause.go_on(tool, rendered.wrench.force_N, soft.spheres[0].radius_m))
      note(*breach, 0);
    if (rendered.is_unsettled) ++out.unsettled;
    periods = 0;
  }
  out.ticks = ticks.size();
  for (const ContactRules& r : rules) out.lags += r.lags();
  out.pauses = pause.pauses();
  out.forks = pause.forks();
  return out;
}

/// Legs and pauses taken out one by one while the rule is still broken.
inline Path shrink(SoftBody& soft, const BruteForce& body, Path path, char rule) {
  constexpr int kMaxRuns = 300;
  int runs = 0;
  const auto still_breaks = [&](const Path& p, std::size_t* leg = nullptr) {
    if (++runs > kMaxRuns) return false;
    const PathResult result = run_path(soft, body, p);
    const auto found = result.broken.find(rule);
    if (found != result.broken.end() && leg != nullptr) *leg = found->second.leg;
    return found != result.broken.end();
  };
  for (bool is_smaller = true; is_smaller;) {
    is_smaller = false;
    std::size_t last = 0;
    if (!still_breaks(path, &last)) break;
    if (last + 1 < path.legs.size()) path.legs.resize(last + 1);
    for (std::size_t k = path.legs.size(); k-- > 0;) {
      Path less = path;
      less.legs.erase(less.legs.begin() + std::ptrdiff_t(k));
      if (!still_breaks(less) && path.legs[k].pause_periods > 0) {
        less = path;
        less.legs[k].pause_periods = 0;
        if (!still_breaks(less)) continue;
      } else if (runs > kMaxRuns || !still_breaks(less)) {
        continue;
      }
      path = less;
      is_smaller = true;
    }
  }
  return path;
}

struct PathCase {
  std::string name;  // of the body
  std::uint32_t seed = 0;
  double radius_m = 4e-3;
  bool is_forceps = false;  // two spheres, 8 mm apart
  double friction = 0.0;
  double rate_Hz = 1000.0;
};

/// What many paths came to. Of each rule the first broken path is made small.
struct PathCounts {
  std::size_t paths = 0, ticks = 0;
  int lags = 0, pauses = 0, forks = 0, unsettled = 0;
  std::map<char, std::vector<std::uint32_t>> broken;  // seeds of the paths, by rule
  std::string first;                                  // of each rule, for people

  void run(const PathCase& c, const ContactSurface& surface, const BruteForce& body) {
    std::vector<model::contact::ProbeSphere> spheres{{{}, c.radius_m}};
    if (c.is_forceps) spheres = {{{0, -4e-3, 0}, c.radius_m}, {{0, 4e-3, 0}, c.radius_m}};
    SoftBody soft(surface, spheres, c.friction);
    soft.period_s = 1.0 / c.rate_Hz;
    PathMaker maker(surface.mesh.vertex_m, surface.mesh.triangle, body, c.radius_m, c.seed);
    const Path path = maker.make(6);
    const PathResult result = run_path(soft, body, path);
    ++paths;
    ticks += result.ticks;
    lags += result.lags;
    pauses += result.pauses;
    forks += result.forks;
    unsettled += result.unsettled;
    for (const auto& [rule, at] : result.broken) {
      broken[rule].push_back(c.seed);
      if (broken[rule].size() > 1) continue;
      const Path small = shrink(soft, body, path, rule);
      const PathResult again = run_path(soft, body, small);
      const auto found = again.broken.find(rule);
      first += std::string(1, rule) + ": " + c.name + ", seed " + std::to_string(c.seed) +
               ", r = " + std::to_string(1e3 * c.radius_m) + " mm" +
               (c.is_forceps ? ", forceps" : "") + ", friction " + std::to_string(c.friction) +
               ", tick " + std::to_string(found == again.broken.end() ? 0 : found->second.tick) +
               ": " + (found == again.broken.end() ? at.what : found->second.what) + "\n" +
               as_code(small) + "\n";
    }
  }
  std::string summary() const {
    std::string out = std::to_string(paths) + " paths, " + std::to_string(ticks) + " ticks, " +
                      std::to_string(pauses) + " pauses, " + std::to_string(forks) + " forks, " +
                      std::to_string(unsettled) + " unsettled, " + std::to_string(lags) +
                      " lags; paths that break a rule:";
    for (const auto& [rule, seeds] : broken) {
      out += std::string(" ") + rule + " by seeds";
      for (const std::uint32_t seed : seeds) out += " " + std::to_string(seed);
    }
    return out;
  }
};

/// One sphere or two, smooth or rough.
inline PathCase case_of(const std::string& name, std::uint32_t seed, double rate_Hz = 1000.0) {
  std::mt19937 random(seed);
  PathCase c{.name = name, .seed = seed, .rate_Hz = rate_Hz};
  c.radius_m = std::uniform_real_distribution<double>(1e-3, 6e-3)(random);
  c.is_forceps = seed % 5 == 0;
  if (c.is_forceps) c.radius_m = 4e-3;
  c.friction = seed % 2 == 0 ? 0.4 : 0.0;
  return c;
}

/// Seeds in a row until so many ticks have run.
inline PathCounts run_random_paths(const std::string& name, model::mesh::SurfaceMesh mesh,
                                   std::size_t ticks, double rate_Hz = 1000.0) {
  const ContactSurface surface(std::move(mesh));
  const BruteForce body(surface.mesh.vertex_m, surface.mesh.triangle);
  PathCounts counts;
  for (std::uint32_t seed = 1; counts.ticks < ticks; ++seed)
    counts.run(case_of(name, seed, rate_Hz), surface, body);
  return counts;
}

/// Paths that once broke a rule.
inline PathCounts run_paths_of(const std::string& name, model::mesh::SurfaceMesh mesh,
                               const std::vector<std::uint32_t>& seeds) {
  const ContactSurface surface(std::move(mesh));
  const BruteForce body(surface.mesh.vertex_m, surface.mesh.triangle);
  PathCounts counts;
  for (const std::uint32_t seed : seeds) counts.run(case_of(name, seed), surface, body);
  return counts;
}

}  // namespace tact::tests
