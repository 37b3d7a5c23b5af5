// SPDX-License-Identifier: Apache-2.0
// tact-verify: do laws, kinematics and frames give the published numbers on this machine?
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "model/io/json.h"
#include "model/io/program/installed.h"
#include "tools/program/program.h"
#include "tools/verify/report.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using tact::model::Error;
using tact::model::Result;
using tact::tools::program::Program;
using tact::tools::verify::Failure;
using tact::tools::verify::Report;
using tact::tools::verify::Verifier;

constexpr const char* kVectors = "tests/data/vectors";

struct FileReport {
  std::string name;
  std::string law;
  Report report;
};

std::vector<Verifier> known_verifiers() {
  std::vector<Verifier> known;
  for (const auto& table :
       {tact::tools::verify::kinematics_verifiers(), tact::tools::verify::rhombus_verifiers(),
        tact::tools::verify::tracking_verifiers(), tact::tools::verify::disc_verifiers(),
        tact::tools::verify::hex_verifiers(), tact::tools::verify::sphere_verifiers(),
        tact::tools::verify::spring_verifiers(), tact::tools::verify::falcon_verifiers(),
        tact::tools::verify::can_verifiers()}) {
    known.insert(known.end(), table.begin(), table.end());
  }
  return known;
}

/// The vectors beside the sources: upwards from here, then upwards from the program; else the
/// installed ones.
Result<std::string> default_directory() {
  std::error_code ignored;
  for (const fs::path& start :
       // A build folder has the vectors above itself, wherever the program was called from.
       {fs::current_path(ignored), fs::read_symlink("/proc/self/exe", ignored)}) {
    for (fs::path at = start; !at.empty(); at = at.parent_path()) {
      if (fs::is_directory(at / kVectors, ignored)) return (at / kVectors).string();
      if (at == at.root_path()) break;
    }
  }
  if (const fs::path installed = tact::model::io::installed("vectors");
      fs::is_directory(installed, ignored))
    return installed.string();
  return Error{fmt::format("no {} here or above; name the vector files", kVectors)};
}

Result<std::vector<std::string>> files_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(path, error))
      if (entry.path().extension() == ".json") found.push_back(entry.path().string());
    if (error) return Error{fmt::format("{}: {}", path, error.message())};
    if (found.empty()) return Error{fmt::format("{}: no .json file in it; name another", path)};
    // A directory lists in any order; two runs must print alike.
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

Error damaged(const std::string& path, const std::string& why) {
  return Error{fmt::format("{}: damaged vector file: {}; take a fresh copy", path, why)};
}

Result<FileReport> verify_file(const std::string& path) {
  const auto read = tact::model::io::read_json(path, "check the name, or take a fresh copy");
  if (!read) return read.error();
  try {  // nlohmann/json reports damage by exceptions
    const json& file = *read;
    const std::string key = file.contains("law") ? "law" : "schema";
    FileReport out{fs::path(path).filename().string(), file.value(key, ""), {}};
    for (const Verifier& verifier : known_verifiers()) {
      if (verifier.law != out.law) continue;
      verifier.verify(file, out.report);
      if (!out.report.damage().empty()) return damaged(path, out.report.damage());
      // All of nothing would pass.
      if (out.report.passed() + out.report.failed() > 0) return out;
      return Error{fmt::format("{}: holds no case, so it proves nothing; take a fresh copy", path)};
    }
    return Error{
        fmt::format("{}: this build does not know the {} \"{}\"; leave the file out or "
                    "take a build that knows it",
                    path, key, out.law)};
  } catch (const std::exception& damage) {
    return damaged(path, damage.what());
  }
}

void print_text(const FileReport& file) {
  fmt::print("{}: {} passed, {} failed\n", file.name, file.report.passed(), file.report.failed());
  for (const Failure& f : file.report.failures()) {
    fmt::print("  {} {}: got {}, want {}, tolerance {:g}\n", f.id, f.field,
               tact::model::io::text_of(f.got), tact::model::io::text_of(f.want), f.tolerance);
  }
}

json to_json(const FileReport& file) {
  json failures = json::array();
  for (const Failure& f : file.report.failures()) {
    failures.push_back({{"id", f.id},
                        {"field", f.field},
                        {"got", f.got},
                        {"want", f.want},
                        {"tolerance", f.tolerance}});
  }
  return {{"file", file.name},
          {"law", file.law},
          {"passed", file.report.passed()},
          {"failed", file.report.failed()},
          {"failures", failures}};
}

int run(const Program& program, std::vector<std::string> paths, bool as_json) {
  if (paths.empty()) {
    const auto directory = default_directory();
    if (!directory) return program.fail(directory.error());
    paths.push_back(*directory);
  }
  const auto files = files_of(paths);
  if (!files) return program.fail(files.error());
  int passed = 0, failed = 0, status = 0;
  json out = json::array();
  for (const std::string& path : *files) {
    const auto report = verify_file(path);
    if (!report) {
      // The other files are evaluated all the same; the exit status remembers.
      status = program.fail(report.error());
      continue;
    }
    passed += report->report.passed();
    failed += report->report.failed();
    if (as_json)
      out.push_back(to_json(*report));
    else
      print_text(*report);
  }
  if (as_json)
    fmt::print("{}\n", tact::model::io::text_of(json{{"format", "tact-verify"},
                                                     {"version", 1},
                                                     {"passed", passed},
                                                     {"failed", failed},
                                                     {"files", out}},
                                                2));
  // A file that could not be evaluated weighs more than a case that failed.
  if (status != 0) return status;
  return failed > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Program program(
      "tact-verify", "Recompute published cases and compare, each at the tolerance of its file.",
      "SI units: m, rad, N, N m, kg. A file that is unreadable or unknown is bad input.");
  std::vector<std::string> paths;
  bool as_json = false;
  program.options().add_option(
      "files", paths,
      "vector files or directories of them (default: tests/data/vectors, or the installed ones)");
  program.options().add_flag("--json", as_json, "print one JSON document");
  if (const auto status = program.parse(argc, argv)) return *status;
  return run(program, paths, as_json);
}
