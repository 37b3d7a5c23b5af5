// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/evidence/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "model/io/input_file.h"
#include "model/io/limits_checksum.h"
#include "model/io/seal.h"
#include "tools/report/head.h"

namespace tact::tools::limits {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

constexpr std::size_t kLongestNumber = 60;

/// The file of this program, links followed; empty if it is not known.
fs::path own_program() {
  std::error_code none;
  return fs::read_symlink("/proc/self/exe", none);
}

Result<std::string> digest_of_file(const std::string& path) {
  const auto bytes = model::io::read_file(path);
  if (!bytes) return bytes.error();
  return model::io::sha256_of(*bytes);
}

}  // namespace

std::optional<Error> check_number(const std::string& number) {
  // It goes into the foot of each page by CSS: nothing there may end a string.
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view(" -_./").find(c) != std::string_view::npos;
  };
  if (number.size() <= kLongestNumber && std::all_of(number.begin(), number.end(), is_plain))
    return std::nullopt;
  return Error{fmt::format(
      "--report-number: at most {} letters, digits, blanks and -_./, as it is on every page",
      kLongestNumber)};
}

Result<Evidence> collect_evidence(const std::string& scene_path,
                                  const std::vector<std::string>& overrides,
                                  const Testers& people) {
  Evidence out;
  out.people = people;
  out.began_utc = report::now_utc();
  out.overrides = overrides;
  out.host = report::host_name();
  auto scene = model::io::read_file(scene_path);
  if (!scene) return scene.error();
  out.scene_text = std::move(*scene);
  out.scene_sha256 = model::io::sha256_of(out.scene_text);
  const fs::path own = own_program();
  auto digest = digest_of_file(own.string());
  if (!digest) return digest.error();
  out.program_sha256 = std::move(*digest);
  std::error_code none;
  const fs::path tactd = own.parent_path() / "tactd";
  if (!fs::exists(tactd, none)) return out;
  digest = digest_of_file(tactd.string());
  if (!digest) return digest.error();
  out.tactd_sha256 = std::move(*digest);
  out.tactd_path = tactd.string();
  return out;
}

void close_evidence(Evidence& evidence, const model::Limits& in_use) {
  evidence.ended_utc = report::now_utc();
  evidence.limits_text = model::io::limits_text(in_use);
  evidence.limits_sha256 = model::io::sha256_of(evidence.limits_text);
  evidence.limits_checksum = model::io::limits_checksum(in_use);
  if (!evidence.people.number.empty()) return;
  std::string began = evidence.began_utc;  // 20261125T164002Z-1a2b3c4d-3f00
  std::erase_if(began, [](char c) { return c == '-' || c == ':'; });
  const std::string rest = model::io::sha256_of(evidence.host + evidence.scene_sha256);
  // Two reports of one second differ by host and scene.
  evidence.people.number =
      fmt::format("TL-{}-{}-{}", began, evidence.limits_checksum, rest.substr(0, 4));
}

}  // namespace tact::tools::limits
