// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/tracking_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "host/tracking/observation.h"
#include "model/io/input_file.h"
#include "model/io/toml.h"
#include "model/reader/scene_reader.h"

namespace tact::host::tracking {
namespace {

namespace fs = std::filesystem;
using model::Choice;
using model::Error;
using model::Need;
using model::Result;
using model::reader::Keys;

// Chosen bounds, beyond any camera, operator or marker body, to detect a wrong unit.
constexpr std::uintmax_t kMaxFile_bytes = 1'000'000;
constexpr double kFarthest_m = 100.0;
constexpr double kMax_px = 1e6;
constexpr double kFarthestShoulder_m = 3.0;
constexpr double kFarthestMarker_m = 10.0;
constexpr double kOutlierTangent = 0.0025;  // as 3 px with f = 1200 px
// The minimum of EPnP (epnp.h).
constexpr std::size_t kMinMarkers = 4;
constexpr std::size_t kMaxSections = 32;
constexpr const char* kSuffix = ".tracking.toml";
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr auto kBase = static_cast<std::size_t>(kBodyRoles);  // the index after the roles
constexpr std::array<Choice, kBodyRoles + 1> kRoles{{{"head", ""},
                                                     {"shoulder", ""},
                                                     {"waist", ""},
                                                     {"wrist", ""},
                                                     {"hand", ""},
                                                     {"left_leg", ""},
                                                     {"right_leg", ""},
                                                     {"left_ankle", ""},
                                                     {"right_ankle", ""},
                                                     {"tool", ""},
                                                     {"left_hand", ""},
                                                     {"elbow", ""},
                                                     {"base", ""}}};

/// As in TOML; kNone in a camera, body or section without a pose.
struct GivenPose {
  model::Vec3 position_m{kNone, kNone, kNone};
  std::array<double, 4> wxyz{kNone, kNone, kNone, kNone};
};

Eigen::Vector3d point_of(const model::Vec3& v_m) { return {v_m.x, v_m.y, v_m.z}; }

std::optional<Pose> read_pose(Keys& k, Need need) {
  GivenPose given;
  k.vector("position_m", {-kFarthest_m, kFarthest_m}, "origin", given.position_m, need);
  k.quaternion("rotation_wxyz", "axes", given.wxyz, need);
  const bool has_position = !std::isnan(given.position_m.x), has_turn = !std::isnan(given.wxyz[0]);
  if (has_position != has_turn)
    k.refuse({"position_m", "rotation_wxyz"},
             "position_m and rotation_wxyz go together: write both");
  if (!has_position || !has_turn) return std::nullopt;
  const auto rotation = pose::rotation_from(given.wxyz);
  if (!rotation)
    k.refuse({"rotation_wxyz"}, "rotation_wxyz has no direction; no turn is [1, 0, 0, 0]");
  return Pose{.rotation = rotation.value_or(Eigen::Quaterniond::Identity()),
              .position_m = point_of(given.position_m)};
}

std::optional<Eigen::Vector3d> read_point(Keys& k, const char* key, double most_m,
                                          const char* meaning, Need need) {
  model::Vec3 point_m{kNone, kNone, kNone};
  k.vector(key, {-most_m, most_m}, meaning, point_m, need);
  if (std::isnan(point_m.x)) return std::nullopt;
  return point_of(point_m);
}

void read_name(Keys& k, std::string& out) {
  k.text("name", "1 to 32 letters, digits, _ or -", out);
  if (!out.empty() && !is_tracking_name(out))
    k.refuse({"name"}, "name must be 1 to 32 letters, digits, _ or -");
}

void read_input(Keys& k, TrackingSetup& out) {
  std::size_t port = 0;
  std::string recording;
  k.count("udp_port", {1, 65535}, "on 127.0.0.1", port, Need::kOptional);
  k.text("recording", "beside this file", recording, Need::kOptional);
  if ((port == 0) == recording.empty())
    k.refuse({"udp_port"}, "[input] takes udp_port or recording, one of them; write one");
  out.udp_port = static_cast<std::uint16_t>(port);
  // Relative to the description, not to the working directory.
  if (!recording.empty()) out.recording = (fs::path(out.path).parent_path() / recording).string();
}

/// Tangents are pixels of a camera with focal length 1 (epnp.h).
void read_lens(Keys& k, TrackingCamera& camera) {
  bool sweep = false;
  k.flag("sweep", "measures tangents, not pixels", sweep, Need::kOptional);
  if (sweep) {
    camera.lens = {.fx_px = 1.0, .fy_px = 1.0};
    camera.outlier_px = kOutlierTangent;
  }
  const auto read = [&](const char* key, double least_px, double& out) {
    double given_px = kNone;
    k.number(key, {least_px, kMax_px}, "of the lens", given_px,
             sweep ? Need::kOptional : Need::kRequired);
    if (std::isnan(given_px)) return;
    if (sweep) k.refuse({key}, fmt::format("a sweep tracker measures tangents; leave {} out", key));
    out = given_px;
  };
  read("fx_px", 1.0, camera.lens.fx_px);
  read("fy_px", 1.0, camera.lens.fy_px);
  read("cx_px", -kMax_px, camera.lens.cx_px);
  read("cy_px", -kMax_px, camera.lens.cy_px);
  k.number("outlier_px", {1e-6, 1e3}, "a marker farther off is wrong", camera.outlier_px,
           Need::kOptional);
}

/// Read after the bodies, because a camera without a pose needs the base.
void read_camera(Keys& k, TrackingSetup& out) {
  TrackingCamera camera;
  read_name(k, camera.name);
  read_lens(k, camera);
  camera.pose = read_pose(k, Need::kOptional);
  if (std::ranges::find(out.cameras, camera.name, &TrackingCamera::name) != out.cameras.end())
    k.refuse({"name"}, fmt::format("two cameras are called {}; rename one", camera.name));
  const auto has_role = [](const MarkerBody& body) { return body.role.has_value(); };
  if (!camera.pose && std::ranges::all_of(out.bodies, has_role)) {
    k.refuse({"name"},
             fmt::format("camera {} has no position_m and rotation_wxyz; write them, or add a body "
                         "with role = \"base\"",
                         camera.name));
  }
  out.cameras.push_back(std::move(camera));
}

void read_role(Keys& k, const TrackingSetup& out, MarkerBody& body) {
  std::size_t role = kBase;
  k.choice("role", kRoles, "what of the operator carries it", role);
  // The base has no role: its axes are the tracker's frame.
  if (role != kBase) body.role = static_cast<BodyRole>(role);
  for (const MarkerBody& other : out.bodies) {
    if (other.name == body.name) k.refuse({"name"}, "two bodies have this name; rename one");
    if (other.role == body.role) k.refuse({"role"}, "two bodies have this role; leave one out");
  }
}

void read_markers(Keys& k, MarkerBody& body) {
  std::vector<std::array<double, 4>> rows;
  k.points("markers_m", {-1e9, 1e9}, "id and place, body's axes", rows);
  for (const auto& [id, x_m, y_m, z_m] : rows) {
    const Eigen::Vector3d p_m(x_m, y_m, z_m);
    if (id < 0.0 || id != std::floor(id))
      return k.refuse({"markers_m"}, "a marker's id must be a whole number from 0 to 1e9");
    if (p_m.cwiseAbs().maxCoeff() > kFarthestMarker_m)
      return k.refuse({"markers_m"}, "a marker is more than 10 m from its body; write metres");
    const auto number = static_cast<std::uint32_t>(id);
    if (std::ranges::find(body.markers, number, &BodyMarker::id) != body.markers.end())
      k.refuse({"markers_m"}, fmt::format("marker {} is there twice; number them apart", number));
    body.markers.push_back({.id = number, .position_m = p_m});
  }
  if (body.markers.size() < kMinMarkers || body.markers.size() > kMaxMarkers) {
    k.refuse({"markers_m"}, fmt::format("a body takes 4 to {} markers; 6 or more, not in a plane, "
                                        "are advised",
                                        kMaxMarkers));
  }
}

void read_body(Keys& k, TrackingSetup& out) {
  MarkerBody body;
  read_name(k, body.name);
  read_role(k, out, body);
  read_markers(k, body);
  body.tip_m = read_point(k, "tip_m", kFarthestMarker_m, "the point whose place the device knows",
                          Need::kOptional);
  if (body.tip_m && body.role != BodyRole::kTool)
    k.refuse({"tip_m"}, "only role = \"tool\" has tip_m; leave it out");
  out.bodies.push_back(std::move(body));
}

void read_registration(Keys& k, Need need, const std::string& path, TrackingSetup& out) {
  k.section(
      "registration", "tracker's frame to the device's",
      [&](Keys& section) {
        out.registration = read_pose(section, Need::kRequired).value_or(Pose{});
        out.registered_by = path;
      },
      need);
}

std::optional<Error> read_description(const std::string& path, const Keys::Inside& inside) {
  const auto text = model::io::read_file(
      path, "give the path of a tracking description of at most 1 MB", kMaxFile_bytes);
  if (!text) return text.error();
  auto root = model::io::parse_toml(*text, path);
  if (!root) return root.error();
  const model::reader::SceneDocument document{.path = path, .root = std::move(*root), .hash = {}};
  model::reader::SceneVisit visit(&document);
  Keys::visit_root(visit, inside);
  return visit.problem();
}

}  // namespace

const char* name_of(BodyRole role) { return kRoles[static_cast<std::size_t>(role)].name.data(); }

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
  TrackingSetup out;
  out.path = path;
  const auto error = read_description(path, [&](Keys& k) {
    k.section("input", "where observations come from", [&](Keys& in) { read_input(in, out); });
    k.entries("body", {1, kMaxSections}, "markers", [&](Keys& in) { read_body(in, out); });
    k.entries("camera", {1, kMaxSections}, "lens and place",
              [&](Keys& in) { read_camera(in, out); });
    const auto shoulder = [&](Keys& in) {
      out.shoulder_m = read_point(in, "shoulder_m", kFarthestShoulder_m, "right, device's frame",
                                  Need::kRequired);
    };
    k.section("operator", "the place of the figure", shoulder, Need::kOptional);
    read_registration(k, Need::kOptional, path, out);
  });
  if (error) return *error;
  // The description's own section has precedence; the separate file is then not even opened.
  const std::string beside = registration_path(path);
  std::error_code unreadable;
  if (!out.registered_by.empty() || !fs::exists(beside, unreadable)) return out;
  const auto wrong = read_description(
      beside, [&](Keys& k) { read_registration(k, Need::kRequired, beside, out); });
  if (wrong) return *wrong;
  return out;
}

}  // namespace tact::host::tracking
