// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/repair_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <utility>

#include "model/io/input_file.h"
#include "model/io/json.h"
#include "model/io/program/installed.h"
#include "model/mesh/obj_parser.h"
#include "tools/program/run_program.h"

namespace tact::tools::mesh {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;
using nlohmann::json;

constexpr std::string_view kFileRemedy = "name a mesh file of at most 2 GB";

/// A file in no folder, for a program that we run: gone when the last that has it open ends,
/// however it ends.
class MemoryFile {
 public:
  static Result<MemoryFile> make() {
    // Open in the programs that we start: they find it under the same number.
    const int fd = memfd_create("tact", 0);
    if (fd < 0) return error_of(errno);
    return MemoryFile(fd);
  }
  MemoryFile(MemoryFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  MemoryFile& operator=(MemoryFile&&) = delete;
  ~MemoryFile() {
    if (fd_ >= 0) close(fd_);
  }

  /// Names it for us and for every program that we start while it is here, and for no other.
  std::string path() const { return fmt::format("/proc/self/fd/{}", fd_); }
  /// At its end.
  std::optional<Error> put(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t n = write(fd_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return error_of(n == 0 ? EIO : errno);
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return std::nullopt;
  }

 private:
  explicit MemoryFile(int fd) : fd_(fd) {}
  static Error error_of(int number) {
    return {fmt::format("no file in memory: {}; free some memory, or close programs",
                        std::strerror(number))};
  }
  int fd_ = -1;
};

std::string ending_of(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// Beside the program in a build folder, else where it is installed.
Result<std::string> find_script() {
  for (const fs::path& path : {model::io::program_folder() / "mesh" / "repair.py",
                               model::io::installed("mesh/repair.py")}) {
    std::error_code failed;
    if (fs::is_regular_file(path, failed)) return path.string();
  }
  return Error{
      "only an OBJ file is read, and only looked at, without the package tact-lab; apt install "
      "tact-lab"};
}

/// An OBJ file is read by tact's own parser, which knows the line of an error, and handed on with
/// vertices, their colours and faces alone.
std::optional<Error> write_plain_obj(const std::string& from, const MemoryFile& to) {
  const auto file = model::io::read_file(from, kFileRemedy, model::mesh::kMaxObjBytes);
  if (!file) return file.error();
  if (file->empty()) return Error{from + ":1: the file is empty; export the mesh again"};
  const auto text = model::mesh::parse_obj(*file, from);
  if (!text) return text.error();
  std::string plain;
  for (std::size_t v = 0; v < text->vertex.size(); ++v) {
    const model::Vec3& p = text->vertex[v];
    fmt::format_to(std::back_inserter(plain), "v {} {} {}", p.x, p.y, p.z);
    if (!text->color.empty())
      for (const std::uint8_t level : text->color[v])
        fmt::format_to(std::back_inserter(plain), " {:.4f}", level / 255.0);
    plain += '\n';
  }
  std::size_t corner = 0;
  for (const std::uint32_t end : text->face_end) {
    plain += 'f';
    for (; corner < end; ++corner)
      fmt::format_to(std::back_inserter(plain), " {}", text->corner[corner] + 1);
    plain += '\n';
  }
  return to.put(plain);
}

/// Of what these steps have left.
std::string remedy_of(const std::vector<std::string>& options) {
  std::string missing;
  for (const char* option : {"--weld", "--drop-degenerate"})
    if (std::find(options.begin(), options.end(), option) == options.end())
      missing += fmt::format(" {}", option);
  return missing.empty() ? "repair it in a mesh editor" : "add" + missing;
}

/// What repair.py says, line by line.
class Listener {
 public:
  Listener(const std::function<void(const RepairStep&)>& on_step,
           const std::function<void(const std::string&, int)>& on_percent)
      : on_step_(on_step), on_percent_(on_percent) {}

  void hear(std::string_view line) {
    const auto said = model::io::parse_json(line, "repair.py");
    if (!said || !said->is_object()) return;  // a last word of a library that crashes
    if (said->contains("error")) {
      error = said->value("error", "");
    } else if (said->contains("percent")) {
      on_percent_(said->value("step", ""), said->value("percent", 0));
    } else if (said->contains("text")) {
      steps.push_back({.name = said->value("step", ""),
                       .text = said->value("text", ""),
                       .count = said->value("count", std::int64_t{0}),
                       .faces = said->value("faces", std::int64_t{0})});
      on_step_(steps.back());
    }
  }

  std::vector<RepairStep> steps;
  std::string error;

 private:
  const std::function<void(const RepairStep&)>& on_step_;
  const std::function<void(const std::string&, int)>& on_percent_;
};

/// `message` with the name of the file that a person knows.
std::string about(const std::string& source, const std::string& scratch, std::string message) {
  const std::size_t at = message.find(scratch);
  return at == std::string::npos ? message : message.replace(at, scratch.size(), source);
}

/// Why repair.py ended without a mesh and without a word.
Error no_mesh(const std::string& source, const Error& ran, const std::string& log_path) {
  if (program::was_interrupted(ran)) return ran;
  if (ran.code == model::ErrorCode::kProgramCrashed) {
    return Error{
        fmt::format("{}: its reader in VTK crashed: the file is damaged, or not of the "
                    "format that its ending says; export the mesh again",
                    source)};
  }
  // Its log goes with its caller.
  const auto said = model::io::read_file(log_path);
  const std::string text = said ? *said : "";
  const std::string last = text.substr(text.size() - std::min<std::size_t>(text.size(), 300));
  return Error{fmt::format("{}: the repair failed; try fewer steps, or export the mesh again: {}",
                           source, model::io::on_one_line(last))};
}

}  // namespace

bool is_obj(const std::string& path) { return ending_of(path) == ".obj"; }

bool is_gltf(const std::string& path) {
  return ending_of(path) == ".gltf" || ending_of(path) == ".glb";
}

Result<Repaired> repair_file(const RepairOrder& order,
                             const std::function<void(const RepairStep&)>& on_step,
                             const std::function<void(const std::string&, int)>& on_percent) {
  if (const auto file = model::io::InputFile::open(order.source, kFileRemedy); !file)
    return file.error();
  const auto script = find_script();
  if (!script) return Error{fmt::format("{}: {}", order.source, script.error().message)};
  // In memory: a killed program cleans up nothing, and a scan is a patient's data.
  const auto plain = MemoryFile::make(), repaired = MemoryFile::make(), log = MemoryFile::make();
  for (const auto* file : {&plain, &repaired, &log})
    if (!*file) return file->error();
  std::string source = order.source;
  if (is_obj(source)) {
    source = plain->path();
    if (const auto error = write_plain_obj(order.source, *plain)) return *error;
  }
  const std::string target = repaired->path();
  Listener listener(on_step, on_percent);
  // -I: independent of PYTHONPATH and PYTHONHOME (ROS sets them), it finds Debian's numpy and VTK.
  std::vector<std::string> arguments{"-I", *script};
  arguments.insert(arguments.end(), order.options.begin(), order.options.end());
  arguments.insert(arguments.end(), {"--ending=" + ending_of(order.source), "--", source, target});
  const auto ran = program::run_program(
      {.program = "/usr/bin/python3",  // Debian's own, which finds Debian's VTK
       .arguments = arguments,
       .directory = ".",
       .log_path = log->path(),
       .package = "python3",
       .on_line = [&listener](std::string_view line) { listener.hear(line); }});
  if (!listener.error.empty()) return Error{about(order.source, source, listener.error)};
  if (!ran) return no_mesh(order.source, ran.error(), log->path());

  auto text = model::io::read_file(target, "try again", model::mesh::kMaxObjBytes);
  if (!text) return text.error();
  auto obj = model::mesh::load_obj(
      target, 1.0,
      {.subject = order.source + ": after these steps", .remedy = remedy_of(order.options)});
  if (!obj) return obj.error();
  return Repaired{
      .steps = std::move(listener.steps), .obj_text = std::move(*text), .obj = std::move(*obj)};
}

}  // namespace tact::tools::mesh
