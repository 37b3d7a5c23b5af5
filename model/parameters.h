// SPDX-License-Identifier: Apache-2.0
// parameters.h - parameters of a law or a device, each stated once: key with its unit, range,
// meaning.
//
//     inline void visit(ParameterVisitor& v, SpringParameters& p) {
//       v.number("stiffness_N_per_m", {0.01, 1e5}, "k", p.stiffness_N_per_m);
//     }
//
// The reader of a scene, its reference page, make_* and the tools that change a parameter by key
// all visit, so a range is stated only there. Set-up code only.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "model/result.h"

namespace tact::model {

inline constexpr bool kHard = true;

/// What a scene may say, both ends included: it rejects typing errors. A hard range holds for
/// make_* too; of any other, make_* checks the sign alone.
struct Range {
  double low = 0.0, high = 0.0;
  bool is_hard = false;
};
struct CountRange {
  std::size_t low = 0, high = 0;
  bool is_hard = true;
};

/// Chosen: it keeps out millimetres that were written for metres.
inline constexpr Range kDepth_m{1e-4, 0.1};

/// One of the texts that a key may have.
struct Choice {
  std::string_view name, meaning;
};

/// An optional key that is absent leaves its variable as it was: that is the default.
enum class Need { kRequired, kOptional };

class ParameterVisitor {
 public:
  virtual void number(std::string_view key, Range range, std::string_view meaning, double& value,
                      Need need = Need::kRequired) = 0;
  virtual void count(std::string_view key, CountRange range, std::string_view meaning,
                     std::size_t& value, Need need = Need::kRequired) = 0;
  virtual void flag(std::string_view, std::string_view, bool&, Need = Need::kRequired) {}
  virtual void text(std::string_view, std::string_view, std::string&, Need = Need::kRequired) {}
  /// A file, absolute or from the folder of the document; becomes its absolute path.
  virtual void file(std::string_view, std::string_view, std::string&, Need = Need::kRequired) {}
  /// A whole number that may be negative; optional.
  virtual void whole(std::string_view, Range, std::string_view, int&) {}
  virtual void per_arm(std::string_view, Range, std::string_view, std::array<double, 3>&,
                       Need = Need::kRequired) {}
  /// These keys contradict each other.
  virtual void refuse(std::initializer_list<std::string_view>, const std::string&) {}
  /// The last but one is the index of the choice.
  virtual void choice(std::string_view, std::span<const Choice>, std::string_view, std::size_t&,
                      Need = Need::kRequired) {}
  /// The same for an enumeration, or a flag, whose values are in the order of the choices.
  template <typename T>
    requires(std::is_enum_v<T> || std::is_same_v<T, bool>)
  void choice(std::string_view key, std::span<const Choice> choices, std::string_view meaning,
              T& value, Need need = Need::kRequired) {
    auto index = static_cast<std::size_t>(value);
    choice(key, choices, meaning, index, need);
    value = static_cast<T>(index);
  }

 protected:
  ~ParameterVisitor() = default;
};

/// One number, with a pointer to its variable; of a key that is not there, neither is set.
struct Parameter {
  std::string_view key{}, meaning{};
  Range range{};
  double* number = nullptr;
  std::size_t* count = nullptr;  // of one whose range is hard

  double value() const { return number ? *number : static_cast<double>(*count); }
};

class ParameterList final : public ParameterVisitor {
 public:
  void number(std::string_view key, Range range, std::string_view meaning, double& value,
              Need) override {
    all.push_back({.key = key, .meaning = meaning, .range = range, .number = &value});
  }
  void count(std::string_view key, CountRange range, std::string_view meaning, std::size_t& value,
             Need) override;
  Parameter find(std::string_view key) const;
  /// For make_*: the first without meaning, as an error that names `owner`, it and what is allowed.
  std::optional<Error> check(std::string_view owner) const;

  std::vector<Parameter> all;
};

template <typename Parameters>
ParameterList parameters_of(Parameters& parameters) {
  ParameterList list;
  visit(list, parameters);
  return list;
}

template <typename Parameters>
std::optional<Error> check_meaning(std::string_view law, Parameters parameters) {
  return parameters_of(parameters).check(law);
}

}  // namespace tact::model
