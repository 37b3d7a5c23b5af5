// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/compare/chart.h"

#include <fmt/format.h>

#include "model/io/json.h"
#include "tools/ground_truth/linear_places.h"
#include "tools/ground_truth/reference_fits.h"
#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"

namespace tact::tools::chart {
namespace {

using ground_truth::ToolReference;
using model::Error;
using model::Result;
using model::scene::Scene;
using nlohmann::json;

/// Pressed without relaxation and at small strain, as the reference is linear elastic; the memory
/// is that with the scene's relaxation.
Measured press(const Scene& scene, const Scene& elastic, const Variant& variant,
               const std::vector<ProbeCase>& cases, double pitch_m, const ChartOptions& options) {
  Measured out{.variant = variant};
  auto subject = make_subject(elastic, variant.sizes);
  if (subject) {
    out.answers = measure_answers(**subject, cases, pitch_m);
    if (!scene.relaxation.empty()) subject = make_subject(scene, variant.sizes);
  }
  if (!subject) {
    out.failure = subject.error().message;
    return out;
  }
  out.memory_bytes = (*subject)->memory_bytes();
  if (!options.tool_reference) return out;
  auto force_N = press_tool(sized(scene, variant.sizes), *options.tool_reference);
  if (force_N)
    out.tool = std::move(*force_N);
  else
    out.failure = force_N.error().message;
  return out;
}

void add_time(Measured& row, const Scene& scene, const TimingSettings& settings) {
  if (!row.failure.empty()) return;
  if (const auto timing = time_tool(sized(scene, row.variant.sizes), settings))
    row.timing = *timing;
  else
    row.failure = timing.error().message;
}

}  // namespace

json to_json(const Measured& m) {
  const model::scene::LawSizes& sizes = m.variant.sizes;
  json samples = json::array();
  for (const Sample& s : m.answers.samples)
    samples.push_back({{"site", s.site},
                       {"held_out", s.held_out},
                       {"depth_m", s.depth_m},
                       {"force_N", s.force_N},
                       {"reference_N", s.reference_N},
                       {"ring_m", s.ring_m},
                       {"reference_ring_m", s.reference_ring_m}});
  return {{"family", sizes.law},
          {"size", m.variant.size()},
          {"form", sizes.disc_form},
          {"table_knots", sizes.table_knots},
          {"size_count", sizes.size},
          {"failure", m.failure},
          {"samples", std::move(samples)},
          {"tool_N", m.tool ? json(*m.tool) : json()},
          {"settle_ticks", m.answers.settle_ticks},
          {"memory_bytes", m.memory_bytes},
          {"tick_median_us", m.timing.median_us},
          {"tick_p999_us", m.timing.p999_us},
          {"instructions", m.timing.instructions},
          {"ticks", m.timing.ticks},
          {"paused", m.timing.paused}};
}

json to_json(const ToolReference& reference) {
  json out = json::array();
  for (const ground_truth::ToolPoint& place : reference.places) {
    json cases = json::array();
    for (const ground_truth::ToolCase& c : place.cases)
      cases.push_back({{"depth_m", c.depth_m},
                       {"reference_N", c.force_N},
                       {"reference_error_ratio", c.force_error_ratio}});
    out.push_back({{"place", name_of(place)},
                   {"unseen", place.vertex.has_value()},
                   {"cases", std::move(cases)}});
  }
  return out;
}

std::optional<Error> add_tool_reference(json& job, ChartOptions& options, const Scene& scene,
                                        const std::string& path, const std::string& finite_strain) {
  if (path.empty()) return std::nullopt;
  auto linear = ground_truth::read_tool_reference(path);
  if (!linear) return linear.error();
  if (auto differs = check_tool_reference_fits(*linear, scene)) return differs;
  job["dropped"] = json::array();
  if (!finite_strain.empty()) {
    const auto finite = ground_truth::read_tool_reference(finite_strain);
    if (!finite) return finite.error();
    if (auto differs = check_tool_reference_fits(*finite, scene)) return differs;
    const auto dropped = ground_truth::drop_contradicted(*linear, *finite);
    if (!dropped) return dropped.error();
    for (const ground_truth::DroppedPlace& place : *dropped)
      job["dropped"].push_back({{"place", place.place},
                                {"depth_m", place.depth_m},
                                {"linear_error_ratio", place.linear_error_ratio}});
  }
  job["places"] = to_json(*linear);
  options.tool_reference = std::move(*linear);
  return std::nullopt;
}

Result<std::vector<Measured>> measure_chart(const Scene& scene,
                                            const ground_truth::ReferenceData& reference,
                                            const ChartOptions& options) {
  const auto cases = cases_of(scene, reference);
  if (!cases) return cases.error();
  const std::vector<Variant> variants = variants_of(scene, options.request);
  if (options.tool_reference)
    if (auto differs = check_tool_reference_fits(*options.tool_reference, scene))
      return std::move(*differs);
  if (variants.empty())
    return Error{
        fmt::format("{}: none of the wanted laws is described; write its section or "
                    "leave out --laws",
                    scene.path)};
  Scene elastic = scene;
  elastic.relaxation.clear();
  elastic.compliance.large_strain = false;
  std::vector<Measured> all(variants.size());
  const program::SweepOptions on_all_cores{.label = options.label + ", accuracy"};
  const bool pressed = run_jobs(variants.size(), on_all_cores, [&](std::size_t job) {
    all[job] = press(scene, elastic, variants[job], *cases, reference.ring_pitch_m, options);
  });
  if (!pressed) return program::interruption();
  // One after the other: a second one on another core would share cache and memory with the first.
  const program::SweepOptions one_by_one{.label = options.label + ", time", .threads = 1};
  const bool timed = run_jobs(variants.size(), one_by_one,
                              [&](std::size_t job) { add_time(all[job], scene, options.timing); });
  if (!timed) return program::interruption();
  return all;
}

Result<std::vector<Measured>> measure_tool(const Scene& scene, const ChartOptions& options) {
  std::vector<Measured> all;
  for (const std::string& law : wanted_laws(scene, options.request)) {
    Measured row{.variant = {{.law = law}}};
    if (auto differs = check_tool_reference_fits(*options.tool_reference, scene))
      return std::move(*differs);
    auto force_N = press_tool(sized(scene, row.variant.sizes), *options.tool_reference);
    if (program::is_interrupted()) return program::interruption();
    if (force_N)
      row.tool = std::move(*force_N);
    else
      row.failure = force_N.error().message;
    add_time(row, scene, options.timing);
    all.push_back(std::move(row));
  }
  if (all.empty()) return Error{"none of the wanted laws is described; leave out --laws"};
  return all;
}

Result<json> read_chart(const std::string& path) {
  constexpr const char* kRemedy = "make it: tact-lab chart SCENE --reference FILE --out DIR";
  auto document = model::io::read_json(path, kRemedy);
  if (!document) return document.error();
  const auto& d = *document;
  if (!d.is_object() || !d.contains("rows") || !d["rows"].is_array() ||
      d.value("format", json()) != "tact-chart" || d.value("version", json()) != kChartVersion)
    return Error{fmt::format("{}: is no chart of this version; {}", path, kRemedy)};
  return d["rows"];
}

Result<json> peers_of(const std::string& path, const std::string& reference_hash) {
  if (path.empty()) return json::array();
  auto rows = read_chart(path);
  if (!rows) return rows;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const json& row = (*rows)[i];
    if (!row.is_object() || row.value("kind", json()) != "peer" ||
        row.value("reference_hash", json()) != reference_hash)
      return Error{fmt::format(
          "{}: row {} is no peer that was measured against this --reference; leave out --peers",
          path, i)};
  }
  return rows;
}

}  // namespace tact::tools::chart
