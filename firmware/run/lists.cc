// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/lists.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "firmware/run/CITATION.cff.h"
#include "hal/registry/open_device.h"
#include "model/io/json.h"
#include "model/io/program/command_line.h"
#include "model/reader/scene_text.h"
#include "model/scene/variant.h"

namespace tact::firmware::run {

using hal::list::FoundPart;

std::string devices_as_text(const std::vector<FoundPart>& parts,
                            const std::vector<hal::UsbPart>& looked_for) {
  std::string text;
  auto out = std::back_inserter(text);
  for (const FoundPart& part : parts) {
    fmt::format_to(out, "{}: {}\n", part.name, part.what);
    // A ready part gives the lines for a scene; any other what it lacks, and the remedy.
    if (part.lacking.empty())
      fmt::format_to(out, "  ready: {}\n", part.scene);
    else
      fmt::format_to(out, "  not ready: {}\n  remedy: {}\n", part.lacking, part.remedy);
  }
  for (const std::string& absent : hal::list::absent_parts(parts, looked_for))
    fmt::format_to(out, "{}\n", absent);
  text += "sim-delta: the simulated device\n  ready: device.kind = \"sim-delta\"\n";
  return text;
}

std::string devices_as_json(const std::vector<FoundPart>& parts) {
  nlohmann::json list = nlohmann::json::array();
  for (const FoundPart& part : parts)
    list.push_back({{"kind", part.kind},
                    {"name", part.name},
                    {"what", part.what},
                    {"scene", part.scene},
                    {"ready", part.lacking.empty()},
                    {"lacking", part.lacking},
                    {"remedy", part.remedy}});
  return model::io::text_of(
             nlohmann::json{{"format", "tactd-devices"}, {"version", 1}, {"devices", list}}, 2) +
         "\n";
}

std::string parameters_as_text(model::scene::Scene scene) {
  std::string text;
  for (const auto& [key, p] : law_numbers(scene)) {
    const std::string_view unit = model::io::unit_of(p.key);
    fmt::format_to(std::back_inserter(text), "{:<42} {:<10g} {} .. {}{}{}{}  {}\n", key, p.value(),
                   p.range.low, p.range.high, unit.empty() ? "" : " ", unit,
                   p.count ? ", whole" : "", p.meaning);
  }
  return text;
}

std::string parameters_as_json(model::scene::Scene scene) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [key, p] : law_numbers(scene))
    list.push_back({{"key", key},
                    {"unit", model::io::unit_of(p.key)},
                    {"value", p.value()},
                    {"low", p.range.low},
                    {"high", p.range.high},
                    {"whole", p.count != nullptr},
                    {"live", p.number != nullptr},
                    {"meaning", p.meaning}});
  const nlohmann::json out{{"format", "tactd-parameters"},
                           {"version", 1},
                           {"scene", scene.name},
                           {"law", scene.law},
                           {"simulated", hal::registry::is_simulated(scene.device)},
                           {"parameters", list}};
  return model::io::text_of(out, 2) + "\n";
}

std::string citation() {
  return fmt::format("{}commit: \"{}\"\n", kCitation, model::io::source_revision());
}

}  // namespace tact::firmware::run
