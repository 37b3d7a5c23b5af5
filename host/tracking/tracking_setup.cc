// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/tracking_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "host/tracking/observation.h"
#include "host/tracking/tracking_keys.h"

namespace tact::host::tracking {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

// Chosen bounds: beyond any camera, any operator, any marker body; a wrong unit shows.
constexpr double kMax_px = 1e6;
constexpr double kFarthestShoulder_m = 3.0;
constexpr double kFarthestMarker_m = 10.0;
constexpr double kOutlierTangent = 0.0025;  // as 3 px with f = 1200 px
// EPnP's least (epnp.h).
constexpr std::size_t kMinMarkers = 4;
constexpr std::size_t kMaxSections = 32;
constexpr const char* kBase = "base";
constexpr const char* kSuffix = ".tracking.toml";

constexpr std::array<const char*, kBodyRoles> kRoleNames = {
    "head",      "shoulder",   "waist",       "wrist", "hand",      "left_leg",
    "right_leg", "left_ankle", "right_ankle", "tool",  "left_hand", "elbow"};

void read_name(TrackingKeys& k, std::string& out) {
  out = k.text("name");
  if (!is_tracking_name(out)) k.refuse("name", "name must be 1 to 32 letters, digits, _ or -");
}

void read_input(TrackingKeys& k, TrackingSetup& out) {
  k.only({"udp_port", "recording"});
  // Both or none: equal.
  if (k.has("udp_port") == k.has("recording"))
    return k.refuse("udp_port", "[input] takes udp_port or recording, one of them; write one");
  if (k.has("udp_port")) {
    const double port = k.number("udp_port", 1, 65535);
    if (port != std::floor(port))
      k.refuse("udp_port", "udp_port must be a whole number; write one");
    out.udp_port = static_cast<std::uint16_t>(port);
  } else {
    // Beside the description, wherever the program was started.
    out.recording = (fs::path(out.path).parent_path() / k.text("recording")).string();
  }
}

/// False if so many sections came before: checked first, names are compared with all of them.
bool has_room(TrackingKeys& k, std::size_t before) {
  if (before < kMaxSections) return true;
  k.refuse("name", fmt::format("more than {} cameras or bodies; leave some out", kMaxSections));
  return false;
}

void read_camera(TrackingKeys& k, TrackingSetup& out) {
  if (!has_room(k, out.cameras.size())) return;
  TrackingCamera camera;
  k.only({"name", "sweep", "fx_px", "fy_px", "cx_px", "cy_px", "outlier_px", "position_m",
          "rotation_wxyz"});
  read_name(k, camera.name);
  const bool sweep = k.flag("sweep");
  if (sweep) {
    // Tangents are pixels of a camera with focal length 1 (epnp.h).
    camera.lens = {.fx_px = 1.0, .fy_px = 1.0};
    camera.outlier_px = kOutlierTangent;
    for (const char* key : {"fx_px", "fy_px", "cx_px", "cy_px"}) {
      if (!k.has(key)) continue;
      k.refuse(key, fmt::format("a sweep tracker measures tangents; leave {} out", key));
    }
  } else {
    camera.lens = {.fx_px = k.number("fx_px", 1.0, kMax_px),
                   .fy_px = k.number("fy_px", 1.0, kMax_px),
                   .cx_px = k.number("cx_px", -kMax_px, kMax_px),
                   .cy_px = k.number("cy_px", -kMax_px, kMax_px)};
  }
  if (k.has("outlier_px")) camera.outlier_px = k.number("outlier_px", 1e-6, 1e3);
  if (k.has("position_m") || k.has("rotation_wxyz")) camera.pose = k.pose();
  const bool twice = std::ranges::any_of(
      out.cameras, [&](const TrackingCamera& other) { return other.name == camera.name; });
  if (twice) k.refuse("name", fmt::format("two cameras are called {}; rename one", camera.name));
  out.cameras.push_back(std::move(camera));
}

void read_role(TrackingKeys& k, const TrackingSetup& out, MarkerBody& body) {
  const std::string role = k.text("role");
  const auto found = std::ranges::find(kRoleNames, role);
  if (found != kRoleNames.end()) {
    body.role = static_cast<BodyRole>(found - kRoleNames.begin());
  } else if (role != kBase) {
    // The base has no role of the operator: it is the tracker's own frame.
    k.refuse("role", fmt::format("role is none of: {}, {}; write one of them",
                                 fmt::join(kRoleNames, ", "), kBase));
  }
  for (const MarkerBody& other : out.bodies) {
    if (other.name == body.name) k.refuse("name", "two bodies have this name; rename one");
    if (other.role == body.role) k.refuse("role", "two bodies have this role; leave one out");
  }
}

void read_markers(TrackingKeys& k, MarkerBody& body) {
  for (const std::vector<double>& row :
       // Any number here: id and metres have different bounds, each told below.
       k.rows("markers_m", 4, std::numeric_limits<double>::max())) {
    const double id = row[0];
    const Eigen::Vector3d p(row[1], row[2], row[3]);
    if (!(id >= 0.0 && id <= 1e9) || id != std::floor(id)) {
      k.refuse("markers_m", "a marker's id must be a whole number from 0 to 1e9");
      return;
    }
    if (!(p.cwiseAbs().maxCoeff() <= kFarthestMarker_m)) {
      k.refuse("markers_m", "a marker is more than 10 m from its body; write metres");
      return;
    }
    const auto number = static_cast<std::uint32_t>(id);
    if (std::ranges::any_of(body.markers, [&](const BodyMarker& m) { return m.id == number; }))
      k.refuse("markers_m", fmt::format("marker {} is there twice; number them apart", number));
    body.markers.push_back({.id = number, .position_m = p});
  }
  if (body.markers.size() < kMinMarkers || body.markers.size() > kMaxMarkers) {
    k.refuse("markers_m", fmt::format("a body takes 4 to {} markers; 6 or more, not in a plane, "
                                      "are advised",
                                      kMaxMarkers));
  }
}

void read_body(TrackingKeys& k, TrackingSetup& out) {
  if (!has_room(k, out.bodies.size())) return;
  MarkerBody body;
  k.only({"name", "role", "markers_m", "tip_m"});
  read_name(k, body.name);
  read_role(k, out, body);
  read_markers(k, body);
  if (k.has("tip_m")) {
    if (body.role != BodyRole::kTool)
      k.refuse("tip_m", "only role = \"tool\" has tip_m; leave it out");
    const std::vector<double> tip_m = k.numbers("tip_m", 3, kFarthestMarker_m);
    body.tip_m = Eigen::Vector3d(tip_m[0], tip_m[1], tip_m[2]);
  }
  out.bodies.push_back(std::move(body));
}

void check_base(TrackingKeys& k, const TrackingSetup& out) {
  const bool has_base =
      std::ranges::any_of(out.bodies, [](const MarkerBody& body) { return !body.role; });
  for (const TrackingCamera& camera : out.cameras) {
    if (camera.pose || has_base) continue;
    k.refuse("camera",
             fmt::format("camera {} has no position_m and rotation_wxyz; write them, or add a body "
                         "with role = \"base\"",
                         camera.name));
  }
}

void read_operator(TrackingKeys& k, TrackingSetup& out) {
  k.only({"shoulder_m"});
  const std::vector<double> p_m = k.numbers("shoulder_m", 3, kFarthestShoulder_m);
  out.shoulder_m = Eigen::Vector3d(p_m[0], p_m[1], p_m[2]);
}

void read_registration(TrackingKeys& k, const std::string& path, TrackingSetup& out) {
  k.section("registration", [&](TrackingKeys& section) {
    section.only({"position_m", "rotation_wxyz"});
    out.registration = section.pose();
    out.registered_by = path;
  });
}

/// From the file beside the description, if there is one.
std::optional<Error> read_registration_beside(TrackingSetup& out) {
  const std::string path = registration_path(out.path);
  std::error_code unreadable;
  if (!fs::exists(path, unreadable)) return std::nullopt;
  const Result<toml::table> file = parse_toml_file(path);
  if (!file) return file.error();
  std::optional<Error> error;
  TrackingKeys keys(*file, path, error);
  keys.only({"registration"});
  read_registration(keys, path, out);
  return error;
}

}  // namespace

