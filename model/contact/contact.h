// SPDX-License-Identifier: Apache-2.0
// contact.h - probe spheres on a tool against the surface of an organ.
//
// Each sphere feels one site, in one of three states with one potential each (c: sphere centre,
// r: its radius, phi: signed distance of c to the undeformed surface, n = grad phi):
//
//   free      W = 0
//   touching  W = U(e, s) + f . t / 2,   d = r - phi - slack,   |f| <= mu F  (Coulomb cap)
//   held      W = U(e, s) + f . t / 2,   d, s and t measured in the frame of the moment of
//             gripping, no cap, d may be negative (pull); ends when the grip opens or when the
//             pulling force passes the tear force
//
//   force on the tool  F = -grad W,   torque = sum (c - origin) x F
//
// U is the site law's (site_law.h), s the place on the surface; as s follows the tool, the slope of
// U along the surface is felt too. t: tangential displacement of the tissue, m, f = K t (shear.h),
// in axes that turn with n. The springs stiffen as the contact grows and stay so until the sphere
// leaves; stiffening keeps the force and lowers the stored energy. On another triangle the springs
// are those of the new place, if that stores no more energy at the same force.
//
// The law is asked with the sphere's own dent e: d less what the other spheres have sunk the site
// (coupling.h). How they couple is kept from a sphere's first touch until it leaves. Damping (LW-3)
// is added last: b of the dent, times the speed of the sphere's own depth, so that each sphere
// takes energy by itself.
//
// A fourth state has no contact: *inside*, a sphere that was found in the organ (start, loss). It
// feels nothing until it has been wholly outside. A contact begins from outside only, and ends
// where the sphere is outside: on the side where it went in or, beyond the law's range, on any
// (detect.cc).
//
// A change of state never adds energy. Slack takes up the depth that would come for free (letting
// go over a bump or stiffer tissue, a nearest point that jumps, a contact that ends on another
// side). It shrinks as the tool withdraws, and by what the proxy comes nearer: the depth stays.
//
// Where the organ bends far (ContactScene.organ) the potential of what touches or is held is that
// of moved_organ.h: contact is then with the organ as its spheres have moved it.
//
// Bodies: detect.cc (where each sphere is), contact.cc (how deep, how hard), contact_grip.cc (hold,
// tear, let go), contact_slide.cc (forces along the surface), contact_moved.cc (an organ that
// bends far).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "model/contact/blade.h"
#include "model/contact/coupling.h"
#include "model/contact/moved_contact.h"
#include "model/contact/probe_sphere.h"
#include "model/contact/proxy.h"
#include "model/contact/shear.h"
#include "model/contact/site_law.h"
#include "model/contact/triangle_tree.h"
#include "model/types.h"

namespace tact::model::contact {

/// Chosen: the time in which a contact beyond its law, or without an answer, ends.
inline constexpr double kLetGo_s = 0.1;
/// Of a radius: a sphere without force searches so far ahead.
inline constexpr double kAhead_ratio = 4.0;
inline constexpr double kAnywhere_m = std::numeric_limits<double>::infinity();

struct ContactParameters {
  double friction_ratio = 0.0;             // mu, >= 0
  double sliding_stiffness_N_per_m = 0.0;  // 1 / G, >= 0; 0: the tissue's own, by its law
  double tear_force_N = 0.0;               // of one sphere, > 0
  double grip_close_ratio = 0.7;           // closing above this holds
  double grip_open_ratio = 0.5;            // opening below this lets go
};

enum class TouchState : std::uint8_t { kFree, kTouching, kHeld, kInside };

/// One sphere's share of a tick.
struct SphereTouch {
  TouchState state = TouchState::kFree;
  law::LawStatus law_status = law::LawStatus::kNoContact;
  Place place;             // of surface_point_m
  Vec3 surface_point_m{};  // nearest (touching) or held point of the undeformed surface
  Vec3 normal{};           // outward, unit
  Vec3 shift_m{};          // t
  double depth_m = 0.0;    // d
  double dent_m = 0.0;     // e
  double slack_m = 0.0;
  double energy_J = 0.0;  // its share of W
  Vec3 force_N{};         // on the tool
};

/// What the tool feels in a tick.
struct ContactResponse {
  Wrench wrench;
  bool is_saturated = false;  // a sphere is beyond its law (LawStatus::kSaturated), or lets go
  bool is_unsettled = false;  // the force of a sphere lags: its place has no answer, or snaps
  bool is_broken = false;     // see SiteLaw::is_broken
  bool is_inside = false;     // a sphere is inside the organ and feels nothing
  bool is_lost = false;       // in this tick: the tool moved unseen, farther than can be followed
};

/// What contact is made of; everything outlives it.
struct ContactScene {
  SiteLaw* law = nullptr;  // may remember: one contact each
  ContactParameters parameters;
  std::span<const ProbeSphere> spheres;  // 1 to kMaxSpheres
  SurfaceView surface;
  TriangleTreeView tree;  // of the surface
  // Not null: the organ bends, and `law` is that of the tip alone. Null: it stays as drawn.
  const BendingOrgan* organ = nullptr;
  std::optional<Blade> blade;  // cuts what it passes through
  double period_s = 1e-3;      // of the loop
};

class Contact {
 public:
  explicit Contact(const ContactScene& scene);

