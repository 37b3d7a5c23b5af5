// SPDX-License-Identifier: Apache-2.0
// The bytes against OpenIGTLink's own library, libopenigtlink 1.11.
#include "host/igtl/igtl_wire.h"

#include <gtest/gtest.h>
#include <igtlPositionMessage.h>
#include <igtlSensorMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "host/igtl/igtl_frame.h"
#include "tests/support/message.h"

namespace tact::host::igtl::igtl_wire_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using tests::message_of;

const pose::Pose kPose{.rotation = Quaterniond(0.8, 0.2, -0.4, 0.4).normalized(),
                       .position_m = {0.125, -0.25, 1.5}};

/// The library's message from our bytes; its checksum is evaluated.
template <typename Message>
typename Message::Pointer unpacked(const std::string& bytes) {
  auto header = ::igtl::MessageHeader::New();
  header->InitPack();
  std::memcpy(header->GetPackPointer(), bytes.data(), kHeaderBytes);
  header->Unpack();
  auto message = Message::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  EXPECT_EQ(static_cast<std::size_t>(message->GetPackBodySize()), bytes.size() - kHeaderBytes);
  std::memcpy(message->GetPackBodyPointer(), bytes.data() + kHeaderBytes,
              bytes.size() - kHeaderBytes);
  EXPECT_TRUE(message->Unpack(1) & ::igtl::MessageHeader::UNPACK_BODY) << "by its checksum";
  return message;
}

template <typename Message>
std::string packed(const Message& message) {
  message->Pack();
  return {static_cast<const char*>(message->GetPackPointer()),
          static_cast<std::size_t>(message->GetPackSize())};
}

model::Result<pose::Pose> pose_in(const std::string& bytes) {
  const auto head = read_head(std::string_view(bytes).substr(0, kHeaderBytes));
  if (!head) return head.error();
  const auto content = content_of(*head, std::string_view(bytes).substr(kHeaderBytes));
  return content ? pose_of(head->type, content->bytes) : content.error();
}

void expect_near(const pose::Pose& a, const pose::Pose& b) {
  EXPECT_LT((a.position_m - b.position_m).norm(), 1e-6);
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-6);
}

TEST(IgtlWire, ReadsThePublishedMessage) {
  // OpenIGTLink, Testing/igtlutil/igtl_test_data_transform.h
  std::string bytes;
  for (const unsigned word :
       {0x00015452u, 0x414e5346u, 0x4f524d00u, 0x00004465u, 0x76696365u, 0x4e616d65u, 0x00000000u,
        0x00000000u, 0x00000000u, 0x499602d2u, 0x00000000u, 0x00000030u, 0xf6dd2b8eu, 0xb4df6dd2u,
        0xbf7473cdu, 0x3e4959e6u, 0xbe63dd98u, 0xbe4959e6u, 0x3e12491bu, 0x3f7852d6u, 0x3e63dd98u,
        0x3f7852d6u, 0xbdc830aeu, 0x42383660u, 0x419bc467u, 0x42383660u})
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(word >> shift);
  // The device's name has 20 bytes: two more zeros than whole words.
  bytes.insert(24, 2, '\0');
  const auto head = read_head(std::string_view(bytes).substr(0, kHeaderBytes));
  ASSERT_EQ(message_of(head), "");
  EXPECT_EQ(head->type, "TRANSFORM");
  EXPECT_EQ(head->device, "DeviceName");
  EXPECT_EQ(head->body_bytes, 48u);
  EXPECT_EQ(crc64(std::string_view(bytes).substr(kHeaderBytes)), head->crc);
  const auto pose = pose_in(bytes);
  ASSERT_EQ(message_of(pose), "");
  EXPECT_NEAR(pose->position_m.x(), 0.046053, 1e-6);
  EXPECT_NEAR(pose->position_m.y(), 0.019471, 1e-6);
}

TEST(IgtlWire, TheChecksumIsTheLibrarys) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> byte(0, 255);
  for (std::size_t size = 0; size < 200; ++size) {
    std::string bytes(size, '\0');
    for (char& c : bytes) c = static_cast<char>(byte(random));
    EXPECT_EQ(crc64(bytes), ::crc64(reinterpret_cast<unsigned char*>(bytes.data()), size, 0));
  }
}

TEST(IgtlWire, TheLibraryReadsOurTransformInMillimetres) {
  const auto message = unpacked<::igtl::TransformMessage>(transform("ToolToDevice", 12.5, kPose));
  EXPECT_STREQ(message->GetDeviceName(), "ToolToDevice");
  ::igtl::Matrix4x4 m;
  message->GetMatrix(m);
  const Matrix3d rotation = kPose.rotation.toRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    EXPECT_FLOAT_EQ(m[row][3], static_cast<float>(1e3 * kPose.position_m[row]));
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(m[row][column], rotation(row, column), 1e-6);
  }
  auto stamp = ::igtl::TimeStamp::New();
  message->GetTimeStamp(stamp);
  EXPECT_DOUBLE_EQ(stamp->GetTimeStamp(), 12.5);
}

