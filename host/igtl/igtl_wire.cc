// SPDX-License-Identifier: Apache-2.0
#include "host/igtl/igtl_wire.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/crc.hpp>
#include <cmath>
#include <cstring>

namespace tact::host::igtl {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using model::Error;
using model::Result;

constexpr double kFraction_s = 1.0 / 4294967296.0;
// Of the matrix R^T R - 1, and of a quaternion's square length.
constexpr double kMaxSkew = 0.01;  // allows float rounding; other matrices are far beyond
constexpr double kFarthest_m = 1000.0;
// The protocol's 64 bits of a unit: prefix, then pairs of unit and exponent.
constexpr std::uint64_t kNewton = 0x0bull << 54 | 1ull << 50;  // no prefix, N to the power 1

/// Reads big-endian values in sequence; beyond the end 0, and `is_short`.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <typename Unsigned>
  Unsigned number() {
    Unsigned value = 0;
    for (const char byte : take(sizeof value))
      value = static_cast<Unsigned>(value << 8 | static_cast<unsigned char>(byte));
    return value;
  }
  double real32() { return static_cast<double>(std::bit_cast<float>(number<std::uint32_t>())); }
  std::string_view take(std::size_t count) {
    // Stays short, because later values would be read from the wrong position.
    is_short_ = is_short_ || count > bytes_.size();
    const std::string_view out = is_short_ ? std::string_view() : bytes_.substr(0, count);
    bytes_.remove_prefix(out.size());
    return out;
  }
  bool is_short() const { return is_short_; }

 private:
  std::string_view bytes_;
  bool is_short_ = false;
};

