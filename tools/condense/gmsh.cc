// SPDX-License-Identifier: Apache-2.0
#include "tools/condense/gmsh.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>
#include <unordered_map>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "tools/program/run_program.h"

namespace tact::tools::condense {
namespace {

using model::Error;
using model::Result;
using model::Vec3;
using model::contact::TriangleCorners;
using model::fem::edge_key;
using model::fem::kTetEdge;
using model::fem::TetMesh;

constexpr double kTimeLimit_s = 1800.0;
constexpr double kMm = 1e3;  // gmsh works in mm: its tolerances suit numbers near one
constexpr int kTetrahedron = 4;

bool write_surface(const std::string& path, std::span<const Vec3> vertex_m,
                   std::span<const TriangleCorners> triangle) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", vertex_m.size());
  std::size_t number = 0;
  for (const Vec3& p : vertex_m)
    fmt::format_to(out, "{} {} {} {}\n", ++number, p.x * kMm, p.y * kMm, p.z * kMm);
  fmt::format_to(out, "$EndNodes\n$Elements\n{}\n", triangle.size());
  number = 0;
  for (const TriangleCorners& t : triangle)
    fmt::format_to(out, "{} 2 2 1 1 {} {} {}\n", ++number, t[0] + 1, t[1] + 1, t[2] + 1);
  fmt::format_to(out, "$EndElements\n");
  return !model::io::write_file(path, {text.data(), text.size()});
}

bool write_script(const std::string& path, double edge_m) {
  const std::string text = fmt::format(
      "Merge \"surface.msh\";\n"
      "Surface Loop(1) = {{1}};\nVolume(1) = {{1}};\n"
      "Field[1] = MathEval;\n"
      "Field[1].F = \"{}\";\n"
      "Background Field = 1;\n"
      "Mesh.CharacteristicLengthExtendFromBoundary = 0;\n"
      "Mesh.CharacteristicLengthFromPoints = 0;\n"
      "Mesh.Algorithm3D = 1;\nMesh.Optimize = 1;\n"
      "Mesh.MshFileVersion = 2.2;\nMesh.Binary = 0;\nMesh.SaveAll = 1;\n",
      edge_m * kMm);
  return !model::io::write_file(path, text);
}

/// Whitespace-separated numbers of a file that another program wrote.
class Numbers {
 public:
  explicit Numbers(const std::string& text) : at_(text.data()), end_(text.data() + text.size()) {}
  bool find(std::string_view word) {
    const std::string_view rest{at_, static_cast<std::size_t>(end_ - at_)};
    const auto found = rest.find(word);
    if (found == std::string_view::npos) return false;
    at_ += found + word.size();
    return true;
  }
  template <typename T>
  bool next(T& number) {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r')) ++at_;
    const auto [rest, error] = std::from_chars(at_, end_, number);
    at_ = rest;
    return error == std::errc{};
  }