TEST(IgtlWire, ReadsTheLibrarysTransformAndPosition) {
  auto moved = ::igtl::TransformMessage::New();
  const Matrix3d rotation = kPose.rotation.toRotationMatrix();
  ::igtl::Matrix4x4 m{};
  for (int row = 0; row < 3; ++row) {
    m[row][3] = static_cast<float>(1e3 * kPose.position_m[row]);
    for (int column = 0; column < 3; ++column)
      m[row][column] = static_cast<float>(rotation(row, column));
  }
  moved->SetDeviceName("HeadToDevice");
  moved->SetMatrix(m);
  auto seen = pose_in(packed(moved));
  ASSERT_EQ(message_of(seen), "");
  expect_near(*seen, kPose);

  auto placed = ::igtl::PositionMessage::New();
  const auto number = [](double value) { return static_cast<float>(value); };
  const Eigen::Quaterniond& q = kPose.rotation;
  placed->SetPosition(125.0f, -250.0f, 1500.0f);
  placed->SetQuaternion(number(q.x()), number(q.y()), number(q.z()), number(q.w()));
  const std::string whole = packed(placed);
  seen = pose_in(whole);
  ASSERT_EQ(message_of(seen), "");
  expect_near(*seen, kPose);
  // The shorter kinds are its beginning; the library 1.11 writes beyond its buffer for them.
  const std::string_view content = std::string_view(whole).substr(kHeaderBytes);
  seen = pose_of("POSITION", content.substr(0, 24));
  ASSERT_EQ(message_of(seen), "");
  expect_near(*seen, kPose);
  EXPECT_EQ(message_of(pose_of("POSITION", content.substr(0, 12))),
            "it has no orientation; send it with one");
}

TEST(IgtlWire, TheLibraryReadsForceInNewtonsAndStatus) {
  const auto force = unpacked<::igtl::SensorMessage>(force_sensor("Force", 1.0, {0.5, -1.25, 3.0}));
  ASSERT_EQ(force->GetLength(), 3u);
  EXPECT_EQ(force->GetValue(0), 0.5);
  EXPECT_EQ(force->GetValue(1), -1.25);
  EXPECT_EQ(force->GetValue(2), 3.0);
  auto newton = ::igtl::Unit::New();
  newton->Append(::igtl::Unit::SI_DERIVED_NEWTON, 1);
  EXPECT_EQ(force->GetUnit(), newton->Pack());
  const auto reported = unpacked<::igtl::StatusMessage>(
      status("Tact", 1.0, {.code = 15, .subcode = 117, .name = "fault 117", .words = "stopped"}));
  EXPECT_EQ(reported->GetCode(), ::igtl::StatusMessage::STATUS_DISABLED);
  EXPECT_EQ(reported->GetSubCode(), 117);
  EXPECT_STREQ(reported->GetErrorName(), "fault 117");
  EXPECT_STREQ(reported->GetStatusString(), "stopped");
}

