// SPDX-License-Identifier: Apache-2.0
// tracking_keys.h - reads the keys of a tracking description and says file:line of what is wrong.
//
// toml++ parses. The first thing that is wrong is kept; what follows is read for nothing. Set-up
// code only.
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/pose/coordinate_chain.h"
#include "model/result.h"

namespace tact::host::tracking {

using pose::Pose;

/// Parses the file, at most 1 MB. Error: what is wrong, where and the cure.
model::Result<toml::table> parse_toml_file(const std::string& path);

class TrackingKeys {
 public:
  TrackingKeys(const toml::table& table, std::string path, std::optional<model::Error>& error)
      : table_(table), path_(std::move(path)), error_(error) {}

  bool has(std::string_view key) const { return table_.contains(key); }
  /// Refuses a key that is not named here: most are slips of the pen.
  void only(std::initializer_list<std::string_view> keys);

  double number(std::string_view key, double least, double most);
  std::string text(std::string_view key);
  bool flag(std::string_view key);
  /// `count` finite numbers, each at most `most`.
  std::vector<double> numbers(std::string_view key, std::size_t count, double most);
  /// A list of lists of numbers, each of `count`.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t count, double most);
  /// position_m and rotation_wxyz.
  Pose pose();

  void section(std::string_view key, const std::function<void(TrackingKeys&)>& visit);
  /// [[key]], one or more.
  void sections(std::string_view key, const std::function<void(TrackingKeys&)>& visit);

  /// Says that this key (or the table, if it is not there) is wrong.
  void refuse(std::string_view key, const std::string& sentence);

 private:
  const toml::table& table_;
  std::string path_;
  std::optional<model::Error>& error_;
};

}  // namespace tact::host::tracking
