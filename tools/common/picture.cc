#include "tools/common/picture.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "tools/common/table.h"

namespace tact::tools {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

constexpr int kNotFound = 127;

/// Exit status of gnuplot; kNotFound if there is none. What it says goes to a file.
int run_gnuplot(const std::string& settings, const std::string& script, const std::string& log) {
  const pid_t child = fork();
  if (child < 0) return kNotFound;
  if (child == 0) {
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execlp("gnuplot", "gnuplot", "-e", settings.c_str(), script.c_str(), nullptr);
    _exit(kNotFound);
  }
  int ended = 0;
  waitpid(child, &ended, 0);
  return WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
}

/// In gnuplot a quote inside quotes is written twice.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::string head(const Picture& p) {
  std::string inks;
  for (std::size_t i = 0; i < std::size(kInk); ++i)
    inks += fmt::format("set linetype {} lc rgb '{}'\n", i + 1, kInk[i]);
  return inks +
         fmt::format(
             "# Draw again: gnuplot -e \"directory='.'; kind='png'\" {0}.gp\n"
             "if (!exists('directory')) directory = '.'\n"
             "if (!exists('kind')) kind = 'svg'\n"
             "cd directory\n"
             "if (kind eq 'png') {{ set terminal pngcairo size {1},{2} font 'DejaVu Sans,11' }}\n"
             "if (kind eq 'svg') {{ set terminal svg size {1},{2} font 'DejaVu Sans,Arial,14' "
             "background '#ffffff' }}\n"
             "set output '{0}.'.kind\n"
             "set datafile separator ','\n"
             "set datafile columnheaders\n"
             "set encoding utf8\n"
             "set border lc '#444444'\n"
             "set grid lc '#dddddd'\n"
             "set key font ',10'\n",
             p.name, p.width_px, p.height_px);
}

}  // namespace

Result<std::vector<std::string>> draw(const Picture& picture, const std::string& directory) {
  const std::string stem = (fs::path(directory) / picture.name).string();
  if (auto script = write_whole_file(stem + ".gp", head(picture) + picture.script); !script)
    return script.error();
  std::vector<std::string> files;
  for (const char* kind : {"svg", "png"}) {
    const std::string log = stem + ".gnuplot.txt";
    const int status = run_gnuplot(fmt::format("directory={}; kind='{}'", quoted(directory), kind),
                                   stem + ".gp", log);
    if (status == kNotFound)
      return Error{"gnuplot is not installed, so there is no picture; apt install gnuplot-nox"};
    const std::string path = stem + "." + kind;
    if (status != 0 || !fs::exists(path))
      return Error{
          fmt::format("gnuplot could not draw {}; its script is {}.gp, what it says is in {}", path,
                      stem, log)};
    fs::remove(log);
    files.push_back(path);
  }
  return files;
}

}  // namespace tact::tools
