// SPDX-License-Identifier: Apache-2.0
// scene_reader.h - one statement per key: name with its unit, range, meaning, and where it goes.
//
// A scene is described by functions that visit its keys through Keys. The same visit serves twice:
// reading, it takes values from a document and notes every problem; describing, it has no document
// and notes one row of the reference per key. What a visit of a section did not name is unknown.
// One problem is reported: wrong values before missing keys before keys that contradict
// each other, in the order of the file, overrides first. Set-up code only.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/parameters.h"
#include "model/reader/scene_document.h"
#include "model/reader/scene_values.h"
#include "model/result.h"
#include "model/types.h"

namespace tact::model::reader {

/// One line of the reference; a heading has no key.
struct ReferenceRow {
  std::string section, key, allowed, fallback, meaning;
};

enum class ProblemKind { kWrong, kMissing, kConflict };

/// What one visit found.
class SceneVisit {
 public:
  /// Without a document the visit describes.
  explicit SceneVisit(const SceneDocument* document) : document_(document) {}

  const SceneDocument* document() const { return document_; }
  const std::vector<ReferenceRow>& rows() const { return rows_; }
  void add(ReferenceRow row) { rows_.push_back(std::move(row)); }
  void note(ProblemKind kind, const TextPosition& position, const std::string& message);
  /// The problem to report, if there is one.
  std::optional<Error> problem() const;

 private:
  struct Problem {
    ProblemKind kind;
    std::uint32_t line;
    std::string message;
  };
  const SceneDocument* document_;
  std::vector<ReferenceRow> rows_;
  std::vector<Problem> problems_;
};

/// The keys of one section, while it is being visited.
class Keys final : public ParameterVisitor {
 public:
  using Inside = std::function<void(Keys&)>;
  /// Visits the whole document, or describes it.
  static void visit_root(SceneVisit& visit, const Inside& inside);

  void text(std::string_view key, std::string_view meaning, std::string& out,
            Need need = Need::kRequired) override;
  void file(std::string_view key, std::string_view meaning, std::string& out,
            Need need = Need::kRequired) override {
    text(key, meaning, out, need);
    if (table_ && !out.empty()) out = path_beside(visit_.document()->path, out);
  }
  void flag(std::string_view key, std::string_view meaning, bool& out,
            Need need = Need::kRequired) override;
  void number(std::string_view key, Range range, std::string_view meaning, double& out,
              Need need = Need::kRequired) override;
  void count(std::string_view key, CountRange range, std::string_view meaning, std::size_t& out,
             Need need = Need::kRequired) override;
  void whole(std::string_view key, Range range, std::string_view meaning, int& out) override {
    double value = out;
    number(key, range, meaning, value, Need::kOptional);
    if (value != std::floor(value)) refuse({key}, std::string(key) + " takes a whole number");
    out = static_cast<int>(value);
  }
  void vector(std::string_view key, Range each, std::string_view meaning, Vec3& out,
              Need need = Need::kRequired);
  void per_arm(std::string_view key, Range each, std::string_view meaning,
               std::array<double, 3>& out, Need need = Need::kRequired) override;
  /// A rotation: [w, x, y, z], of any length.
  void quaternion(std::string_view key, std::string_view meaning, std::array<double, 4>& out,
                  Need need = Need::kRequired);
  /// A list of [number, x, y, z]: points with a number each.
  void points(std::string_view key, Range each, std::string_view meaning,
              std::vector<std::array<double, 4>>& out);
  using ParameterVisitor::choice;
  /// Many choices get a row each in the reference.
  void choice(std::string_view key, std::span<const Choice> choices, std::string_view meaning,
              std::size_t& out, Need need = Need::kRequired) override;

  /// [key]; true when it is there.
  bool section(std::string_view key, std::string_view meaning, const Inside& inside,
               Need need = Need::kRequired);
  template <typename T>
  bool section(std::string_view key, std::string_view meaning, void (*visit)(Keys&, T&), T& out,
               Need need = Need::kRequired) {
    return section(key, meaning, [&](Keys& keys) { visit(keys, out); }, need);
  }
  /// An optional one, kept when it is there.
  template <typename T>
  void section(std::string_view key, std::string_view meaning, void (*visit)(Keys&, T&),
               std::optional<T>& out) {
    T value;
    if (section(key, meaning, visit, value, Need::kOptional)) out = value;
  }
  /// [[key]], visited once for each entry.
  void entries(std::string_view key, CountRange range, std::string_view meaning,
               const Inside& inside);
  /// The value of `key` decides which further keys the section has; describing visits them all.
  void one_of(std::string_view key, std::span<const Choice> choices,
              const std::function<void(std::size_t)>& further);

  /// All other keys of this section are for another reader: none is unknown.
  void leave_others() { all_named_ = false; }

  /// The line of a key, or else of its section.
  TextPosition position_of(std::string_view key) const;
  /// These keys contradict each other; reported at the overridden one, or else at the first.
  void refuse(std::initializer_list<std::string_view> keys, const std::string& message) override;

 private:
  struct Known {
    std::string_view key;
    std::string allowed;
  };

  Keys(SceneVisit& visit, const toml::table* table, std::string path)
      : visit_(visit), table_(table), path_(std::move(path)) {}

  const toml::node* take(std::string_view key, std::string allowed, std::string_view meaning,
                         std::string fallback = {});
  std::optional<std::size_t> match(std::string_view key, std::span<const Choice> choices,
                                   const toml::node& node);
  void describe(std::string_view key, std::span<const Choice> choices);
  template <typename T>
  void store(const toml::node& node, std::string_view key, Result<T> value, T& out);
  void check(const toml::node& node, std::string_view key, std::string_view problem);
  void finish();
  std::string unknown_message(std::string_view key) const;
  std::string path_to(std::string_view key) const;

  SceneVisit& visit_;
  const toml::table* table_;  // null: describing
  std::string path_;          // "hand.stroke.2", "" of the root
  std::vector<Known> known_;
  bool all_named_ = true;  // false: which keys are allowed could not be decided
};

}  // namespace tact::model::reader
