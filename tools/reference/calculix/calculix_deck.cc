// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/calculix/calculix_deck.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <set>

#include "tools/reference/calculix/rigid_ball.h"

namespace tact::tools::reference {
namespace {

using model::Vec3;

constexpr double kKPa = 1e-3;
constexpr int kNumbersPerLine = 8;
constexpr double kBallStiffness = 5000.0;  // of E / R: sinks in by 1e-4 of R and less

constexpr double kMaxStep = 0.2;   // of the way
constexpr double kBallStep = 0.1;  // of R

using Text = std::back_insert_iterator<fmt::memory_buffer>;

template <typename Nodes, typename Number>
void write_set(Text out, const char* name, const Nodes& nodes, Number number) {
  fmt::format_to(out, "*NSET,NSET={}\n", name);
  // A line of CalculiX takes at most 16 numbers.
  int in_line = 0;
  for (const auto& n : nodes)
    fmt::format_to(out, "{}{}", number(n), ++in_line % kNumbersPerLine == 0 ? "\n" : ",\n");
  if (in_line % kNumbersPerLine != 0) fmt::format_to(out, "\n");
}

void write_nodes(Text out, const char* name, const std::vector<Vec3>& nodes_mm,
                 std::size_t number) {
  fmt::format_to(out, "*NODE,NSET={}\n", name);
  for (const Vec3& p : nodes_mm)
    fmt::format_to(out, "{},{:.12g},{:.12g},{:.12g}\n", ++number, p.x, p.y, p.z);
}

void write_body(Text out, const model::fem::TetMesh& body, const DeckAxes& axes) {
  std::vector<Vec3> nodes_mm;
  for (const Vec3& p_m : body.node_m) nodes_mm.push_back(axes.to_deck(p_m) * kMmPerM);
  write_nodes(out, "ALL", nodes_mm, 0);
  fmt::format_to(out, "*ELEMENT,TYPE=C3D10,ELSET=BODY\n");
  std::size_t number = 0;
  for (const auto& e : body.element) {
    fmt::format_to(out, "{}", ++number);
    for (const std::uint32_t n : e) fmt::format_to(out, ",{}", n + 1);
    fmt::format_to(out, "\n");
  }
}

void write_material(Text out, const Elasticity& m, bool large_strain) {
  const double
      E_kPa = m.youngs_modulus_Pa * kKPa,
      nu = m.poisson_ratio;  // NOLINT(readability-identifier-naming): the symbol of the equation
  fmt::format_to(out, "*MATERIAL,NAME=TISSUE\n");
  if (large_strain) {
    // kPa; C10 = G / 2, D1 = 2 / K
    const double shear = m.shear_modulus_Pa() * kKPa;
    const double bulk = E_kPa / (3.0 * (1.0 - 2.0 * nu));
    fmt::format_to(out, "*HYPERELASTIC,NEO HOOKE\n{:.12g},{:.12g}\n", 0.5 * shear, 2.0 / bulk);
  } else {
    fmt::format_to(out, "*ELASTIC\n{:.12g},{:.12g}\n", E_kPa, nu);
  }
  fmt::format_to(out, "*SOLID SECTION,ELSET=BODY,MATERIAL=TISSUE\n");
}

/// "element,Sface" for each of the faces, given by their corners.
void write_touched(Text out, const model::fem::TetMesh& body,
                   const std::vector<model::contact::TriangleCorners>& faces) {
  // CalculiX manual 6.2: corners of the faces 1 to 4
  constexpr std::array<std::array<std::size_t, 3>, 4> kFace{
      {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  const auto in_order = [](model::contact::TriangleCorners corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::set<model::contact::TriangleCorners> touched;
  for (const auto& corners : faces) touched.insert(in_order(corners));
  fmt::format_to(out, "*SURFACE,NAME=TOUCHED,TYPE=ELEMENT\n");
  for (std::size_t e = 0; e < body.element.size(); ++e)
    for (std::size_t f = 0; f < kFace.size(); ++f) {
      const auto& n = body.element[e];
      if (touched.count(in_order({n[kFace[f][0]], n[kFace[f][1]], n[kFace[f][2]]})) > 0)
        fmt::format_to(out, "{},S{}\n", e + 1, f + 1);
    }
}

void write_ball(Text out, const ElasticProblem& p, const DeckAxes& axes) {
  const BallContact& contact = *p.load.ball;
  const RigidBall ball = make_rigid_ball(contact.radius_m);
  const Vec3 centre_mm = axes.to_deck(contact.centre_m) * kMmPerM;
  std::vector<Vec3> nodes_mm;
  for (const Vec3& at_m : ball.node_m) nodes_mm.push_back(centre_mm + at_m * kMmPerM);
  const std::size_t first_node = p.body->node_m.size();
  std::size_t element = p.body->element.size();
  write_nodes(out, "BALL", nodes_mm, first_node);
  fmt::format_to(out, "*ELEMENT,TYPE=C3D15,ELSET=BALL\n");
  for (const WedgeNodes& wedge : ball.wedge) {
    fmt::format_to(out, "{}", ++element);
    for (std::size_t k = 0; k < wedge.size(); ++k)  // at most 16 numbers a line
      fmt::format_to(out, "{}{}", k == 12 ? ",\n" : ",", first_node + wedge[k] + 1);
    fmt::format_to(out, "\n");
  }
  const double E_kPa = p.material.youngs_modulus_Pa *
                       kKPa;  // NOLINT(readability-identifier-naming): the symbol of the equation
  // Every node of the ball is moved by the same way: its own stiffness does not matter.
  fmt::format_to(out,
                 "*MATERIAL,NAME=BALL\n*ELASTIC\n{:.12g},0.3\n"
                 "*SOLID SECTION,ELSET=BALL,MATERIAL=BALL\n*SURFACE,NAME=BALL,TYPE=ELEMENT\n"
                 "BALL,S2\n",
                 E_kPa);
  write_touched(out, *p.body, contact.face);
  fmt::format_to(out,
                 "*SURFACE INTERACTION,NAME=SLIDES\n"
                 "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n{:.12g}\n"
                 "*CONTACT PAIR,INTERACTION=SLIDES,TYPE=MORTAR\nTOUCHED,BALL\n",
                 kBallStiffness * E_kPa / (contact.radius_m * kMmPerM));
}

/// The largest step, as a part of the way.
double largest_step(const ElasticLoad& load) {
  if (!load.ball) return kMaxStep;
  return std::min(kMaxStep, kBallStep * load.ball->radius_m / load.ball->along_m);
}

void write_way(Text out, const ElasticLoad& load) {
  fmt::format_to(out, "*STEP{}\n*STATIC\n", load.large_strain ? ",NLGEOM,INC=1000" : "");
  if (load.large_strain) {
    const double largest = largest_step(load);
    fmt::format_to(out, "{:.6g},1.,1e-5,{:.6g}\n", 0.5 * largest, largest);
  }
  fmt::format_to(out, "*BOUNDARY\n");
  for (const MovedNode& m : load.moved) {
    fmt::format_to(out, "{},1,1,{:.12g}\n", m.node + 1, m.along_m * kMmPerM);
    if (load.sideways_held) fmt::format_to(out, "{},2,3\n", m.node + 1);
  }
  if (load.ball) fmt::format_to(out, "BALL,1,1,{:.12g}\nBALL,2,3\n", load.ball->along_m * kMmPerM);
}

}  // namespace

DeckAxes deck_axes(const Vec3& direction) {
  const Vec3 x = normalized(direction);
  const Vec3 aside = std::abs(x.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 y = normalized(cross(x, aside));
  return {x, y, cross(x, y)};
}

std::string deck_of(const ElasticProblem& p) {
  assert(!p.load.ball || (p.load.large_strain && p.load.moved.empty() && !p.held.empty()));
  fmt::memory_buffer text;
  const Text out(text);
  const DeckAxes axes = deck_axes(p.load.direction);
  write_body(out, *p.body, axes);
  const auto moved_number = [](const MovedNode& m) { return m.node + 1; };
  const auto number = [](std::uint32_t n) { return n + 1; };
  write_set(out, "HELD", p.held, number);
  if (!p.load.moved.empty()) write_set(out, "MOVED", p.load.moved, moved_number);
  write_set(out, "REPORTED", p.reported, number);
  write_material(out, p.material, p.load.large_strain);
  if (p.load.ball) write_ball(out, p, axes);
  // Before the step: it holds from the start.
  fmt::format_to(out, "*BOUNDARY\nHELD,1,3\n");
  write_way(out, p.load);
  fmt::format_to(out,
                 "*NODE PRINT,NSET={},FREQUENCY=1000\nRF\n"
                 "*NODE PRINT,NSET=REPORTED,FREQUENCY=1000\nU\n*END STEP\n",
                 p.load.ball ? "HELD" : "MOVED");
  return fmt::to_string(text);
}

}  // namespace tact::tools::reference