class Writer {
 public:
  template <typename Unsigned>
  Writer& number(Unsigned value) {
    for (std::size_t i = sizeof value; i-- > 0;)
      bytes_ += static_cast<char>((value >> (8 * i)) & 0xffu);
    return *this;
  }
  Writer& real32(double value) {
    return number(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  Writer& real64(double value) { return number(std::bit_cast<std::uint64_t>(value)); }
  /// Cut or filled with zeros to `size`.
  Writer& text(std::string_view value, std::size_t size) {
    bytes_ += value.substr(0, size);
    bytes_.append(size - std::min(size, value.size()), '\0');
    return *this;
  }
  Writer& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
};

/// A name ends at its first zero. Nothing if it has bytes that are not printable ASCII.
std::optional<std::string> name_in(std::string_view field) {
  const std::string_view name = field.substr(0, field.find('\0'));
  const bool is_plain = std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
  return is_plain ? std::optional(std::string(name)) : std::nullopt;
}

std::string message(std::string_view type, std::string_view device, double time_s,
                    const std::string& body) {
  // Negative times become 0, which means "none".
  const double whole_s = std::floor(std::max(time_s, 0.0));
  return Writer()
      .number(std::uint16_t{1})
      .text(type, kTypeBytes)
      .text(device, kDeviceBytes)
      .number(static_cast<std::uint32_t>(whole_s))
      .number(static_cast<std::uint32_t>(std::max(time_s - whole_s, 0.0) / kFraction_s))
      .number(std::uint64_t{body.size()})
      .number(crc64(body))
      .raw(body)
      .str();
}

/// The value of a key; nothing if it is absent. Error: the sizes exceed the bytes.
Result<std::optional<std::string_view>> metadata_value(std::string_view head, std::string_view data,
                                                       std::string_view wanted) {
  Reader sizes(head), texts(data);
  std::optional<std::string_view> found;
  const auto count = sizes.number<std::uint16_t>();
  // The count is untrusted: the loop also ends with the bytes.
  for (int i = 0; i < count && !sizes.is_short() && !texts.is_short(); ++i) {
    const auto key_bytes = sizes.number<std::uint16_t>();
    (void)sizes.number<std::uint16_t>();  // the value's character set
    const auto value_bytes = sizes.number<std::uint32_t>();
    const std::string_view key = texts.take(key_bytes), value = texts.take(value_bytes);
    if (key == wanted) found = value;
  }
  if (sizes.is_short() || texts.is_short()) return Error{"its metadata do not fit into it"};
  return found;
}

Result<pose::Pose> checked(const Vector3d& position_mm, const Quaterniond& rotation) {
  const Vector3d position_m = 1e-3 * position_mm;
  if (!position_m.allFinite() || position_m.cwiseAbs().maxCoeff() > kFarthest_m)
    return Error{"its place is no number, or farther than 1 km; send mm"};
  return pose::Pose{.rotation = pose::canonical(rotation), .position_m = position_m};
}

Result<pose::Pose> transform_in(std::string_view content) {
  Reader in(content);
  std::array<Vector3d, 4> columns;
  for (Vector3d& column : columns)
    for (double& number : column) number = in.real32();
  Matrix3d rotation;
  rotation << columns[0], columns[1], columns[2];
  // Checked before normalizing, which would turn a scale or a mirror into a rotation.
  const double skew = (rotation.transpose() * rotation - Matrix3d::Identity()).norm();
  if (!(skew <= kMaxSkew) || rotation.determinant() < 0.0)
    return Error{"its matrix is no rotation; send one without scale, shear or mirror"};
  return checked(columns[3], Quaterniond(rotation).normalized());
}

Result<pose::Pose> position_in(std::string_view content) {
  Reader in(content);
  Vector3d position_mm;
  for (double& number : position_mm) number = in.real32();
  std::array<double, 4> wxyz{};
  for (const int at : {1, 2, 3}) wxyz[static_cast<std::size_t>(at)] = in.real32();
  const double rest = wxyz[1] * wxyz[1] + wxyz[2] * wxyz[2] + wxyz[3] * wxyz[3];
  // Three numbers are a unit quaternion with a real part that is not negative.
  wxyz[0] = content.size() == 24 ? std::sqrt(std::max(0.0, 1.0 - rest)) : in.real32();
  const auto rotation = pose::rotation_from(wxyz);
  if (!rotation || !(std::abs(rest + wxyz[0] * wxyz[0] - 1.0) <= kMaxSkew))
    return Error{"its orientation is no unit quaternion"};
  return checked(position_mm, *rotation);
}

}  // namespace

std::uint64_t crc64(std::string_view bytes) {
  boost::crc_optimal<64, 0x42F0E1EBA9EA3693ull, 0, 0, false, false> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

Result<MessageHead> read_head(std::string_view bytes) {
  Reader in(bytes);
  MessageHead head;
  head.version = in.number<std::uint16_t>();
  const auto type = name_in(in.take(kTypeBytes)), device = name_in(in.take(kDeviceBytes));
  const double whole_s = in.number<std::uint32_t>();
  head.time_s = whole_s + kFraction_s * in.number<std::uint32_t>();
  head.body_bytes = in.number<std::uint64_t>();
  head.crc = in.number<std::uint64_t>();
  if (in.is_short() || head.version < 1 || head.version > 3 || !type || type->empty() || !device)
    return Error{"what it sends is not OpenIGTLink"};
  head.type = *type;
  head.device = *device;
  return head;
}

Result<Content> content_of(const MessageHead& head, std::string_view body) {
  // Version 1 has neither extended header nor metadata.
  if (head.version == 1) return Content{.bytes = body};
  Reader in(body);
  const std::size_t extended = in.number<std::uint16_t>();
  const std::size_t index = in.number<std::uint16_t>(), data = in.number<std::uint32_t>();
  if (in.is_short() || extended < 12 || extended + index + data > body.size())
    return Error{"its extended header does not fit into it"};
  const std::size_t content = body.size() - extended - index - data;
  Content out{.bytes = body.substr(extended, content)};
  if (index == 0) return out;
  const auto status = metadata_value(body.substr(extended + content, index),
                                     body.substr(extended + content + index), "TransformStatus");
  if (!status) return status.error();
  // PLUS writes "OK", or why it does not see the body; without the key the body counts as seen.
  out.is_tracked = !*status || **status == "OK";
  return out;
}

Result<pose::Pose> pose_of(std::string_view type, std::string_view content) {
  const std::size_t size = content.size();
  if (type == "TRANSFORM" && size == 48) return transform_in(content);
  if (type == "POSITION" && (size == 28 || size == 24)) return position_in(content);
  if (type == "POSITION" && size == 12) return Error{"it has no orientation; send it with one"};
  return Error{fmt::format("a {} of {} bytes is none; the size is wrong", type, size)};
}

std::string transform(std::string_view device, double time_s, const pose::Pose& pose,
                      double scale) {
  const Matrix3d axes = scale * pose.rotation.toRotationMatrix();
  Writer body;
  // Column by column, the origin last, as in the protocol.
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) body.real32(axes(row, column));
  for (const double at_m : pose.position_m) body.real32(1e3 * at_m);
  return message("TRANSFORM", device, time_s, body.str());
}

std::string force_sensor(std::string_view device, double time_s, const double (&force_N)[3]) {
  Writer body;
  body.number(std::uint8_t{3}).number(std::uint8_t{0}).number(kNewton);
  for (const double one_N : force_N) body.real64(one_N);
  return message("SENSOR", device, time_s, body.str());
}

std::string status(std::string_view device, double time_s, const Status& status) {
  Writer body;
  body.number(status.code).number(static_cast<std::uint64_t>(status.subcode)).text(status.name, 20);
  return message("STATUS", device, time_s, body.raw(status.words).raw({"\0", 1}).str());
}

}  // namespace tact::host::igtl
