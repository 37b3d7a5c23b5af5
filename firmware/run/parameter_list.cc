// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/parameter_list.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "hal/registry/open_device.h"
#include "model/io/json.h"

namespace tact::firmware::run {

using model::reader::SceneNumber;

std::string parameters_as_text(const std::vector<SceneNumber>& numbers) {
  std::string text;
  for (const SceneNumber& number : numbers)
    fmt::format_to(std::back_inserter(text), "{:<42} {:<10g} {} .. {}{}{}{}  {}\n", number.key,
                   number.value, number.low, number.high, number.unit.empty() ? "" : " ",
                   number.unit, number.is_whole ? ", whole" : "", number.meaning);
  return text;
}

std::string parameters_as_json(const model::scene::Scene& scene,
                               const std::vector<SceneNumber>& numbers) {
  nlohmann::json list = nlohmann::json::array();
  for (const SceneNumber& number : numbers)
    list.push_back({{"key", number.key},
                    {"unit", number.unit},
                    {"value", number.value},
                    {"low", number.low},
                    {"high", number.high},
                    {"whole", number.is_whole},
                    {"meaning", number.meaning}});
  const nlohmann::json out{{"format", "tactd-parameters"},
                           {"version", 1},
                           {"scene", scene.name},
                           {"law", model::scene::name_of(scene.law)},
                           {"simulated", hal::registry::is_simulated(scene.device)},
                           {"parameters", list}};
  return model::io::text_of(out, 2) + "\n";
}

}  // namespace tact::firmware::run
