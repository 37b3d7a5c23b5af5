// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/frame_builder.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

namespace tact::firmware::telemetry {
namespace {

template <typename Floats>
void put(Floats& field, const model::Vec3& v) {
  field[0] = static_cast<float>(v.x);
  field[1] = static_cast<float>(v.y);
  field[2] = static_cast<float>(v.z);
}

// Tool, force and state of one tick.
void put(Frame& frame, const loop::TickInput& input, const loop::TickOutput& output) {
  const hal::Tool& tool = input.sample.tool;
  put(frame.tool_position_m, tool.position_m);
  const model::Quat& q = tool.orientation;
  float* wxyz = frame.tool_orientation;
  for (const double part : {q.w, q.x, q.y, q.z}) *wxyz++ = static_cast<float>(part);
  put(frame.tool_velocity_mps, tool.velocity_mps);
  frame.grip_ratio = static_cast<float>(tool.grip_ratio);
  put(frame.force_N, output.written.force_N);
  put(frame.torque_Nm, output.written.torque_Nm);
  put(frame.wanted_force_N, output.wanted.force_N);
  frame.grip_force_N = static_cast<float>(output.written_grip_N);
  frame.temperature_C = static_cast<float>(input.sample.temperature_C);
  frame.fault = static_cast<std::uint16_t>(output.fault);
  frame.state = output.state;
  constexpr std::uint64_t kMax_count = std::numeric_limits<std::uint32_t>::max();
  frame.contact_losses = static_cast<std::uint32_t>(std::min(output.contact_losses, kMax_count));
}

float to_us(std::int64_t ns) { return static_cast<float>(static_cast<double>(ns) * 1e-3); }

/// Vertices, then triangles; float is precise enough for drawing.
void append(std::vector<std::byte>& bytes, const model::mesh::SurfaceMesh& mesh) {
  const auto add = [&bytes](const void* data, std::size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), from, from + size);
  };
  for (const model::Vec3& v : mesh.vertex_m) {
    float xyz[3];
    put(xyz, v);
    add(xyz, sizeof xyz);
  }
  for (const model::contact::TriangleCorners& t : mesh.triangle) add(t.data(), sizeof t);
}

}  // namespace

RunHeader header_of(const model::scene::Scene& scene, const model::scene::Tissue& tissue) {
  RunHeader header;
  header.scene_name = scene.name;
  header.scene_hash = scene.hash;
  header.law_name = tissue.law().title();
  header.rate_Hz = scene.rate_Hz;
  header.frame_rate_Hz = scene.frame_rate_Hz;
  header.organ_vertices = static_cast<std::uint32_t>(scene.organ_mesh.vertex_m.size());
  header.organ_triangles = static_cast<std::uint32_t>(scene.organ_mesh.triangle.size());
  header.tool_vertices = static_cast<std::uint32_t>(scene.tool_mesh.vertex_m.size());
  header.tool_triangles = static_cast<std::uint32_t>(scene.tool_mesh.triangle.size());
  for (const auto& sphere : scene.tool.spheres)
    header.spheres.push_back(
        {sphere.radius_m, {sphere.offset_m.x, sphere.offset_m.y, sphere.offset_m.z}});
  std::array<double, protocol::kMaxProfilePoints> ring_m{};
  // Any point and no indentation: only the number of profile points is needed.
  header.profile_points = static_cast<std::uint32_t>(tissue.law().contact_law().profile(
      {.surface_point = {.triangle = 0, .weight = {1, 0, 0}}}, ring_m));
  header.profile_pitch_m = tissue.law().contact_law().ring_pitch_m();
  header.organ_material = scene.look.organ;
  header.tool_material = scene.look.tool;
  static_assert(model::scene::kMaxPieces <= protocol::kMaxPieces);
  for (const model::Vec3& ratio : scene.look.piece_color_ratio) {
    std::array<float, 3> color{};
    put(color, ratio);
    header.piece_color_ratio.push_back(color);
  }
  static_assert(model::scene::kMaxTasks <= protocol::kMaxTasks);
  for (const model::scene::Task& task : scene.tasks)
    header.tasks.push_back({task.text,
                            {task.place_m.x, task.place_m.y, task.place_m.z},
                            task.radius_m,
                            task.by_grip,
                            task.force_min_N,
                            task.force_max_N,
                            task.grip_min_ratio,
                            task.grip_max_ratio,
                            task.hold_s});
  return header;
}