const char* name_of(BodyRole role) { return kRoleNames[static_cast<std::size_t>(role)]; }

const MarkerBody* TrackingSetup::body_of(BodyRole role) const {
  const auto found = std::ranges::find(bodies, role, &MarkerBody::role);
  return found == bodies.end() ? nullptr : &*found;
}

std::string registration_path(const std::string& tracking_path) {
  const std::string_view suffix(kSuffix);
  std::string stem = tracking_path;
  if (stem.ends_with(suffix))
    stem.resize(stem.size() - suffix.size());
  else if (const fs::path p(tracking_path); p.has_extension())
    stem.resize(stem.size() - p.extension().string().size());
  return stem + ".registration.toml";
}

Result<TrackingSetup> load_tracking_setup(const std::string& path) {
  const Result<toml::table> root = parse_toml_file(path);
  if (!root) return root.error();
  TrackingSetup out;
  out.path = path;
  std::optional<Error> error;
  TrackingKeys k(*root, path, error);
  k.only({"input", "camera", "body", "operator", "registration"});
  k.section("input", [&](TrackingKeys& keys) { read_input(keys, out); });
  k.sections("camera", [&](TrackingKeys& keys) { read_camera(keys, out); });
  k.sections("body", [&](TrackingKeys& keys) { read_body(keys, out); });
  check_base(k, out);
  if (k.has("operator"))
    k.section("operator", [&](TrackingKeys& keys) { read_operator(keys, out); });
  // The description's own section goes first; a file beside it is not even opened then.
  if (k.has("registration"))
    read_registration(k, path, out);
  else if (!error)
    error = read_registration_beside(out);
  if (error) return *error;
  return out;
}

}  // namespace tact::host::tracking
