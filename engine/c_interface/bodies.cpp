/// Bodies in C.
#include <algorithm>
#include <optional>

#include "engine/c_interface/arrays.h"
#include "engine/c_interface/handles.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

void write_rotation(const Rotation& r, double* to) {
  to[0] = r.x;
  to[1] = r.y;
  to[2] = r.z;
  to[3] = r.w;
}

void write_mass(const BodyMass& mass, weft_body& to) {
  to.mass = mass.mass;
  write_vector(mass.centre, to.centre_of_mass);
  std::ranges::copy(mass.inertia, to.inertia);
}

weft_body body_of(const Body& body) {
  weft_body out{};
  out.size = sizeof out;
  write_vector(body.pose.position, out.position);
  write_rotation(body.pose.rotation, out.rotation);
  out.thickness = body.thickness;
  out.friction = body.friction;
  if (body.mass) write_mass(*body.mass, out);
  return out;
}

std::optional<BodyMass> mass_in(const weft_body& body) {
  if (body.mass == 0) return std::nullopt;
  BodyMass mass{.mass = body.mass, .centre = vector_of(body.centre_of_mass)};
  std::ranges::copy(body.inertia, mass.inertia.begin());
  return mass;
}

weft_body_load load_of(const BodyLoad& load) {
  weft_body_load out{};
  out.size = sizeof out;
  write_vector(load.force, out.force);
  write_vector(load.moment, out.moment);
  return out;
}

weft_body_contact contact_of(const BodyContact& contact) {
  weft_body_contact out{};
  out.size = sizeof out;
  out.particle = contact.particle;
  out.body = contact.body;
  write_vector(contact.point, out.point);
  write_vector(contact.normal, out.normal);
  out.push = contact.push;
  return out;
}

Pose pose_of(const double* position, const double* rotation) {
  Pose pose{.position = vector_of(position), .rotation = {}};
  if (rotation != nullptr) pose.rotation = {rotation[0], rotation[1], rotation[2], rotation[3]};
  return pose;
}

Result<void> give_pose(weft_cloth* cloth, std::uint32_t id, const double* position,
                       const double* rotation,
                       Result<void> (Cloth::*give)(std::uint32_t, const Pose&)) {
  if (auto r = given({{"cloth", cloth}, {"position", position}}); !r) return r;
  return (cloth->cloth.*give)(id, pose_of(position, rotation));
}

Result<void> give_vertices(weft_cloth* cloth, std::uint32_t id, std::size_t count,
                           const double* vertices,
                           Result<void> (Cloth::*give)(std::uint32_t, std::span<const Vec3>)) {
  if (auto r = given({{"cloth", cloth}}); !r) return r;
  Arrays in;
  const auto where = in.needed<Vec3>("vertices", vertices, count);
  if (!in.are_good()) return in.error();
  return (cloth->cloth.*give)(id, where);
}

Result<void> build(const ShapeDescription& shape, weft_shape** out) {
  if (auto r = given({{"out", out}}); !r) return r;
  return hand_over(build_shape(shape), out);
}

weft_torn torn_of(const Torn& torn) {
  return {.size = sizeof(weft_torn),
          .kind = static_cast<int>(torn.kind),
          .index = torn.index,
          .particle = torn.particle,
          .load = torn.load};
}

/// Those of a list that there is room for. in_c: one of them as a struct.
template <class Value, class Struct>
Result<void> write_list(const std::vector<Value>& list, Struct (*in_c)(const Value&),
                        std::size_t capacity, Struct* out) {
  const std::size_t writable = std::min(list.size(), capacity);
  if (writable == 0) return {};
  if (auto r = check_struct("out", out); !r) return r;
  const std::size_t size = out->size;
  auto* bytes = reinterpret_cast<std::byte*>(out);
  for (std::size_t i = 0; i < writable; ++i) {
    auto* to = reinterpret_cast<Struct*>(bytes + i * size);
    to->size = size;
    write_struct(in_c(list[i]), to);
  }
  return {};
}

}  // namespace
}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_body(weft_body* body, size_t size) {
  return init_struct("body", body_of({}), body, size);
}

