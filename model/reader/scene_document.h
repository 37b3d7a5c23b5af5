// SPDX-License-Identifier: Apache-2.0
// scene_document.h - a scene's TOML text with the overrides laid over it.
//
// Every node keeps the place it came from: file and line, or the override as it was typed. An
// override is "key.path=value": the value as TOML writes it, or a bare word for text; an entry of
// an array of sections is named by its number, from 0: hand.stroke.0.depth_m=0.01.
// toml++ parses; this file only adds places and overrides. Set-up code only.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <string>
#include <vector>

#include "model/result.h"

namespace tact::model::reader {

struct TextPosition {
  std::string where;       // "liver.toml:12" or "--set key=value"
  std::uint32_t line = 0;  // 0 for an override
};

struct SceneDocument {
  std::string path;
  toml::table root;
  std::string hash;  // of the text and the overrides, 16 hex digits

  TextPosition position_of(const toml::node& node) const;
};

/// A file that a document names: absolute, or from the folder of the document.
std::string path_beside(const std::string& document, const std::string& file);

/// Parse the file and lay the overrides over it in order; the meaning of keys is not looked at.
Result<SceneDocument> load_scene_document(const std::string& path,
                                          const std::vector<std::string>& overrides);

}  // namespace tact::model::reader
