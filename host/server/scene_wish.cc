// SPDX-License-Identifier: Apache-2.0
#include "host/server/scene_wish.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/server/page_message.h"
#include "model/io/json.h"

namespace tact::host::server {
namespace {

using model::Error;
using model::Result;

constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr std::string_view kCure = "write it anew: tactd SCENE --parameters --json FILE";

/// The launcher makes a file name and an option of it: no other sign may come that far.
bool is_word(std::string_view text, std::string_view more) {
  const auto good = [more](char c) {
    return kLetters.find(c) != kLetters.npos || more.find(c) != more.npos;
  };
  return !text.empty() && good(text.front()) && std::ranges::all_of(text, good);
}
bool is_name(std::string_view text) { return is_word(text, "0123456789_"); }
bool is_key(std::string_view text) { return is_word(text, "0123456789_."); }

using IsOfType = bool (nlohmann::json::*)() const noexcept;

/// A member of this type; null: there is none.
const nlohmann::json* member(const nlohmann::json& json, const char* key, IsOfType is_good) {
  const auto found = json.find(key);
  return found != json.end() && ((*found).*is_good)() ? &*found : nullptr;
}

std::optional<std::pair<std::string, OfferedNumber>> number_of(const nlohmann::json& row) {
  using Json = nlohmann::json;
  if (!row.is_object()) return std::nullopt;
  const auto* key = member(row, "key", &Json::is_string);
  const auto* low = member(row, "low", &Json::is_number);
  const auto* high = member(row, "high", &Json::is_number);
  const auto* whole = member(row, "whole", &Json::is_boolean);
  if (!key || !low || !high || !whole || !is_key(key->get<std::string>())) return std::nullopt;
  return std::pair{key->get<std::string>(),
                   OfferedNumber{low->get<double>(), high->get<double>(), whole->get<bool>()}};
}

}  // namespace

std::optional<SceneWish> parse_scene_wish(const std::string& text) {
  const nlohmann::json asked = object_in(text, "wish");
  if (asked.is_null()) return std::nullopt;
  SceneWish wish;
  for (const auto& [key, value] : asked.items()) {
    if (key == "scene" && value.is_string()) {
      wish.scene = value.get<std::string>();
    } else if (key == "set" && value.is_object()) {
      for (const auto& [name, number] : value.items()) {
        if (!number.is_number()) return std::nullopt;
        wish.set[name] = number.get<double>();
      }
    } else {
      return std::nullopt;  // half a wish would start what nobody asked for
    }
  }
  return wish;
}

Result<OfferedScene> parse_offer(const std::string& text, const std::string& source) {
  using Json = nlohmann::json;
  const auto error = [&source](std::string_view what) {
    return Error{fmt::format("{}: {}; {}", source, what, kCure)};
  };
  const auto json = model::io::parse_json(text, source);
  if (!json) return error("not JSON");
  if (!json->is_object() || json->value("format", Json()) != "tactd-parameters" ||
      json->value("version", Json()) != 1)
    return error("not the parameters of a scene");
  const auto* name = member(*json, "scene", &Json::is_string);
  const auto* rows = member(*json, "parameters", &Json::is_array);
  if (!name || !rows || !is_name(name->get<std::string>()))
    return error("names no scene, or one that is no plain word");
  if (json->value("simulated", Json()) != true)
    return error("the device of this scene is not simulated");
  OfferedScene offer{.name = name->get<std::string>(), .numbers = {}, .told = json->dump()};
  for (const nlohmann::json& row : *rows) {
    const auto number = number_of(row);
    if (!number) return error("a parameter without key, low, high or whole");
    offer.numbers.insert(*number);
  }
  return offer;
}

Result<std::vector<OfferedScene>> load_offers(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<OfferedScene> offers;
  std::error_code wrong;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, wrong)) {
    if (entry.path().extension() != ".json") continue;
    const auto text = model::io::read_file(entry.path().string(), kCure);
    if (!text) return text.error();
    auto offer = parse_offer(*text, entry.path().string());
    if (!offer) return offer.error();
    offers.push_back(std::move(*offer));
  }
  if (wrong || offers.empty())
    return Error{
        fmt::format("--scenes {}: no folder with parameters of scenes; {}", folder, kCure)};
  std::ranges::sort(offers, {}, &OfferedScene::name);
  return offers;
}

std::string list_of(const std::vector<OfferedScene>& offers) {
  std::string list;
  for (const OfferedScene& offer : offers) list += (list.empty() ? "[" : ",") + offer.told;
  return list + "]";
}

std::string why_not(const SceneWish& wish, const std::vector<OfferedScene>& offers) {
  const auto offer = std::ranges::find(offers, wish.scene, &OfferedScene::name);
  if (offer == offers.end())
    return fmt::format("there is no scene \"{}\" here", model::io::on_one_line(wish.scene));
  for (const auto& [key, value] : wish.set) {
    const auto number = offer->numbers.find(key);
    if (number == offer->numbers.end())
      return fmt::format("{} has no parameter {}", offer->name, model::io::on_one_line(key));
    const auto& [low, high, is_whole] = number->second;
    if (!(value >= low && value <= high))  // also of what is no number
      return fmt::format("{} = {} is out of range; allowed: {} .. {}", key, value, low, high);
    if (is_whole && value != std::floor(value))
      return fmt::format("{} = {} must be whole", key, value);
  }
  return {};
}

std::string line_of(const SceneWish& wish) {
  std::string line = "wish " + wish.scene;
  for (const auto& [key, value] : wish.set) line += fmt::format(" {}={}", key, value);
  return line;
}

}  // namespace tact::host::server