TEST(IgtlWire, TheArrowOfTheForcePointsAlongItAndIsAsLong) {
  record::Frame frame;
  frame.tool_orientation[0] = 1.0f;
  frame.tool_position_m[2] = 0.25f;
  frame.force_N[0] = -3.0f;
  frame.force_N[1] = 4.0f;
  const std::string bytes = frame_messages(frame, 1.0);
  const std::size_t one = kHeaderBytes + 48;
  const auto arrow = unpacked<::igtl::TransformMessage>(bytes.substr(one, one));
  EXPECT_STREQ(arrow->GetDeviceName(), "ForceToDevice");
  ::igtl::Matrix4x4 m;
  arrow->GetMatrix(m);
  EXPECT_NEAR(m[0][2], -3.0, 1e-5);
  EXPECT_NEAR(m[1][2], 4.0, 1e-5);
  EXPECT_NEAR(m[2][2], 0.0, 1e-5);
  EXPECT_FLOAT_EQ(m[2][3], 250.0f);
  frame.force_N[0] = frame.force_N[1] = 0.0f;
  unpacked<::igtl::TransformMessage>(frame_messages(frame, 1.0).substr(one, one))->GetMatrix(m);
  EXPECT_FLOAT_EQ(m[2][2], 1e-3f) << "no force: small, but with an inverse";
  frame.force_N[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(frame_messages(frame, 1.0), "");
}

TEST(IgtlWire, StatusFollowsTheStateOfTheDevice) {
  record::Frame frame;
  using State = decltype(frame.state);
  for (const auto& [state, code] : {std::pair{State::kOff, 13}, std::pair{State::kReady, 1},
                                    std::pair{State::kArmed, 1}, std::pair{State::kStopped, 15}}) {
    frame.state = state;
    EXPECT_EQ(status_of(frame).code, code);
    EXPECT_EQ(status_of(frame).words, name_of(state));
  }
  frame.fault = 117;
  EXPECT_EQ(status_of(frame).subcode, 117);
  EXPECT_EQ(status_of(frame).name, "fault 117");
}

TEST(IgtlWire, InvalidRotationsPositionsAndHeadersAreRefused) {
  EXPECT_NE(message_of(pose_of("TRANSFORM", std::string(44, '\0'))), "");
  EXPECT_NE(message_of(pose_of("TRANSFORM", std::string(48, '\0'))), "");    // no rotation
  EXPECT_NE(message_of(pose_of("TRANSFORM", std::string(48, '\xff'))), "");  // NaN
  EXPECT_NE(message_of(pose_of("POSITION", std::string(28, '\0'))), "");
  EXPECT_NE(message_of(pose_of("POSITION", std::string(27, '\0'))), "");
  EXPECT_NE(message_of(pose_in(transform("t", 0.0, kPose, 1.1))), "") << "scaled";
  pose::Pose far = kPose;
  far.position_m.x() = 1001.0;
  EXPECT_NE(message_of(pose_in(transform("t", 0.0, far))), "");
  EXPECT_NE(message_of(read_head("GET / HTTP/1.1\r\nHost: 127.0.0.1:18944\r\nAccept: */*   \r\n")),
            "");
  EXPECT_NE(message_of(read_head("")), "");
}

/// A message of version 2 as PLUS sends it: an extended header, content, metadata.
std::string version_2(std::string_view key, std::string_view value) {
  const auto two = [](std::size_t n) {
    return std::string{static_cast<char>(n >> 8), static_cast<char>(n)};
  };
  const auto four = [&](std::size_t n) { return two(n >> 16) + two(n & 0xffff); };
  const std::string index = two(1) + two(key.size()) + two(3) + four(value.size());
  const std::string content = transform("t", 0.0, kPose).substr(kHeaderBytes);
  return two(12) + two(index.size()) + four(key.size() + value.size()) + four(9) + content + index +
         std::string(key) + std::string(value);
}

TEST(IgtlWire, TransformStatusOfVersion2IsRead) {
  const MessageHead head{.version = 2, .type = "TRANSFORM", .device = "t"};
  for (const auto& [key, value, is_tracked] :
       {std::tuple{"TransformStatus", "OK", true}, std::tuple{"TransformStatus", "MISSING", false},
        std::tuple{"Comment", "none", true}}) {
    const std::string body = version_2(key, value);
    const auto content = content_of(head, body);
    ASSERT_EQ(message_of(content), "") << key;
    EXPECT_EQ(content->is_tracked, is_tracked) << value;
    const auto pose = pose_of("TRANSFORM", content->bytes);
    ASSERT_EQ(message_of(pose), "");
    expect_near(*pose, kPose);
  }
  const std::string whole = version_2("TransformStatus", "OK");
  for (std::size_t size = 0; size < whole.size(); ++size) {  // cut anywhere: no pose, no crash
    const std::string cut = whole.substr(0, size);
    const auto content = content_of(head, cut);
    if (content) EXPECT_FALSE(pose_of("TRANSFORM", content->bytes)) << size;
  }
}

TEST(IgtlWire, RandomBytesGiveAFinitePoseOrAnError) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> byte(0, 255), edits(1, 6);
  const std::string kinds[] = {version_2("TransformStatus", "OK"),
                               transform("t", 0.0, kPose).substr(kHeaderBytes),
                               transform("t", 0.0, kPose).substr(kHeaderBytes, 28)};
  int poses = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::string body = kinds[i % 3];
    for (int k = edits(random); k > 0; --k)
      body[random() % body.size()] = static_cast<char>(byte(random));
    MessageHead head;
    head.version = i % 3 == 0 ? 2 : 1;
    const auto content = content_of(head, body);
    const auto pose = content ? pose_of(i % 3 == 2 ? "POSITION" : "TRANSFORM", content->bytes)
                              : model::Result<pose::Pose>(content.error());
    if (!pose) {
      EXPECT_NE(message_of(pose), "");
      continue;
    }
    ++poses;
    EXPECT_TRUE(pose->position_m.allFinite());
    EXPECT_NEAR(pose->rotation.norm(), 1.0, 1e-9);
  }
  EXPECT_GT(poses, 1000);
}

}  // namespace tact::host::igtl::igtl_wire_test
