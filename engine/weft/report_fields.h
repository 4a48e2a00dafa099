/// The fields of StepReport as one list, for code that treats all of them alike: that writes,
/// compares, shows or adds up reports. weft.h does not include it.
///
///   weft::for_each_report_field([&](const auto& field) {
///     print(field.name, report.*field.member);
///   });
#pragma once

#include <weft/cloth.h>

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

namespace weft {

/// How a figure of several steps follows from the figures of each.
enum class OverSteps : std::uint8_t {
  sum,
  largest,  ///< the worst status
  last,
  none  ///< It belongs to one step.
};

template <class Value>
struct ReportField {
  constexpr ReportField(const char* its_name, Value StepReport::*its_member, OverSteps rule,
                        const char* its_text)
      : name(its_name), member(its_member), over_steps(rule), text(its_text) {}

  const char* name;
  Value StepReport::*member;
  OverSteps over_steps;
  const char* text;  ///< in a few words; StepReport says more
};

/// In the order in which StepReport declares them.
inline constexpr std::tuple kReportFields{
    ReportField{"status", &StepReport::status, OverSteps::largest, "a Status"},
    ReportField{"asleep", &StepReport::asleep, OverSteps::last, "no work was done"},
    ReportField{"substeps", &StepReport::substeps, OverSteps::sum, "done"},
    ReportField{"halvings", &StepReport::halvings, OverSteps::sum, "attempts that were rejected"},
    ReportField{"iterations", &StepReport::iterations, OverSteps::sum,
                "passes over the position constraints"},
    ReportField{"direction_updates", &StepReport::direction_updates, OverSteps::sum,
                "renewals of directions"},
    ReportField{"velocity_iterations", &StepReport::velocity_iterations, OverSteps::sum,
                "passes of the velocity loop"},
    ReportField{"visits", &StepReport::visits, OverSteps::sum,
                "constraints whose error was looked at"},
    ReportField{"corrections", &StepReport::corrections, OverSteps::sum, "impulses applied"},
    ReportField{"scheme_fallbacks", &StepReport::scheme_fallbacks, OverSteps::sum,
                "attempts that rattle left to the other scheme"},
    ReportField{"contacts", &StepReport::contacts, OverSteps::largest,
                "candidate pairs of spheres"},
    ReportField{"max_strain", &StepReport::max_strain, OverSteps::largest,
                "recomputed from the positions"},
    ReportField{"rms_strain", &StepReport::rms_strain, OverSteps::last, "root mean square"},
    ReportField{"max_shear", &StepReport::max_shear, OverSteps::largest, "rad"},
    ReportField{"max_error", &StepReport::max_error, OverSteps::largest,
                "the largest error of a law; `tolerance` bounds it"},
    ReportField{"max_bending_error", &StepReport::max_bending_error, OverSteps::largest,
                "the share of the forces of bending that is left; `tolerance` bounds it"},
    ReportField{"worst_constraint", &StepReport::worst_constraint, OverSteps::none,
                "its number in the description, or kNoIndex"},
    ReportField{"worst_element", &StepReport::worst_element, OverSteps::none,
                "likewise, of the largest strain or shear"},
    ReportField{"max_penetration", &StepReport::max_penetration, OverSteps::largest,
                "m, beyond the thickness"},
    ReportField{"body_contacts", &StepReport::body_contacts, OverSteps::largest,
                "pairs that touch"},
    ReportField{"contact_failures", &StepReport::contact_failures, OverSteps::sum,
                "pairs that verification stopped"},
    ReportField{"zones", &StepReport::zones, OverSteps::sum,
                "pairs that were moved as one, as if glued"},
    ReportField{"intersecting", &StepReport::intersecting, OverSteps::largest,
                "triangles that cross a mesh when the step ends"},
    ReportField{"self_contacts", &StepReport::self_contacts, OverSteps::largest,
                "pairs of the cloth that touch each other"},
    ReportField{"tangled", &StepReport::tangled, OverSteps::last,
                "pairs of triangles of the cloth that cross each other"},
    ReportField{"max_anchor_error", &StepReport::max_anchor_error, OverSteps::largest, "m"},
    ReportField{"open_seams", &StepReport::open_seams, OverSteps::last,
                "seams that have not come together"},
    ReportField{"max_seam_gap", &StepReport::max_seam_gap, OverSteps::largest, "m"},
    ReportField{"seam_work", &StepReport::seam_work, OverSteps::sum, "J"},
    ReportField{"motion_error", &StepReport::motion_error, OverSteps::largest, "m/s, estimated"},
    ReportField{"energy_lost", &StepReport::energy_lost, OverSteps::sum, "J"},
    ReportField{"pin_work", &StepReport::pin_work, OverSteps::sum, "J"},
    ReportField{"body_work", &StepReport::body_work, OverSteps::sum, "J"},
    ReportField{"friction_work", &StepReport::friction_work, OverSteps::sum, "J"},
    ReportField{"failed_particle", &StepReport::failed_particle, OverSteps::none,
                "one that is not finite, or kNoIndex"},
    ReportField{"passed_particle", &StepReport::passed_particle, OverSteps::none,
                "one that passed through, or kNoIndex"},
    ReportField{"stage_seconds", &StepReport::stage_seconds, OverSteps::sum,
                "s, of each Stage of the step"},
    ReportField{"contact_ms", &StepReport::contact_ms, OverSteps::sum,
                "ms, of contacts with bodies: find, sweep and verify"},
    ReportField{"late_seams", &StepReport::late_seams, OverSteps::last,
                "seams that are open although their time is over"},
    ReportField{"worst_seam", &StepReport::worst_seam, OverSteps::last,
                "the number of one of these, or of one in held_apart, or kNoIndex"},
    ReportField{"held_apart", &StepReport::held_apart, OverSteps::last,
                "seams and constraints that two held particles exclude"},
    ReportField{"worst_held", &StepReport::worst_held, OverSteps::last,
                "the number of such a constraint, or kNoIndex"},
    ReportField{"untangling_work", &StepReport::untangling_work, OverSteps::sum, "J"},
    ReportField{"max_rail_gap", &StepReport::max_rail_gap, OverSteps::largest, "m"},
    ReportField{"torn", &StepReport::torn, OverSteps::sum, "what broke when the step ended"},
    ReportField{"law_error", &StepReport::law_error, OverSteps::largest,
                "the largest error of a law that carried load"},
};
inline constexpr std::size_t kReportFieldCount = std::tuple_size_v<decltype(kReportFields)>;

/// Calls visit(field) with each ReportField.
template <class Visit>
constexpr void for_each_report_field(Visit&& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (visit(std::get<i>(kReportFields)), ...); }
  (std::make_index_sequence<kReportFieldCount>());
}

namespace detail {

/// Stands for a value of any field.
struct AnyValue {
  template <class Value>
  operator Value() const;
};
template <std::size_t>
using AnyValueOf = AnyValue;

template <class Aggregate, std::size_t... i>
constexpr bool takes_values(std::index_sequence<i...>) {
  return requires { Aggregate{AnyValueOf<i>{}...}; };
}
/// Whether the aggregate has so many fields, not fewer and not more.
template <class Aggregate, std::size_t count>
constexpr bool has_fields() {
  return takes_values<Aggregate>(std::make_index_sequence<count>()) &&
         !takes_values<Aggregate>(std::make_index_sequence<count + 1>());
}

}  // namespace detail

static_assert(detail::has_fields<StepReport, kReportFieldCount>(),
              "a field of StepReport is missing in kReportFields");

}  // namespace weft