  /// Where the spheres meet the surface. The tool's way since the last call, `periods` ago, is
  /// followed as a straight line, period by period. What moves farther than reach_m, or than can be
  /// followed, is lost: its contact ends, and it is found anew.
  void touch(const Tool& tool, std::uint32_t periods = 1,
             double reach_m = std::numeric_limits<double>::infinity()) RT_SAFE;
  /// What the tool feels there: states, laws, forces. Call after touch. A blade cuts only if it
  /// may.
  ContactResponse feel(const Tool& tool, bool blade_may_cut) RT_SAFE;
  /// Forget every site, as at the start.
  void reset() RT_SAFE;

  /// See SiteLaw::shape.
  bool shape(PatchShape& out) RT_SAFE { return scene_.law->shape(out); }

  std::span<const SphereTouch> touches() const RT_SAFE {
    return {touch_.data(), scene_.spheres.size()};
  }
  /// The organ as its spheres have moved it, where it bends far.
  const MovedContact& moved() const RT_SAFE { return moved_; }

 private:
  struct Probe {
    bool is_known = false;             // else it must be found: at the start, after a loss
    Vec3 centre_m;                     // c
    Vec3 moved_m;                      // since the last tick
    Vec3 velocity_mps;                 // of c, as the device tells it
    double depth_m = 0.0;              // r - phi
    double unpaid_m = 0.0;             // of depth_m, since the last tick: no movement led there
    double clear_m = 0.0;              // so far c may go before its last search must be repeated
    bool was_outside = false;          // what that search said of the whole sphere
    std::uint32_t near = kNoTriangle;  // found by that search
    Proxy proxy;                       // touching or held
    double within_law_m = 0.0;         // e of the last tick within the range of the law
    bool lets_go = false;
    bool is_pressing = false;  // of an organ that bends
    Vec3 organ_shift_m, y_m;   // v and y of the last tick, likewise
    Vec3 told_N;               // its force, likewise
    double lag_N = 0.0;        // what told_N lacked most of what the organ answers
    double stiffest_N_per_m = 0.0;  // of its law, when it touched last
    bool was_held = false;
    double unsolved_ratio = 0.0;  // of its last force that it has lost, likewise
    double deep_m = 0.0;          // so far y may go before it can be outside, likewise
    Vec3 held_centre_m, held_normal;
    double held_depth_m = 0.0;
    Axes axes;                 // of t and f
    TangentGive tangent_give;  // of give_triangle
    std::uint32_t give_triangle = kNoTriangle;
  };

