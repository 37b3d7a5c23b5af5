// recording.h - a run of tactd in one file, and the last minutes of it in memory.
//
// File: FileHeader, Hello, meshes, then one FrameRecord per frame; little-endian, fixed sizes, so a
// damaged frame costs that frame only. Every part has a CRC-32 (polynomial 0x04C11DB7, as zlib).
// A damaged or cut-off file gives what is good of it and one sentence about the rest.
#pragma once

#include <cstdio>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "host/telemetry_check.h"

namespace tact::host {

inline constexpr char kRecordingMagic[8] = {'t', 'a', 'c', 't', 'r', 'e', 'c', '\n'};
inline constexpr std::uint32_t kRecordingVersion = 3;  // 3: energy and RMS of the force

struct FileHeader {
  char magic[8] = {};
  std::uint32_t version = 0;
  std::uint32_t hello_bytes = 0, frame_bytes = 0;
  std::uint32_t setup_crc = 0;  // of Hello and meshes
  std::uint64_t mesh_bytes = 0;
};

struct FrameRecord {
  Frame frame;
  std::uint32_t crc = 0;  // of frame
  std::uint32_t pad = 0;
};

struct Recording {
  Hello hello;
  MeshBytes mesh;
  std::vector<Frame> frames;

  double length_s() const;
};

/// The bytes that begin a file, and those of one frame.
std::string recording_start(const Hello& hello, const MeshBytes& mesh);
std::string recording_frame(const Frame& frame);

struct ReadResult {
  Recording recording;
  bool usable = false;  // scene and at least one frame are good
  std::string damage;   // empty when the whole file is good
};
ReadResult read_recording(const std::string& path);

/// Writes one file, at most a second behind the frames. Never overwrites a file.
class RecordingWriter {
 public:
  /// Each returns an empty string, or what went wrong. After an error nothing more is written.
  std::string open(const std::string& path, const Hello& hello, const MeshBytes& mesh);
  std::string write(const Frame& frame);
  std::string close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string put(const std::string& bytes);

  std::unique_ptr<std::FILE, Closer> file_;
  std::string path_;
  std::int64_t flushed_ns_ = 0;
};

/// The newest frames, oldest first, bounded in time.
class RecentFrames {
 public:
  void restart(double frame_rate_Hz);
  void add(const Frame& frame);
  const std::deque<Frame>& frames() const { return frames_; }

  static constexpr double kKeep_s = 300.0;

 private:
  std::deque<Frame> frames_;
  std::size_t capacity_ = 0;
};

}  // namespace tact::host
