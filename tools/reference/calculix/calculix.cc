// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/calculix/calculix.h"

#include <fmt/format.h>

#include <sstream>
#include <unordered_map>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "tools/program/run_program.h"
#include "tools/reference/calculix/calculix_deck.h"

namespace tact::tools::reference {
namespace {

using model::Error;
using model::Result;
using model::Vec3;

// Chosen: a site with large strain takes about 25 min.
constexpr double kTimeLimit_s = 4.0 * 3600.0;
constexpr const char* kNoSolution = "CalculiX found no solution";

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

/// In mN, of these nodes in their order; false if one is missing.
template <typename Nodes, typename Number>
bool read_forces(std::istream& file, const char* set, const Nodes& nodes, Number number,
                 std::vector<Vec3>& out) {
  std::unordered_map<std::uint32_t, Vec3> by_node;
  if (!read_vectors(file, std::string("forces (fx,fy,fz) for set ") + set, by_node)) return false;
  for (const auto& n : nodes) {
    const auto found = by_node.find(number(n));
    if (found == by_node.end() || !is_finite(found->second)) return false;
    out.push_back(found->second);
  }
  return true;
}

bool read_answer(const std::string& path, const ElasticProblem& p, ElasticAnswer& answer) {
  const auto text = model::io::read_file(path);
  if (!text) return false;
  std::istringstream file(*text);
  const DeckAxes axes = deck_axes(p.load.direction);
  std::vector<Vec3> force_mN;
  if (p.load.ball) {
    const auto itself = [](std::uint32_t n) { return n; };
    if (!read_forces(file, "HELD", p.held, itself, force_mN)) return false;
    // What is held keeps the body from following the ball.
    for (const Vec3& f : force_mN) answer.force_N -= axes.from_deck(f) * kNPerMN;
  } else {
    const auto node_of = [](const MovedNode& m) { return m.node; };
    if (!read_forces(file, "MOVED", p.load.moved, node_of, force_mN)) return false;
    for (const Vec3& f : force_mN) {
      answer.moved_force_N.push_back(axes.from_deck(f) * kNPerMN);
      answer.force_N += answer.moved_force_N.back();
    }
  }
  std::unordered_map<std::uint32_t, Vec3> displacement_mm;
  if (!read_vectors(file, "displacements (vx,vy,vz) for set REPORTED", displacement_mm))
    return false;
  for (const std::uint32_t n : p.reported) {
    const auto found = displacement_mm.find(n);
    if (found == displacement_mm.end() || !is_finite(found->second)) return false;
    answer.displacement_m.push_back(axes.from_deck(found->second) / kMmPerM);
  }
  return true;
}

Result<std::string> run_ccx(const program::ScratchFolder& folder,
                            std::vector<std::string> arguments, bool any_status) {
  return program::run_program(
      {.program = "ccx",
       .arguments = std::move(arguments),
       .directory = folder.path(),
       .log_path = folder.file("ccx.log"),
       .package = "calculix-ccx",
       .time_limit_s = kTimeLimit_s,
       .any_status = any_status,
       // One core a solve: --jobs runs several.
       .environment = {{"OMP_NUM_THREADS", "1"}, {"CCX_NPROC_STIFFNESS", "1"}}});
}

}  // namespace

Result<ElasticAnswer> solve_with_calculix(const ElasticProblem& problem) {
  auto folder = program::ScratchFolder::make("tact-ccx");
  if (!folder) return folder.error();
  if (auto error = model::io::write_file(folder->file("case.inp"), deck_of(problem))) return *error;
  const auto said = run_ccx(*folder, {"-i", "case"}, false);
  if (!said) {
    if (!program::was_interrupted(said.error())) folder->keep();
    if (said.error().message.rfind("ccx ended", 0) != 0) return said.error();
    return Error{fmt::format("{}: {}", kNoSolution, said.error().message)};
  }
  ElasticAnswer answer;
  if (read_answer(folder->file("case.dat"), problem, answer)) return answer;
  Error error{
      fmt::format("{}; its deck case.inp and ccx.log are in {}", kNoSolution, folder->path())};
  folder->keep();
  return error;
}

bool found_no_solution(const Error& error) { return error.message.rfind(kNoSolution, 0) == 0; }

Result<std::string> calculix_version() {
  auto folder = program::ScratchFolder::make("tact-ccx");
  if (!folder) return folder.error();
  auto said = run_ccx(*folder, {"-v"}, true);  // ends with 201
  if (!said) return said;
  // "This is Version 2.20"
  const auto at = said->rfind(' ');
  std::string version = at == std::string::npos ? *said : said->substr(at + 1);
  while (!version.empty() && version.back() <= ' ') version.pop_back();
  return version;
}

}  // namespace tact::tools::reference
