// SPDX-License-Identifier: Apache-2.0
#include "model/scene/compliance_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "model/fnv1a.h"
#include "model/indent/compliance_law.h"
#include "model/io/input_file.h"
#include "model/reader/scene_text.h"

namespace tact::model::scene {
namespace {

constexpr std::size_t kSidewaysFloats = 7;

static_assert(std::endian::native == std::endian::little, "the file's bytes are the machine's");
static_assert(sizeof(tissue::SidewaysCompliance) == kSidewaysFloats * sizeof(float));

constexpr std::string_view kMagic = "TACTCOMP";
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHashDigits = 16;
// Of an OBJ file, too (mesh/obj_parser.h): before a size is computed from it.
constexpr std::uint32_t kMaxVertices = 10'000'000;

struct Header {
  std::uint32_t version = kVersion, vertices = 0, rings = 0, inclusions = 0;
  double poisson_ratio = 0.0, patch_radius_m = 0.0, ring_pitch_m = 0.0;
  Vec3 fixed_min_m{}, fixed_max_m{};
};
static_assert(sizeof(Header) == 4 * 4 + 9 * 8);
constexpr std::size_t kHeadBytes = kMagic.size() + sizeof(Header) + kHashDigits;

std::size_t floats_in(const Header& h) {
  return std::size_t{h.vertices} * (1 + kSidewaysFloats + std::size_t{h.rings});
}

template <typename T>
void take(std::string_view& bytes, T* first, std::size_t count) {
  std::memcpy(first, bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
}

std::optional<std::string> header_error(const Header& h) {
  if (h.vertices == 0 || h.vertices > kMaxVertices)
    return fmt::format("it says {} vertices", h.vertices);
  if (h.rings == 0 || h.rings > indent::kMaxComplianceRings)
    return fmt::format("it says {} rings, allowed 1 to {}", h.rings, indent::kMaxComplianceRings);
  const bool sound = h.poisson_ratio >= 0.0 && h.poisson_ratio < 0.5 && h.patch_radius_m > 0.0 &&
                     h.ring_pitch_m > 0.0 && is_finite(h.fixed_min_m) && is_finite(h.fixed_max_m);
  if (!sound) return "its numbers have no meaning";
  return std::nullopt;
}

// What the map holds of each vertex, in the order of the file.
void take_vertices(std::string_view& bytes, const Header& head, tissue::ComplianceMap& map) {
  map.regular_times_E_per_m.resize(head.vertices);
  map.sideways_times_E_per_m.resize(head.vertices);
  map.ring_times_E_per_m.resize(std::size_t{head.vertices} * head.rings);
  take(bytes, map.regular_times_E_per_m.data(), map.regular_times_E_per_m.size());
  take(bytes, map.sideways_times_E_per_m.data(), map.sideways_times_E_per_m.size());
  take(bytes, map.ring_times_E_per_m.data(), map.ring_times_E_per_m.size());
}

bool all_finite(const tissue::ComplianceMap& map) {
  const auto finite = [](float v) { return std::isfinite(v); };
  return std::ranges::all_of(map.regular_times_E_per_m, finite) &&
         std::ranges::all_of(map.ring_times_E_per_m, finite) &&
         std::ranges::all_of(map.sideways_times_E_per_m, [&](const tissue::SidewaysCompliance& s) {
           return finite(s.n1) && finite(s.n2) && finite(s.s1) && finite(s.s2) &&
                  std::ranges::all_of(s.axis, finite);
         });
}

}  // namespace

Result<tissue::ComplianceMap> read_compliance_map(const std::string& path) {
  const auto broken = [&path](const std::string& why) {
    return Error{fmt::format("{}: {}; make it again with tact-lab condense", path, why)};
  };
  const auto read = io::read_file(path, "make it again with tact-lab condense");
  if (!read) return read.error();
  const std::string& content = *read;
  std::string_view bytes = content;
  if (bytes.substr(0, kMagic.size()) != kMagic) return broken("is no compliance map");
  if (bytes.size() < kHeadBytes) return broken("ends within its header");
  bytes.remove_prefix(kMagic.size());
  Header head;
  take(bytes, &head, 1);
  if (head.version != kVersion)
    return broken(fmt::format("is of version {}, this program reads {}", head.version, kVersion));
  // Magic, version, numbers, length, checksum: each is asked only where the ones before are good.
  if (const auto wrong = header_error(head)) return broken("is damaged: " + *wrong);
  tissue::ComplianceMap map{.poisson_ratio = head.poisson_ratio,
                            .patch_radius_m = head.patch_radius_m,
                            .ring_pitch_m = head.ring_pitch_m,
                            .rings = head.rings,
                            .fixed_min_m = head.fixed_min_m,
                            .fixed_max_m = head.fixed_max_m,
                            .inclusions = head.inclusions,
                            .mesh_hash = std::string(bytes.substr(0, kHashDigits))};
  bytes.remove_prefix(kHashDigits);
  const std::size_t expected = floats_in(head) * sizeof(float) + sizeof(std::uint64_t);
  if (bytes.size() != expected)
    return broken(
        fmt::format("is damaged: {} bytes where {} belong", content.size(), kHeadBytes + expected));
  // The length is right by now: no memory is taken for what a broken header says.
  take_vertices(bytes, head, map);
  std::uint64_t sum = 0;
  take(bytes, &sum, 1);
  if (sum != fnv1a(std::string_view{content.data(), content.size() - sizeof sum}))
    return broken("is damaged: its checksum is wrong");
  // A sound checksum of values that are no numbers: they came so from the solver.
  if (!all_finite(map)) return broken("holds a value that is no finite number");
  return map;
}

std::string compliance_checksum(const std::string& path) {
  constexpr std::size_t kSum_bytes = sizeof(std::uint64_t);
  const auto bytes = io::read_file(path);
  if (!bytes || bytes->size() < kSum_bytes) return {};
  // Not computed: it identifies the file in the hash of a scene, and read_compliance_map checks it.
  return bytes->substr(bytes->size() - kSum_bytes);
}

std::uint32_t inclusions_hash(const ElasticSettings& elastic) {
  if (elastic.inclusions.empty()) return 0;
  std::string text;
  for (const Inclusion& lump : elastic.inclusions)
    text += fmt::format("{} {} {} {} {:.6g};", lump.center_m.x, lump.center_m.y, lump.center_m.z,
                        lump.radius_m, lump.youngs_modulus_Pa / elastic.youngs_modulus_Pa);
  return static_cast<std::uint32_t>(fnv1a(text)) | 1U;
}

std::string surface_hash(const contact::SurfaceView& surface) {
  // 0.1 um: a mesh that was moved or rounded is the same
  // organ; relative to a vertex, so place does not count.
  constexpr double kStep_m = 1e-7;
  reader::TextHash hash;
  for (const Vec3& p : surface.vertex_m) {
    const Vec3 d = p - surface.vertex_m[0];
    for (const double x : {d.x, d.y, d.z}) hash.add(std::to_string(std::llround(x / kStep_m)));
  }
  for (const contact::TriangleCorners& t : surface.triangle)
    for (const std::uint32_t corner : t) hash.add(std::to_string(corner));
  return hash.hex();
}

}  // namespace tact::model::scene
