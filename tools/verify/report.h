// SPDX-License-Identifier: Apache-2.0
// report.h - how a recomputed value is compared with a published one, and who recomputes it.
//
//     pass:  |got - want| <= max(abs[kind], rel |want|),  element by element,
//            kind = field_kinds[field]
//
// A kind without an entry in abs has abs 0; a case may carry its own tolerance. A number whose
// field has no kind, a string and a boolean must be equal; fields that the file does not expect are
// not looked at; the strings NaN, Infinity and -Infinity stand for those values.
//
// A new law: write its verify function, put it into a table like kinematics_verifiers(), and name
// that table in main.cc.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace tact::tools::verify {

/// The tolerance block of a vector file, with the kinds of its fields.
struct Tolerance {
  double rel = 0.0;
  std::map<std::string, double> abs;           // by kind
  std::map<std::string, std::string> kind_of;  // by field

  static Tolerance of_file(const nlohmann::json& file);
  /// This, or what the case brings along.
  Tolerance for_case(const nlohmann::json& one_case) const;
};

struct Failure {
  std::string id;     // of the case
  std::string field;  // with the index of the element
  nlohmann::json got, want;
  double tolerance = 0.0;  // largest permitted difference; 0: must be equal
};

class Report {
 public:
  /// Everything until the next case belongs to this one; a case passes if all its fields do.
  void begin_case(const std::string& id);
  /// Each of a list is a case: "name/0", "name/1", ...
  template <class Check>
  void each(const std::string& name, const nlohmann::json& list, const Check& check) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      begin_case(name + "/" + std::to_string(i));
      check(list.at(i));
    }
  }
  /// The rule above for one field of any shape; `numeric` says that its numbers need not be equal.
  void compare(const std::string& field, const nlohmann::json& got, const nlohmann::json& want,
               bool numeric, double abs, double rel);
  void equal(const std::string& field, const nlohmann::json& got, const nlohmann::json& want) {
    compare(field, got, want, false, 0.0, 0.0);
  }
  /// The rule with one of its two tolerances.
  void near(const std::string& field, const nlohmann::json& got, const nlohmann::json& want,
            double abs) {
    compare(field, got, want, true, abs, 0.0);
  }
  void near_ratio(const std::string& field, const nlohmann::json& got, const nlohmann::json& want,
                  double rel) {
    compare(field, got, want, true, 0.0, rel);
  }
  /// The rule above for all fields in `expect`.
  void compare_all(const nlohmann::json& got, const nlohmann::json& expect,
                   const Tolerance& tolerance);

  /// The file itself is wrong. The first message is kept; what follows is computed for nothing.
  void call_damaged(const std::string& message);
  const std::string& damage() const { return damage_; }  // empty: none

  int passed() const { return cases_ - failed(); }
  int failed() const { return failed_; }
  const std::vector<Failure>& failures() const { return failures_; }

 private:
  void fail(Failure failure);

  std::string id_, damage_;
  bool id_failed_ = false;
  int cases_ = 0;
  int failed_ = 0;
  std::vector<Failure> failures_;
};

/// A number, or NaN, Infinity or -Infinity as a string. Another string is damage, which the library
/// reports by an exception.
double number(const nlohmann::json& value);

/// The word of a file for a value that counts from 0.
template <class Enum, std::size_t N>
const char* word(const char* const (&words)[N], Enum value) {
  return words[static_cast<std::size_t>(value)];
}
/// For model::law::LawStatus.
inline constexpr const char* kLawStatus[] = {"OK", "NO_CONTACT", "SATURATED", "SINGULAR",
                                             "INVALID_ARGUMENT"};

/// For a file whose cases have id, expect and all that `kResults` wants: the recomputed fields.
template <nlohmann::json (*kResults)(const nlohmann::json& one_case)>
void verify_cases(const nlohmann::json& file, Report& report) {
  const Tolerance tolerance = Tolerance::of_file(file);
  for (const nlohmann::json& one_case : file.at("cases")) {
    report.begin_case(one_case.at("id"));
    report.compare_all(kResults(one_case), one_case.at("expect"), tolerance.for_case(one_case));
  }
}

/// Recomputes all cases of one kind of file.
struct Verifier {
  const char* law;  // the file's "law", or its "schema" where it has no law
  void (*verify)(const nlohmann::json& file, Report& report);
};

std::span<const Verifier> kinematics_verifiers();
std::span<const Verifier> rhombus_verifiers();
std::span<const Verifier> tracking_verifiers();
std::span<const Verifier> disc_verifiers();
std::span<const Verifier> hex_verifiers();
std::span<const Verifier> sphere_verifiers();
std::span<const Verifier> spring_verifiers();
std::span<const Verifier> falcon_verifiers();
std::span<const Verifier> can_verifiers();

}  // namespace tact::tools::verify