std::vector<std::byte> mesh_bytes(const model::scene::Scene& scene) {
  std::vector<std::byte> bytes;
  append(bytes, scene.organ_mesh);
  append(bytes, scene.tool_mesh);
  for (const model::mesh::Rgb& color : scene.look.vertex_color)
    for (const std::uint8_t part : color) bytes.push_back(std::byte{part});
  return bytes;
}

model::Result<int> make_memory_file(const std::string& bytes) {
  // Sealed last, so that a viewer can map it safely: it can neither shrink nor change.
  const int fd = memfd_create("tact-run", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  std::size_t written = 0;
  while (fd >= 0 && written < bytes.size()) {
    const ssize_t n = write(fd, bytes.data() + written, bytes.size() - written);
    if (n <= 0) break;
    written += static_cast<std::size_t>(n);
  }
  if (fd < 0 || written < bytes.size())
    return model::Error{std::string("telemetry memory file: ") + std::strerror(errno) +
                        "; free some memory and start again"};
  fcntl(fd, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL);
  return fd;
}

void FrameBuilder::add(const loop::TickRecord& record) {
  if (first_due_ns_ < 0) first_due_ns_ = record.due_ns;
  const float margin_us = to_us(record.margin_ns);
  const auto given_energy_J = static_cast<float>(record.output.given_energy_J);
  // tick_us_ is empty at the first tick of a frame: the extremes start again.
  given_energy_J_ = tick_us_.empty() ? given_energy_J : std::max(given_energy_J_, given_energy_J);
  worst_margin_us_ = tick_us_.empty() ? margin_us : std::min(worst_margin_us_, margin_us);
  // The total of the tick before: a tick's own total is known only after its record is published.
  const std::int32_t total_ns = record.phase_ns[static_cast<std::size_t>(loop::Phase::kTotal)];
  tick_us_.push_back(to_us(total_ns));
  wake_.add(record.phase_ns[static_cast<std::size_t>(loop::Phase::kWake)]);
  if (record.event != 0) event_ = {.number = record.event, .due_ns = record.due_ns};
  if (record.tick > 0) duration_.add(total_ns);
  peak_force_N_ = std::max(peak_force_N_, static_cast<float>(norm(record.output.written.force_N)));
  // A limit that acted for only one tick still appears in the frame.
  if (record.output.limit != model::Fault::kNone) limit_ = record.output.limit;
  newest_ = record;
}

Frame frame_of_tick(const Frame& previous, const LoggedTick& tick, std::int64_t time_ns) {
  Frame frame = previous;
  frame.tick = tick.tick;
  frame.time_ns = time_ns;
  frame.due_ns = tick.due_ns;
  frame.utc = tick.utc;
  put(frame, tick.input, tick.output);
  // The extremes of this one tick.
  frame.peak_force_N = static_cast<float>(norm(tick.output.written.force_N));
  frame.rms_force_N = static_cast<float>(tick.output.rms_force_N);
  frame.given_energy_J = static_cast<float>(tick.output.given_energy_J);
  frame.limit = static_cast<std::uint16_t>(tick.output.limit);
  return frame;
}

Frame FrameBuilder::take(std::uint64_t dropped_records) {
  const loop::TickRecord& r = newest_;
  Frame frame;
  frame.tick = r.tick;
  frame.time_ns = r.due_ns - first_due_ns_;
  frame.due_ns = r.due_ns;
  frame.utc = utc_;
  frame.late_ticks = r.late_ticks;
  frame.skipped_ticks = r.skipped_ticks;
  frame.dropped_records = dropped_records;
  put(frame, r.input, r.output);
  frame.worst_margin_us = worst_margin_us_;
  const auto middle = tick_us_.begin() + static_cast<std::ptrdiff_t>(tick_us_.size() / 2);
  // Reorders tick_us_, which is cleared below.
  std::nth_element(tick_us_.begin(), middle, tick_us_.end());
  frame.median_tick_us = tick_us_.empty() ? 0.0f : *middle;
  frame.peak_force_N = peak_force_N_;
  frame.rms_force_N = static_cast<float>(r.output.rms_force_N);
  frame.given_energy_J = given_energy_J_;
  frame.limit = static_cast<std::uint16_t>(limit_);
  frame.non_rt = non_rt_;
  frame.event = event_;
  frame.wake = wake_;
  frame.duration = duration_;
  static_assert(protocol::kMaxContacts == model::contact::kMaxSpheres);
  const auto contacts = r.contacts.all();
  for (std::size_t i = 0; i < contacts.size(); ++i) add_contact(contacts[i], frame.contact[i]);
  add_patch(frame.patch);
  tick_us_.clear();
  peak_force_N_ = 0.0f;
  limit_ = model::Fault::kNone;
  return frame;
}

void FrameBuilder::add_patch(FramePatch& patch) {
  static_assert(protocol::kMaxPatchVertices == model::contact::kMaxShapeNodes &&
                protocol::kMaxCutsReported == model::contact::kCutWindow);
  constexpr double kMax_um = std::numeric_limits<std::int16_t>::max();
  shapes_.read(shape_);  // keeps the last shape if there is no new one
  patch.vertex_count = shape_.node_count;
  patch.cut_total = shape_.cut_total;
  patch.cut_first = shape_.cut_first;
  patch.cut_count = shape_.cut_count;
  std::copy(shape_.vertex.begin(), shape_.vertex.end(), patch.vertex);
  std::copy(shape_.cut_triangle.begin(), shape_.cut_triangle.end(), patch.cut_triangle);
  for (std::size_t i = 0; i < shape_.node_count; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      // Micrometres in 16 bits: half the size of a float; clamped at 32 mm.
      const double um = 1e6 * static_cast<double>(shape_.displacement_m[i][k]);
      patch.displacement_um[i][k] =
          static_cast<std::int16_t>(std::clamp(std::round(um), -kMax_um, kMax_um));
    }
}

void FrameBuilder::add_contact(const model::contact::SphereContact& sphere_contact,
                               FrameContact& contact) const {
  put(contact.surface_point_m, sphere_contact.surface_point_m);
  put(contact.normal, sphere_contact.normal);
  put(contact.shift_m, sphere_contact.shift_m);
  contact.depth_m = static_cast<float>(sphere_contact.depth_m);
  contact.state = sphere_contact.state;
  // Only the sphere's own indentation, because the page adds up all indentations. A sphere within
  // the indentation of another has none.
  const bool is_held = sphere_contact.state == model::ContactState::kHeld;
  const bool presses =
      sphere_contact.state == model::ContactState::kInContact && sphere_contact.indentation_m > 0.0;
  if (!is_held && !presses) return;
  std::array<double, protocol::kMaxProfilePoints> ring_m{};
  const model::contact::Indentation in{.surface_point = sphere_contact.surface_point,
                                       .normal = sphere_contact.normal,
                                       .indentation_m = sphere_contact.indentation_m};
  const std::size_t count = indentations_->profile(in, ring_m);
  put(contact.tilt, indentations_->tilt(in));
  for (std::size_t j = 0; j < count; ++j) contact.profile_m[j] = static_cast<float>(ring_m[j]);
}

}  // namespace tact::firmware::telemetry
