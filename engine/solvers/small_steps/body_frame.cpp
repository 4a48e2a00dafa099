#include "engine/solvers/small_steps/body_frame.h"

#include <cmath>

namespace weft {
namespace {

using kernels::Vector;
using reference::BodyMotion;

void set_vector(float (&to)[3], Vector v) {
  to[0] = static_cast<float>(v.x);
  to[1] = static_cast<float>(v.y);
  to[2] = static_cast<float>(v.z);
}

void set_face(float (&to)[4], const reference::Placement& at, const reference::Face& face,
              double thickness, Vector origin) {
  const Vector n = at.turned(face.normal);
  to[0] = static_cast<float>(n.x);
  to[1] = static_cast<float>(n.y);
  to[2] = static_cast<float>(n.z);
  to[3] = static_cast<float>(face.offset + thickness + dot(n, at.centre - origin));
}

/// The columns of the rotation from one placement to another, less 1.
void set_turn(float (&to)[9], const BodyMotion& body) {
  const Vector unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector column = body.to.turned(body.from.turned_back(unit[k])) - unit[k];
    to[3 * k] = static_cast<float>(column.x);
    to[3 * k + 1] = static_cast<float>(column.y);
    to[3 * k + 2] = static_cast<float>(column.z);
  }
}

/// As it is when the substep ends.
void write_round(simd::BodyFrame& frame, const BodyMotion& body, Vector origin) {
  const reference::Round& round = *body.form->round();
  frame.kind = simd::BodyKind::round;
  set_vector(frame.a, body.to.placed(round.a) - origin);
  set_vector(frame.axis, body.to.turned(round.axis));
  frame.length = static_cast<float>(round.length);
  frame.radius = static_cast<float>(round.radius + body.thickness);
  frame.taper = static_cast<float>(round.taper);
  frame.lean = static_cast<float>(round.taper / std::sqrt(1 - round.taper * round.taper));
}

void write_motion(simd::BodyFrame& frame, const BodyMotion& body, Vector origin) {
  set_vector(frame.centre_from, body.from.centre - origin);
  set_vector(frame.way, body.to.centre - body.from.centre);
  set_turn(frame.turn, body);
  set_vector(frame.centre_to, body.to.centre - origin);
  set_vector(frame.velocity, body.velocity);
  set_vector(frame.spin, body.spin);
  frame.friction = static_cast<float>(body.friction);
}

}  // namespace

void write_frame(simd::BodyFrame& frame, std::span<simd::BodyFace> faces, const BodyMotion& body,
                 Vector origin) {
  const std::span<const reference::Face> from = body.form->faces();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    set_face(faces[i].from, body.from, from[i], body.thickness, origin);
    set_face(faces[i].to, body.to, from[i], body.thickness, origin);
  }
  set_vector(frame.origin, origin);
  frame.faces = faces.data();
  frame.face_count = static_cast<std::uint32_t>(faces.size());
  frame.motion = &body;
  frame.kind = faces.empty()       ? simd::BodyKind::field
               : faces.size() == 1 ? simd::BodyKind::plane
                                   : simd::BodyKind::hull;
  if (body.form->round() != nullptr) write_round(frame, body, origin);
  const double short_way = body.form->short_way(body.thickness);
  frame.short_way = static_cast<float>(short_way * short_way);
  write_motion(frame, body, origin);
}

}  // namespace weft