weft_result weft_init_body_load(weft_body_load* load, size_t size) {
  return init_struct("load", load_of({}), load, size);
}

weft_result weft_init_torn(weft_torn* torn, size_t size) {
  return init_struct("torn", torn_of({}), torn, size);
}

weft_result weft_init_body_contact(weft_body_contact* contact, size_t size) {
  return init_struct("contact", contact_of({}), contact, size);
}

weft_result weft_plane(const double normal[3], double offset, weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"normal", normal}}); !r) return r;
    return build(weft::Plane{vector_of(normal), offset}, out);
  });
}

weft_result weft_ball(const double centre[3], double radius, weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"centre", centre}}); !r) return r;
    return build(weft::Ball{vector_of(centre), radius}, out);
  });
}

weft_result weft_capsule(const double a[3], const double b[3], double radius_a, double radius_b,
                         weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"a", a}, {"b", b}}); !r) return r;
    return build(weft::Capsule{vector_of(a), vector_of(b), radius_a, radius_b}, out);
  });
}

weft_result weft_hull(size_t count, const double* points, weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    Arrays in;
    weft::Hull hull{list_of(in.needed<weft::Vec3>("points", points, count))};
    if (!in.are_good()) return in.error();
    return build(std::move(hull), out);
  });
}

weft_result weft_box(const double edges[3], weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"edges", edges}}); !r) return r;
    return build(weft::box(vector_of(edges)), out);
  });
}

weft_result weft_triangle_mesh(size_t vertex_count, const double* vertices, size_t triangle_count,
                               const uint32_t* triangles, int two_sided, weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    using Triangle = std::array<std::uint32_t, 3>;
    Arrays in;
    weft::TriangleMesh mesh{list_of(in.needed<weft::Vec3>("vertices", vertices, vertex_count)),
                            list_of(in.needed<Triangle>("triangles", triangles, triangle_count)),
                            two_sided != 0};
    if (!in.are_good()) return in.error();
    return build(std::move(mesh), out);
  });
}

weft_result weft_height_field(uint32_t columns, uint32_t rows, double spacing_x, double spacing_z,
                              const double* heights, weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    Arrays in;
    weft::HeightField field{
        columns, rows, spacing_x, spacing_z,
        list_of(in.needed<double>("heights", heights, std::size_t{columns} * rows))};
    if (!in.are_good()) return in.error();
    return build(std::move(field), out);
  });
}

weft_result weft_torus(const double centre[3], const double axis[3], double major, double minor,
                       weft_shape** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"centre", centre}, {"axis", axis}}); !r) return r;
    return build(weft::Torus{vector_of(centre), vector_of(axis), major, minor}, out);
  });
}

void weft_free_shape(weft_shape* shape) { delete shape; }

weft_result weft_add_body(weft_cloth* cloth, const weft_body* body, uint32_t* id) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"id", id}}); !r) return r;
    const auto read = read_struct("body", body, body_of({}));
    if (!read) return weft::Error{read.error()};
    const weft_body& b = read.value();
    if (auto r = given({{"body.shape", b.shape}}); !r) return r;
    const auto added = cloth->cloth.add_body({.shape = b.shape->shape,
                                              .pose = pose_of(b.position, b.rotation),
                                              .thickness = b.thickness,
                                              .friction = b.friction,
                                              .mass = mass_in(b)});
    if (!added) return weft::Error{added.error()};
    *id = added.value();
    return {};
  });
}

weft_result weft_move_body(weft_cloth* cloth, uint32_t id, const double position[3],
                           const double rotation[4]) {
  return call([&] { return give_pose(cloth, id, position, rotation, &weft::Cloth::move_body); });
}

weft_result weft_place_body(weft_cloth* cloth, uint32_t id, const double position[3],
                            const double rotation[4]) {
  return call([&] { return give_pose(cloth, id, position, rotation, &weft::Cloth::place_body); });
}

weft_result weft_move_body_vertices(weft_cloth* cloth, uint32_t id, size_t count,
                                    const double* vertices) {
  return call(
      [&] { return give_vertices(cloth, id, count, vertices, &weft::Cloth::move_body_vertices); });
}

