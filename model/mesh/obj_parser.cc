// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/obj_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

namespace tact::model::mesh {
namespace {

// Statements that do not change the surface: those that carry a name, which may hold any character,
// and those that carry numbers, which a backslash may continue on the next line.
constexpr std::array<std::string_view, 10> kNamed{
    "g", "o", "s", "usemtl", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj", "call"};
constexpr std::array<std::string_view, 30> kNumbered{
    "vn",    "vt",    "vp",   "l",    "p",    "mg",   "deg",      "bmat",     "step",  "cstype",
    "curv",  "curv2", "surf", "parm", "trim", "hole", "scrv",     "sp",       "end",   "con",
    "bevel", "lod",   "res",  "bsp",  "bzp",  "cdc",  "c_interp", "d_interp", "ctech", "stech"};

template <std::size_t n>
bool holds(const std::array<std::string_view, n>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// At most 24 printable characters of the file's text, so that an error stays one line.
std::string quoted(std::string_view word) {
  std::string shown(word.substr(0, 24));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return "'" + shown + (word.size() > shown.size() ? "...'" : "'");
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& name)
      : at_(text.data()), end_(text.data() + text.size()), name_(name) {
    // Line feeds end a line, with or without a carriage return; old exporters write only the
    // latter.
    if (text.find('\n') == std::string_view::npos) line_end_ = '\r';
  }

  Result<ObjText> parse() {
    while (at_ != end_ && !error_) {
      ++line_;
      statement_line_ = line_;
      stop_ = find_line_end(at_);
      parse_statement();
      at_ = stop_ == end_ ? end_ : stop_ + 1;
    }
    if (!error_) check_corners();
    if (error_) return *error_;
    text_.lines = line_;
    if (text_.color.size() != text_.vertex.size()) text_.color.clear();
    return std::move(text_);
  }

 private:
  const char* find_line_end(const char* from) const {
    if (from == end_) return end_;
    const void* found = std::memchr(from, line_end_, static_cast<std::size_t>(end_ - from));
    return found != nullptr ? static_cast<const char*>(found) : end_;
  }

  // Steps over blanks, and over a backslash that continues the statement on the next line.
  void skip_blanks() {
    while (at_ != stop_) {
      if (is_blank(*at_)) {
        ++at_;
      } else if (*at_ == '\\' && stop_ != end_ && std::all_of(at_ + 1, stop_, is_blank)) {
        at_ = stop_ + 1;
        stop_ = find_line_end(at_);
        ++line_;
      } else {
        return;
      }
    }
  }

  bool at_statement_end() {
    skip_blanks();
    return at_ == stop_ || *at_ == '#';
  }

  // The word at the cursor, without moving.
  std::string_view peek_word() const {
    const char* last = at_;
    while (last != stop_ && !is_blank(*last)) ++last;
    return {at_, static_cast<std::size_t>(last - at_)};
  }

  void fail(const std::string& message) {
    error_ = Error{fmt::format("{}:{}: {}", name_, statement_line_, message)};
  }

  void parse_statement() {
    if (at_statement_end()) return;
    const std::string_view word = peek_word();
    at_ += word.size();
    if (word == "v") return parse_vertex();
    // fo: the face outline of old files, read as f.
    if (word == "f" || word == "fo") return parse_face();
    if (holds(kNumbered, word)) {
      while (!at_statement_end()) at_ += peek_word().size();
      return;
    }
    if (holds(kNamed, word)) return;
    fail(fmt::format("{} is not an OBJ statement; export the mesh as OBJ text", quoted(word)));
  }

  // One number; false after an error.
  bool parse_number(double& number) {
    const std::string_view word = peek_word();
    const char* last = word.data() + word.size();
    const char* first = word.data() + (word.size() > 1 && word[0] == '+' && word[1] != '-');
    const auto [stopped, code] = std::from_chars(first, last, number);
    const bool beyond = code == std::errc::result_out_of_range;
    // 1e-400 and 1e400 are both "out of range"; the sign of the exponent distinguishes them.
    const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
    const bool read = (code == std::errc{} || beyond) && stopped == last;
    // 0 is near enough to the tiny one; the other is made large enough to be refused below.
    if (beyond) number = tiny ? 0.0 : 2.0 * kMaxObjCoordinate;
    at_ = last;
    if (read && std::abs(number) <= kMaxObjCoordinate) return true;
    if (read && std::isfinite(number)) {
      fail(fmt::format("{} is beyond 1e12; scale the mesh down", quoted(word)));
    } else if (read) {
      fail(fmt::format("{} is not a finite number; repair the vertex and export again",
                       quoted(word)));
    } else if (word.find(',') != std::string_view::npos) {
      fail(fmt::format("{} has a decimal comma; export with decimal points", quoted(word)));
    } else {
      fail(fmt::format("{} is not a number; repair the vertex and export again", quoted(word)));
    }
    return false;
  }

  void parse_vertex() {
    std::array<double, 6> x{};  // x y z, red green blue
    std::size_t count = 0;
    for (; !at_statement_end(); ++count) {
      double number = 0.0;
      if (!parse_number(number)) return;
      if (count < x.size()) x[count] = number;
    }
    if (count < 3) {
      return fail(
          fmt::format("the vertex has {} of 3 numbers; the file may be cut short, "
                      "export it again",
                      count));
    }
    if (text_.vertex.size() == kMaxObjVertices)
      return fail(fmt::format("more than {} vertices; simplify the mesh", kMaxObjVertices));
    text_.vertex.push_back({x[0], x[1], x[2]});
    const auto is_share = [](double c) { return c >= 0.0 && c <= 1.0; };
    if (count != x.size() || !std::all_of(x.begin() + 3, x.end(), is_share)) return;
    const auto level = [](double c) { return static_cast<std::uint8_t>(std::lround(255.0 * c)); };
    text_.color.push_back({level(x[3]), level(x[4]), level(x[5])});
  }

  // v, v/vt, v//vn or v/vt/vn: the vertex number counts, the rest must be whole numbers or absent.
  bool parse_corner() {
    const std::string_view word = peek_word();
    const char* last = word.data() + word.size();
    at_ = last;
    std::int64_t number = 0;
    auto [next, code] = std::from_chars(word.data(), last, number);
    bool read = code == std::errc{};
    for (int part = 0; read && part < 2 && next != last && *next == '/'; ++part) {
      ++next;
      if (next == last || *next == '/') continue;
      std::int64_t ignored = 0;
      const auto [after, part_code] = std::from_chars(next, last, ignored);
      read = part_code == std::errc{};
      next = after;
    }
    if (!read || next != last) {
      fail(fmt::format("{} is not a face corner; write v, v/vt, v//vn or v/vt/vn", quoted(word)));
      return false;
    }
    if (number == 0) {
      fail("the face names vertex 0 but OBJ counts from 1; export the mesh again");
      return false;
    }
    // A number below zero counts back from the vertices above; one
    // above zero may name a later one (check_corners).
    const auto known = static_cast<std::int64_t>(text_.vertex.size());
    const std::int64_t index = number > 0 ? number - 1 : known + number;
    if (index < 0 || index >= static_cast<std::int64_t>(kMaxObjVertices)) {
      fail(fmt::format("the face names vertex {} but {} stand above it; export the mesh again",
                       number, known));
      return false;
    }
    text_.corner.push_back(static_cast<std::uint32_t>(index));
    return true;
  }

  void parse_face() {
    const std::size_t first = text_.corner.size();
    while (!at_statement_end()) {
      if (!parse_corner()) return;
      if (text_.corner.size() - first > kMaxFaceCorners) {
        return fail(fmt::format("the face has more than {} corners; triangulate the mesh",
                                kMaxFaceCorners));
      }
    }
    const std::size_t corners = text_.corner.size() - first;
    if (corners < 3) {
      return fail(
          fmt::format("the face has {} of at least 3 corners; the file may be cut short, "
                      "export it again",
                      corners));
    }
    // Of the polygon when it is cut; counted now, so that a huge file is refused early.
    triangles_ += corners - 2;
    if (triangles_ > kMaxObjTriangles)
      return fail(fmt::format("more than {} triangles; simplify the mesh", kMaxObjTriangles));
    text_.face_end.push_back(static_cast<std::uint32_t>(text_.corner.size()));
    text_.face_line.push_back(static_cast<std::uint32_t>(statement_line_));
  }

  // Last of all, because a face may stand above its vertices.
  void check_corners() {
    std::size_t i = 0;
    for (std::size_t face = 0; face < text_.face_end.size(); ++face) {
      for (; i < text_.face_end[face]; ++i) {
        if (text_.corner[i] < text_.vertex.size()) continue;
        statement_line_ = text_.face_line[face];
        return fail(
            fmt::format("the face names vertex {} but the file has {}; "
                        "export the mesh again",
                        text_.corner[i] + 1, text_.vertex.size()));
      }
    }
  }

  const char* at_;
  const char* end_;
  const char* stop_ = nullptr;  // end of the current line
  char line_end_ = '\n';
  const std::string& name_;
  std::size_t line_ = 0;
  std::size_t statement_line_ = 0;  // where the current statement begins
  std::size_t triangles_ = 0;
  ObjText text_;
  std::optional<Error> error_;
};

}  // namespace

Result<ObjText> parse_obj(std::string_view text, const std::string& name) {
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
    return Error{
        fmt::format("{}:{}: binary or UTF-16 data; export the mesh as OBJ text", name, line)};
  }
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);  // byte order mark
  return Parser(text, name).parse();
}

}  // namespace tact::model::mesh
