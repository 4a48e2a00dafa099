/// Pins, anchors, frames and changes of a cloth in C.
#include "engine/c_interface/arrays.h"
#include "engine/c_interface/handles.h"
#include "engine/c_interface/scene_arrays.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

using MovePins = Result<void> (Cloth::*)(std::span<const std::uint32_t>, std::span<const Vec3>);

Result<void> move_pins(weft_cloth* cloth, std::size_t count, const std::uint32_t* particles,
                       const double* positions, MovePins move) {
  if (auto r = given({{"cloth", cloth}}); !r) return r;
  Arrays in;
  const auto who = in.needed<std::uint32_t>("particles", particles, count);
  const auto where = in.needed<Vec3>("positions", positions, count);
  if (!in.are_good()) return in.error();
  return (cloth->cloth.*move)(who, where);
}

Result<void> with_seams(weft_cloth* cloth, std::size_t count, const std::uint32_t* seams,
                        Result<void> (Cloth::*give)(std::span<const std::uint32_t>)) {
  if (auto r = given({{"cloth", cloth}}); !r) return r;
  Arrays in;
  const auto which = in.needed<std::uint32_t>("seams", seams, count);
  if (!in.are_good()) return in.error();
  return (cloth->cloth.*give)(which);
}

RigidMotion motion_of(const double* translation, const double* rotation, const double* about) {
  return {vector_of(translation), vector_of(rotation), vector_of(about)};
}

weft_changes no_changes() {
  weft_changes changes{};
  changes.size = sizeof changes;
  return changes;
}

std::vector<ChangedValue> values(Arrays& in, std::string_view whose, const std::uint32_t* numbers,
                                 std::string_view field, const double* values, std::size_t count) {
  const auto indices = in.needed<std::uint32_t>(whose, numbers, count);
  const auto given = in.needed<double>(field, values, count);
  std::vector<ChangedValue> list;
  if (!in.are_good()) return list;
  for (std::size_t i = 0; i < count; ++i) list.push_back({indices[i], given[i]});
  return list;
}

std::vector<ChangedMembrane> changed_membrane(Arrays& in, const weft_changes& c) {
  const auto indices =
      in.needed<std::uint32_t>("membrane_elements", c.membrane_elements, c.membrane_count);
  const auto stiffnesses = in.needed<std::array<double, 3>>(
      "membrane_stiffnesses", c.membrane_stiffnesses, c.membrane_count);
  std::vector<ChangedMembrane> list;
  if (!in.are_good()) return list;
  for (std::size_t i = 0; i < c.membrane_count; ++i) {
    list.push_back({indices[i], stiffnesses[i][0], stiffnesses[i][1], stiffnesses[i][2]});
  }
  return list;
}

Result<Changes> read_changes(const weft_changes* changes) {
  const auto read = read_struct("changes", changes, no_changes());
  if (!read) return Error{read.error()};
  const weft_changes& c = read.value();
  Arrays in;
  Changes out;
  out.fix = list_of(in.needed<std::uint32_t>("fix", c.fix, c.fix_count));
  out.release = list_of(in.needed<std::uint32_t>("release", c.release, c.release_count));
  out.masses = values(in, "mass_particles", c.mass_particles, "masses", c.masses, c.mass_count);
  out.rest_lengths = values(in, "rest_length_constraints", c.rest_length_constraints,
                            "rest_lengths", c.rest_lengths, c.rest_length_count);
  out.compliances = values(in, "compliance_constraints", c.compliance_constraints, "compliances",
                           c.compliances, c.compliance_count);
  out.membrane = changed_membrane(in, c);
  out.bending = values(in, "bending_elements", c.bending_elements, "bending_compliances",
                       c.bending_compliances, c.bending_count);
  if (!in.are_good()) return in.error();
  if (c.change_damping != 0) {
    out.damping = Damping{c.damping_stretch, c.damping_bending, c.damping_motion};
  }
  if (c.change_air != 0) out.air = ChangedAir{c.air_density, c.air_drag, c.air_lift, c.air_ram};
  return out;
}

}  // namespace
}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_changes(weft_changes* changes, size_t size) {
  return init_struct("changes", no_changes(), changes, size);
}

weft_result weft_change(weft_cloth* cloth, const weft_changes* changes) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    const auto read = read_changes(changes);
    if (!read) return weft::Error{read.error()};
    return cloth->cloth.change(read.value());
  });
}

weft_result weft_set_rest_shape(weft_cloth* cloth, const weft_scene* scene, double scale) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    const auto description = read_scene(scene);
    if (!description) return weft::Error{description.error()};
    return cloth->cloth.set_rest_shape(description.value(), scale);
  });
}

weft_result weft_move_fixed(weft_cloth* cloth, size_t count, const uint32_t* particles,
                            const double* positions) {
  return call(
      [&] { return move_pins(cloth, count, particles, positions, &weft::Cloth::move_fixed); });
}

weft_result weft_place_fixed(weft_cloth* cloth, size_t count, const uint32_t* particles,
                             const double* positions) {
  return call(
      [&] { return move_pins(cloth, count, particles, positions, &weft::Cloth::place_fixed); });
}

weft_result weft_move_anchors(weft_cloth* cloth, size_t count, const double* points,
                              const double* normals) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    Arrays in;
    const auto where = in.needed<weft::Vec3>("points", points, count);
    const auto out_of = in.optional<weft::Vec3>("normals", normals, count);
    if (!in.are_good()) return in.error();
    return cloth->cloth.move_anchors(where, out_of);
  });
}

weft_result weft_limit_anchors(weft_cloth* cloth, size_t count, const double* max_distances,
                               const uint8_t* backstops) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    Arrays in;
    const auto distances = in.needed<double>("max_distances", max_distances, count);
    const auto counts = in.optional<std::uint8_t>("backstops", backstops, count);
    if (!in.are_good()) return in.error();
    std::vector<weft::AnchorLimit> limits;
    for (std::size_t i = 0; i < count; ++i) {
      limits.push_back({distances[i], item_or<std::uint8_t>(counts, i, 1) != 0});
    }
    return cloth->cloth.limit_anchors(limits);
  });
}

weft_result weft_limit_anchor(weft_cloth* cloth, uint32_t anchor, double max_distance,
                              int backstop) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.limit_anchor(anchor, {max_distance, backstop != 0});
  });
}

weft_result weft_scale_anchors(weft_cloth* cloth, double scale) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.scale_anchors(scale);
  });
}

weft_result weft_release_seams(weft_cloth* cloth, size_t count, const uint32_t* seams) {
  return call([&] { return with_seams(cloth, count, seams, &weft::Cloth::release_seams); });
}

weft_result weft_close_seams(weft_cloth* cloth, size_t count, const uint32_t* seams) {
  return call([&] { return with_seams(cloth, count, seams, &weft::Cloth::close_seams); });
}

weft_result weft_carry(weft_cloth* cloth, const double translation[3], const double rotation[3],
                       const double about[3], double share) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.carry(motion_of(translation, rotation, about), share);
  });
}

weft_result weft_teleport(weft_cloth* cloth, const double translation[3], const double rotation[3],
                          const double about[3]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.teleport(motion_of(translation, rotation, about));
  });
}
