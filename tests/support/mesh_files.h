// SPDX-License-Identifier: Apache-2.0
// mesh_files.h - small OBJ texts, files that last as long as a test, the two bad files that are too
// long to keep, and a mesh program run with its two outputs apart.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace tact::tests {

inline const std::string kCubeVertices =
    "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\n";
inline const std::string kCubeFaces =
    "f 1 4 3\nf 1 3 2\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n"
    "f 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

inline std::string bad_directory() {
  return std::string(TACT_SOURCE_DIR) + "/tests/data/meshes/bad/";
}

/// A directory of this process alone, removed at the end.
class TempDirectory {
 public:
  TempDirectory() : path_(testing::TempDir() + "/tact_mesh_" + std::to_string(getpid())) {
    std::filesystem::create_directories(path_);
  }
  TempDirectory(const TempDirectory&) = delete;
  TempDirectory& operator=(const TempDirectory&) = delete;
  ~TempDirectory() { std::filesystem::remove_all(path_); }

  const std::string& path() const { return path_; }
  std::string write(const std::string& name, const std::string& text) const {
    const std::string file = path_ + "/" + name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::string path_;
};

inline std::string read_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline std::string huge_polygon() {
  std::string text, face = "f";
  for (int i = 0; i < 20000; ++i) {
    text += "v " + std::to_string(i) + " " + std::to_string(i * i % 97) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  return text + face + "\n";
}

inline std::string very_long_comment() {
  return kCubeVertices + "# " + std::string(1'000'000, 'x') + "\n" + kCubeFaces;
}

struct BadFile {
  std::string name;
  std::string path;
  std::string expect;         // error, ok or either
  std::size_t vertices = 0;   // in the file, where it loads
  std::size_t triangles = 0;  // where it loads
};

struct Ran {
  int status = -1;  // of exit; -1 if it was killed
  std::string out, err;
};

/// `arguments` go through the shell.
inline Ran run_apart(const TempDirectory& temp, const std::string& program,
                     const std::string& arguments) {
  const std::string out = temp.path() + "/out.txt", err = temp.path() + "/err.txt";
  const std::string command =
      program_path(program) + " " + arguments + " >'" + out + "' 2>'" + err + "'";
  const int code = std::system(command.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : -1, read_text(out), read_text(err)};
}

/// Every line of the manifest, with a file behind it.
inline std::vector<BadFile> bad_files(const TempDirectory& temp) {
  std::vector<BadFile> files;
  const auto manifest = nlohmann::json::parse(read_text(bad_directory() + "manifest.json"));
  for (const auto& [name, entry] : manifest.items()) {
    std::string path = bad_directory() + name;
    if (name == "p09_huge_polygon.obj") path = temp.write(name, huge_polygon());
    if (name == "p16_very_long_line.obj") path = temp.write(name, very_long_comment());
    EXPECT_EQ(std::filesystem::file_size(path), entry["bytes"].get<std::size_t>()) << name;
    files.push_back({name, path, entry["expect"].get<std::string>(),
                     entry.value("vertices", std::size_t{0}),
                     entry.value("triangles", std::size_t{0})});
  }
  EXPECT_EQ(files.size(), 20u);
  return files;
}

}  // namespace tact::tests