weft_result weft_place_body_vertices(weft_cloth* cloth, uint32_t id, size_t count,
                                     const double* vertices) {
  return call(
      [&] { return give_vertices(cloth, id, count, vertices, &weft::Cloth::place_body_vertices); });
}

weft_result weft_switch_body(weft_cloth* cloth, uint32_t id, int on) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.switch_body(id, on != 0);
  });
}

weft_result weft_remove_body(weft_cloth* cloth, uint32_t id) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.remove_body(id);
  });
}

weft_result weft_body_load_of(const weft_cloth* cloth, uint32_t id, weft_body_load* load) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    if (auto r = check_struct("load", load); !r) return r;
    const auto found = cloth->cloth.body_load(id);
    if (!found) return weft::Error{found.error()};
    write_struct(load_of(found.value()), load);
    return {};
  });
}

weft_result weft_give_mass(weft_body* body, double density) {
  return call([&]() -> weft::Result<void> {
    const auto read = read_struct("body", body, body_of({}));
    if (!read) return weft::Error{read.error()};
    weft_body with = read.value();
    if (auto r = given({{"body.shape", with.shape}}); !r) return r;
    const auto mass = weft::mass_of(*with.shape->shape, density);
    if (!mass) return weft::Error{mass.error()};
    write_mass(mass.value(), with);
    write_struct(with, body);
    return {};
  });
}

weft_result weft_body_pose_of(const weft_cloth* cloth, uint32_t id, double position[3],
                              double rotation[4]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"position", position}, {"rotation", rotation}}); !r)
      return r;
    const auto pose = cloth->cloth.body_pose(id);
    if (!pose) return weft::Error{pose.error()};
    write_vector(pose.value().position, position);
    write_rotation(pose.value().rotation, rotation);
    return {};
  });
}

weft_result weft_body_velocity_of(const weft_cloth* cloth, uint32_t id, double linear[3],
                                  double angular[3]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"linear", linear}, {"angular", angular}}); !r) return r;
    const auto velocity = cloth->cloth.body_velocity(id);
    if (!velocity) return weft::Error{velocity.error()};
    write_vector(velocity.value().linear, linear);
    write_vector(velocity.value().angular, angular);
    return {};
  });
}

weft_result weft_set_body_velocity(weft_cloth* cloth, uint32_t id, const double linear[3],
                                   const double angular[3]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"linear", linear}, {"angular", angular}}); !r) return r;
    return cloth->cloth.set_body_velocity(id, {vector_of(linear), vector_of(angular)});
  });
}

weft_result weft_set_body_force(weft_cloth* cloth, uint32_t id, const double force[3],
                                const double moment[3]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"force", force}, {"moment", moment}}); !r) return r;
    return cloth->cloth.set_body_force(id, vector_of(force), vector_of(moment));
  });
}

weft_result weft_body_contacts(const weft_cloth* cloth, size_t capacity, weft_body_contact* out,
                               size_t* count) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"count", count}}); !r) return r;
    const std::vector<weft::BodyContact> contacts = cloth->cloth.body_contacts();
    if (auto r = write_list(contacts, contact_of, capacity, out); !r) return r;
    *count = contacts.size();
    return {};
  });
}

weft_result weft_torn_of(const weft_cloth* cloth, size_t capacity, weft_torn* out, size_t* count) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"count", count}}); !r) return r;
    const std::vector<weft::Torn> torn = cloth->cloth.torn();
    if (auto r = write_list(torn, torn_of, capacity, out); !r) return r;
    *count = torn.size();
    return {};
  });
}

weft_result weft_surface_of(const weft_cloth* cloth, size_t capacity, uint32_t* out,
                            size_t* count) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"count", count}}); !r) return r;
    const auto triangles = cloth->cloth.surface();
    const std::size_t writable = std::min(triangles.size(), capacity);
    if (writable > 0) {
      if (auto r = given({{"out", out}}); !r) return r;
    }
    for (std::size_t i = 0; i < writable; ++i) std::ranges::copy(triangles[i], out + 3 * i);
    *count = triangles.size();
    return {};
  });
}