  // detect.cc
  void detect(const Tool& tool) RT_SAFE;
  void forget() RT_SAFE;
  bool is_reached(const Tool& tool, double reach_m) const RT_SAFE;
  void step(std::size_t i, const Vec3& moved_m) RT_SAFE;
  void find(std::size_t i) RT_SAFE;
  void begin_from_outside(std::size_t i, const Vec3& moved_m) RT_SAFE;
  bool is_near(std::size_t i) const RT_SAFE {
    return probe_[i].proxy.site().distance_m < scene_.spheres[i].radius_m;
  }
  /// Slack takes up all of its depth: what it touches may be another part of the organ by now.
  bool is_all_slack(std::size_t i) const RT_SAFE {
    return touch_[i].slack_m > 0.0 && !(touch_[i].depth_m > 0.0);
  }
  bool is_outside(std::size_t i) RT_SAFE;
  bool must_let_go(std::size_t i) RT_SAFE;
  void let_go(std::size_t i) RT_SAFE;

  ContactResponse respond(const Tool& tool) RT_SAFE;
  void respond_at_rest() RT_SAFE;
  void use_blade(const Tool& tool, bool may_cut) RT_SAFE;
  void watch_grip(double grip_ratio) RT_SAFE;
  void leave(std::size_t i, TouchState state) RT_SAFE;
  void find_depth(std::size_t i) RT_SAFE;
  void move_to_proxy(std::size_t i) RT_SAFE;
  Indentation indentation(std::size_t i) const RT_SAFE;
  void couple_new_spheres() RT_SAFE;
  void couple_pair(std::size_t i, std::size_t j) RT_SAFE;
  void add_slack(std::size_t i, double depth_m) RT_SAFE;
  // contact_moved.cc
  bool bends() const RT_SAFE { return scene_.organ != nullptr; }
  void respond_moved() RT_SAFE;
  void step_moved(std::size_t i, const Vec3& moved_m) RT_SAFE;
  void begin_moved(std::size_t i, const Site& site, double paid_m) RT_SAFE;
  bool is_free_at_rest(std::size_t i) RT_SAFE;
  bool is_beyond_moved(const OrganSphere& sphere) const RT_SAFE;
  bool must_let_go_moved(std::size_t i, const OrganSphere& sphere) RT_SAFE;
  void let_go_moved(std::size_t i) RT_SAFE;
  bool release_moved() RT_SAFE;
  void hold_moved() RT_SAFE;
  void fade_unsolved(std::size_t i) RT_SAFE;
  void tell_force(std::size_t i, const Vec3& wanted_N) RT_SAFE;
  void sum_up_moved(std::size_t i) RT_SAFE;

  double press() RT_SAFE;
  void keep_definite() RT_SAFE;
  bool hold() RT_SAFE;
  bool is_torn(std::size_t i) const RT_SAFE;
  bool release_first() RT_SAFE;
  void release_sphere(std::size_t i) RT_SAFE;
  Tensor2 give_m_per_N(std::size_t i) const RT_SAFE;
  TangentGive ask_tangent_give(std::size_t i, bool held) const RT_SAFE;
  void start_tangent_spring(std::size_t i) RT_SAFE;
  void stiffen() RT_SAFE;
  void resist_sliding() RT_SAFE;
  void sum_up(std::size_t i) RT_SAFE;
  bool in_contact(std::size_t i) const RT_SAFE {
    return touch_[i].state == TouchState::kTouching || touch_[i].state == TouchState::kHeld;
  }
  std::span<PressingSphere> pressing() RT_SAFE { return {pressing_.data(), scene_.spheres.size()}; }

  ContactScene scene_;
  std::array<Probe, kMaxSpheres> probe_{};
  std::array<SphereTouch, kMaxSpheres> touch_{};
  std::array<PressingSphere, kMaxSpheres> pressing_{};
  std::array<bool, kMaxSpheres> in_contact_{};  // touching or held
  MovedContact moved_;                          // touching or held, where the organ bends
  Coupling coupling_{};                         // C as it is felt
  Shear shear_;
  Shear::Shifts shift_m_{}, shear_N_{};    // t, f
  double energy_J_ = 0.0;                  // of all presses
  bool closed_ = false;                    // the grip, with hysteresis
  bool closing_ = false;                   // it closed in this tick
  bool is_lost_ = false;                   // in this tick
  bool was_unsettled_ = false;             // in a period before it that was skipped
  std::optional<Tool> tool_before_;        // of the last tick
  std::optional<Tool> blade_tool_before_;  // where the blade was
};

}  // namespace tact::model::contact
