#include "tools/reference/calculix.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <unordered_map>

#include "tools/common/run_program.h"

namespace tact::tools {
namespace {

using model::Error;
using model::Result;
using model::Vec3;

// CalculiX works in mm, kPa and mN: its tolerances suit numbers near one.
constexpr double kMm = 1e3;
constexpr double kKPa = 1e-3;
constexpr double kNPerMN = 1e-3;
constexpr double kTimeLimit_s = 4.0 * 3600.0;
constexpr int kNumbersPerLine = 8;

using Text = std::back_insert_iterator<fmt::memory_buffer>;

struct Axes {
  Vec3 x{}, y{}, z{};

  Vec3 to_deck(const Vec3& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  Vec3 from_deck(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

/// Right-handed, x along the direction. The deck has these axes, so that a moved node needs no
/// equation between its coordinates.
Axes axes_along(const Vec3& direction) {
  const Vec3 x = normalized(direction);
  const Vec3 aside = std::abs(x.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 y = normalized(cross(x, aside));
  return {x, y, cross(x, y)};
}

template <typename Nodes, typename Number>
void write_set(Text out, const char* name, const Nodes& nodes, Number number) {
  fmt::format_to(out, "*NSET,NSET={}\n", name);
  int in_line = 0;
  for (const auto& n : nodes)
    fmt::format_to(out, "{}{}", number(n), ++in_line % kNumbersPerLine == 0 ? "\n" : ",\n");
  if (in_line % kNumbersPerLine != 0) fmt::format_to(out, "\n");
}

void write_body(Text out, const model::fem::TetMesh& body, const Axes& axes) {
  fmt::format_to(out, "*NODE,NSET=ALL\n");
  std::size_t number = 0;
  for (const Vec3& p_m : body.node_m) {
    const Vec3 p_mm = axes.to_deck(p_m) * kMm;
    fmt::format_to(out, "{},{:.12g},{:.12g},{:.12g}\n", ++number, p_mm.x, p_mm.y, p_mm.z);
  }
  fmt::format_to(out, "*ELEMENT,TYPE=C3D10,ELSET=BODY\n");
  number = 0;
  for (const auto& e : body.element) {
    fmt::format_to(out, "{}", ++number);
    for (const std::uint32_t n : e) fmt::format_to(out, ",{}", n + 1);
    fmt::format_to(out, "\n");
  }
}

void write_material(Text out, const Elasticity& m, bool large_strain) {
  const double E_kPa = m.youngs_modulus_Pa * kKPa, nu = m.poisson_ratio;  // NOLINT
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

std::string deck_of(const ElasticProblem& p) {
  fmt::memory_buffer text;
  const Text out(text);
  write_body(out, *p.body, axes_along(p.load.direction));
  const auto moved_number = [](const MovedNode& m) { return m.node + 1; };
  const auto number = [](std::uint32_t n) { return n + 1; };
  write_set(out, "HELD", p.held, number);
  write_set(out, "MOVED", p.load.moved, moved_number);
  write_set(out, "REPORTED", p.reported, number);
  write_material(out, p.material, p.load.large_strain);
  fmt::format_to(out, "*BOUNDARY\nHELD,1,3\n*STEP{}\n*STATIC{}\n",
                 p.load.large_strain ? ",NLGEOM,INC=200" : "",
                 p.load.large_strain ? "\n0.1,1.,1e-5,0.2" : "");
  fmt::format_to(out, "*BOUNDARY\n");
  for (const MovedNode& m : p.load.moved) {
    fmt::format_to(out, "{},1,1,{:.12g}\n", m.node + 1, m.along_m * kMm);
    if (p.load.sideways_held) fmt::format_to(out, "{},2,3\n", m.node + 1);
  }
  fmt::format_to(out,
                 "*NODE PRINT,NSET=MOVED,FREQUENCY=1000\nRF\n"
                 "*NODE PRINT,NSET=REPORTED,FREQUENCY=1000\nU\n*END STEP\n");
  return fmt::to_string(text);
}

/// Node and three numbers on each line below a heading; false if there is no such heading.
bool read_vectors(std::istream& file, const std::string& heading,
                  std::unordered_map<std::uint32_t, Vec3>& out) {
  std::string line;
  while (std::getline(file, line) && line.find(heading) == std::string::npos) {
  }
  if (!file) return false;
  std::getline(file, line);  // empty
  while (std::getline(file, line) && line.find_first_not_of(" \r") != std::string::npos) {
    std::istringstream words(line);
    std::uint32_t node = 0;
    Vec3 v;
    if (!(words >> node >> v.x >> v.y >> v.z) || node == 0) return false;
    out[node - 1] = v;
  }
  return true;
}

bool read_answer(const std::string& path, const ElasticProblem& p, ElasticAnswer& answer) {
  std::ifstream file(path);
  const Axes axes = axes_along(p.load.direction);
  std::unordered_map<std::uint32_t, Vec3> force_by_node, displacement_mm;  // mN, mm
  if (!read_vectors(file, "forces (fx,fy,fz) for set MOVED", force_by_node) ||
      !read_vectors(file, "displacements (vx,vy,vz) for set REPORTED", displacement_mm))
    return false;
  for (const MovedNode& m : p.load.moved) {
    const auto found = force_by_node.find(m.node);
    if (found == force_by_node.end() || !is_finite(found->second)) return false;
    answer.moved_force_N.push_back(axes.from_deck(found->second) * kNPerMN);
    answer.force_N += answer.moved_force_N.back();
  }
  for (const std::uint32_t n : p.reported) {
    const auto found = displacement_mm.find(n);
    if (found == displacement_mm.end() || !is_finite(found->second)) return false;
    answer.displacement_m.push_back(axes.from_deck(found->second) / kMm);
  }
  return true;
}

Result<std::string> run_ccx(const ScratchFolder& folder, std::vector<std::string> arguments,
                            bool any_status) {
  return run_program({.program = "ccx",
                      .arguments = std::move(arguments),
                      .directory = folder.path(),
                      .log_path = folder.file("ccx.log"),
                      .package = "calculix-ccx",
                      .time_limit_s = kTimeLimit_s,
                      .any_status = any_status,
                      .environment = {{"OMP_NUM_THREADS", "1"}, {"CCX_NPROC_STIFFNESS", "1"}}});
}

}  // namespace

Result<ElasticAnswer> solve_with_calculix(const ElasticProblem& problem) {
  auto folder = ScratchFolder::make("tact-ccx");
  if (!folder) return folder.error();
  std::ofstream deck(folder->file("case.inp"));
  deck << deck_of(problem);
  deck.close();
  if (!deck) {
    return Error{fmt::format("{} cannot be written; the disk may be full", folder->path())};
  }
  const auto said = run_ccx(*folder, {"-i", "case"}, false);
  if (!said) {
    if (!was_interrupted(said.error())) folder->keep();
    return said.error();
  }
  ElasticAnswer answer;
  if (read_answer(folder->file("case.dat"), problem, answer)) return answer;
  Error error{fmt::format("CalculiX found no solution; its deck case.inp and ccx.log are in {}",
                          folder->path())};
  folder->keep();
  return error;
}

Result<std::string> calculix_version() {
  auto folder = ScratchFolder::make("tact-ccx");
  if (!folder) return folder.error();
  auto said = run_ccx(*folder, {"-v"}, true);  // ends with 201
  if (!said) return said;
  // "This is Version 2.20"
  const auto at = said->rfind(' ');
  std::string version = at == std::string::npos ? *said : said->substr(at + 1);
  while (!version.empty() && version.back() <= ' ') version.pop_back();
  return version;
}

}  // namespace tact::tools