 private:
  const char* at_;
  const char* end_;
};

/// Corners only; false where the file is not what was asked for.
bool read_body(const std::string& text, std::span<const Vec3> vertex_m, TetMesh& body) {
  Numbers numbers(text);
  std::size_t nodes = 0, elements = 0;
  if (!numbers.find("$Nodes") || !numbers.next(nodes) || nodes < vertex_m.size()) return false;
  std::unordered_map<std::size_t, std::uint32_t> index;  // gmsh's numbers may have gaps
  for (std::size_t i = 0; i < nodes; ++i) {
    std::size_t number = 0;
    Vec3 p;
    if (!numbers.next(number) || !numbers.next(p.x) || !numbers.next(p.y) || !numbers.next(p.z))
      return false;
    index[number] = static_cast<std::uint32_t>(i);
    body.node_m.push_back(p / kMm);
    if (i >= vertex_m.size()) continue;
    if (number != i + 1 || norm(body.node_m[i] - vertex_m[i]) > 1e-9) return false;
    body.node_m[i] = vertex_m[i];
  }
  if (!numbers.find("$Elements") || !numbers.next(elements)) return false;
  for (std::size_t i = 0; i < elements; ++i) {
    std::size_t number = 0, tags = 0, skipped = 0;
    int type = 0;
    if (!numbers.next(number) || !numbers.next(type) || !numbers.next(tags)) return false;
    for (std::size_t k = 0; k < tags; ++k)
      if (!numbers.next(skipped)) return false;
    constexpr std::size_t kCorners[] = {0, 2, 3, 4, 4};
    const std::size_t corners = type <= kTetrahedron ? kCorners[type] : 1;  // 15: a point
    model::fem::TetNodes nodes_of{};
    for (std::size_t k = 0; k < corners; ++k) {
      if (!numbers.next(skipped) || index.count(skipped) == 0) return false;
      nodes_of[k] = index[skipped];
    }
    if (type == kTetrahedron) body.element.push_back(nodes_of);
  }
  return !body.element.empty();
}

/// Middles of all edges, each once, in the order of TetNodes.
void add_middles(TetMesh& body) {
  std::unordered_map<std::uint64_t, std::uint32_t> middle;
  for (auto& e : body.element) {
    const Vec3 o = body.node_m[e[0]];
    const Vec3 a = body.node_m[e[1]] - o, b = body.node_m[e[2]] - o, c = body.node_m[e[3]] - o;
    if (dot(a, cross(b, c)) < 0.0) std::swap(e[1], e[2]);
    for (std::size_t k = 0; k < kTetEdge.size(); ++k) {
      const std::uint32_t p = e[kTetEdge[k][0]], q = e[kTetEdge[k][1]];
      const auto [at, is_new] = middle.try_emplace(edge_key(p, q), body.node_m.size());
      if (is_new) body.node_m.push_back(0.5 * (body.node_m[p] + body.node_m[q]));
      e[4 + k] = at->second;
    }
  }
}

}  // namespace

Result<TetMesh> fill_with_gmsh(std::span<const Vec3> vertex_m,
                               std::span<const TriangleCorners> triangle, double edge_m) {
  auto folder = program::ScratchFolder::make("tact-gmsh");
  if (!folder) return folder.error();
  if (!write_surface(folder->file("surface.msh"), vertex_m, triangle) ||
      !write_script(folder->file("fill.geo"), edge_m)) {
    return Error{fmt::format("{} cannot be written; the disk may be full", folder->path())};
  }
  const auto said = program::run_program(
      {.program = "gmsh",
       .arguments = {"fill.geo", "-3", "-nt", "1", "-format", "msh2", "-o", "body.msh"},
       .directory = folder->path(),
       .log_path = folder->file("gmsh.log"),
       .package = "gmsh",
       .time_limit_s = kTimeLimit_s,
       .any_status = false,
       .environment = {}});
  if (!said) {
    if (!program::was_interrupted(said.error())) folder->keep();
    return said.error();
  }
  const auto text = model::io::read_file(folder->file("body.msh"));
  TetMesh body;
  if (!text || !read_body(*text, vertex_m, body)) {
    Error error{fmt::format(
        "gmsh could not fill the surface; see {}/gmsh.log, and ask tact-mesh whether the surface "
        "is closed and does not cross itself",
        folder->path())};
    folder->keep();
    return error;
  }
  add_middles(body);
  return body;
}

Result<std::string> gmsh_version() {
  auto folder = program::ScratchFolder::make("tact-gmsh");
  if (!folder) return folder.error();
  auto said = program::run_program({.program = "gmsh",
                                    .arguments = {"--version"},
                                    .directory = folder->path(),
                                    .log_path = folder->file("gmsh.log"),
                                    .package = "gmsh",
                                    .time_limit_s = 60.0,
                                    .any_status = false,
                                    .environment = {}});
  if (said)
    while (!said->empty() && said->back() <= ' ') said->pop_back();
  return said;
}

}  // namespace tact::tools::condense
