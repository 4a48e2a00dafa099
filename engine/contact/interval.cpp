#include "engine/contact/interval.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

namespace {

/// In which pairs that have come near unexpectedly are put right, before what is left is verified.
constexpr int kLateRounds = 3;

}  // namespace

void SurfaceContacts::begin(const BodyClock& clock, bool is_new, const Misplaced& misplaced) {
  points_.begin(model_, clock);
  left_ = 0;
  interval_ = late_depth_ = 0;
  failures_ = {};
  for (NearPairs& near : near_) near.clear();
  if (empty()) return;
  cloth_ = &model_.touched_surface();
  impulses_.begin(clock.bodies());
  is_new_ = is_new;
  misplaced_ = misplaced;
  tangles_.begin(*cloth_, misplaced_.crossing);
}

/// s. Bodies that are fast are looked at more often: on their way they turn, and take cloth along.
double SurfaceContacts::interval_for(const BodyClock& clock) const {
  const double fastest = points_.fastest(clock);
  const double way = tuning::kMeshWay * points_.largest_thickness();
  return fastest > 0 ? std::min(tuning::kContactInterval, way / fastest) : tuning::kContactInterval;
}

void SurfaceContacts::predict(ContactParticles& particles, const BodyClock& clock, Team& team) {
  if (empty() || still_holds(particles, clock)) return;
  if (left_ == 0) {
    left_ = clock.stands() ? 1 : clock.substeps_in(interval_for(clock));
    begin_interval(particles, clock, left_, team);
  }
  --left_;
}

/// Where positions are put right, by any way, until a particle comes to a place that was not
/// expected.
bool SurfaceContacts::still_holds(const ContactParticles& particles, const BodyClock& clock) const {
  return clock.stands() && interval_ > 0 && points_.hold(model_, particles);
}

void SurfaceContacts::begin_interval(ContactParticles& particles, const BodyClock& clock,
                                     int substeps, Team& team) {
  points_.begin_interval(model_, particles, clock, substeps);
  search_.find(*cloth_, points_, candidates_);
  narrow_.measure(points_, candidates_, team);
  if (is_new_) {
    find_inside();
    tangles_.find(points_, Tangles::Moment::start);
    misplaced_.crossing = tangles_.slots();
  }
  is_new_ = false;
  narrow_.find_near(model_, points_, candidates_, near_, misplaced_, tangles_);
  come_out();
  response_.begin(scene(particles, clock), near_);
  interval_ = substeps * clock.motions().front().h;
}

void SurfaceContacts::advance(const BodyClock& clock) {
  if (!empty()) response_.advance(clock, points_, near_);
}

/// The triangle of the mesh that is nearest to the particle when the interval begins.
bool SurfaceContacts::find_nearest(std::uint32_t slot, std::uint16_t mesh, Pair& pair,
                                   std::array<std::uint32_t, 4>& four,
                                   reference::Nearest& found) const {
  const ContactMesh& m = points_.meshes()[mesh];
  const Vector x = points_.start(slot), from = x - points_.origin();
  double least = std::numeric_limits<double>::infinity();
  m.tree.near({static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)},
              [&](std::uint32_t triangle) {
                const auto [a, b, c] = m.mesh().surface.triangles[triangle];
                const std::uint32_t first = m.first_point;
                const reference::Nearest other = reference::nearest_in_triangle(
                    x, points_.start(first + a), points_.start(first + b),
                    points_.start(first + c));
                const double square = dot(other.r, other.r);
                if (square < least) {
                  least = square;
                  found = other;
                  pair = {slot, triangle, mesh, PairKind::particle_triangle};
                  four = {slot, first + a, first + b, first + c};
                }
                return static_cast<float>(least);
              });
  return least < std::numeric_limits<double>::infinity();
}

void SurfaceContacts::find_inside() {
  misplaced_.inside.clear();
  for (std::uint32_t slot = 0; slot < points_.slots(); ++slot) {
    if (!model_.is_particle(slot) || model_.inverse_mass[slot] == 0) continue;
    for (std::uint16_t i = 0; i < points_.meshes().size(); ++i) {
      ContactMesh& mesh = points_.meshes()[i];
      if (mesh.mesh().two_sided || !mesh.tree.bounds().meets(points_.box(slot))) continue;
      Pair pair;
      std::array<std::uint32_t, 4> four{};
      reference::Nearest found;
      if (find_nearest(slot, i, pair, four, found) && is_behind(mesh, pair, found, found.r)) {
        misplaced_.inside.push_back(slot);
        break;
      }
    }
  }
}

/// Those that are inside are near to the surface that they leave by, however deep they are. Those
/// that are out are forgotten.
void SurfaceContacts::come_out() {
  std::erase_if(misplaced_.inside, [&](std::uint32_t slot) {
    bool is_out = true;
    for (std::uint16_t i = 0; i < points_.meshes().size(); ++i) {
      ContactMesh& mesh = points_.meshes()[i];
      Pair pair;
      std::array<std::uint32_t, 4> four{};
      reference::Nearest found;
      if (mesh.mesh().two_sided || !find_nearest(slot, i, pair, four, found)) continue;
      if (!is_behind(mesh, pair, found, found.r)) continue;
      is_out = false;
      const Vector n = kernels::direction(found.r, length(found.r));
      near_[list_of(pair.kind)].add(pair, four, -1.0 * n, mesh.thickness, true);
    }
    return is_out;
  });
}

bool SurfaceContacts::end_interval(ContactParticles& particles, const BodyClock& clock,
                                   Team& team) {
  if (empty() || clock.stands() || left_ > 0 || interval_ == 0) return false;
  points_.measure_moves(model_, particles, clock);
  late_depth_ = 0;
  const ContactScene scene = this->scene(particles, clock);
  bool has_moved = false;
  for (int round = 0; round < kLateRounds; ++round) {
    verification_.find_late(scene, narrow_, candidates_, team);
    expect_failures(clock, particles);
    for (const Failure& late : verification_.failures())
      rescue::blow(scene, candidates_[late.list], late, interval_);
    if (verification_.failures().empty()) break;
    has_moved = true;
  }
  verification_.find(scene, search_, narrow_, candidates_, team);
  const bool has_failed = !verification_.failures().empty();
  has_moved = has_moved || has_failed;
  if (has_moved) {
    expect_failures(clock, particles);
    stop_failures(scene, search_, narrow_, verification_, candidates_, interval_, failures_, team);
    for (const Failure& failure : verification_.failures())
      misplace(candidates_[failure.list].pairs[failure.pair]);
  }
  // Only what is misplaced, and what had to be stopped, leads others through a body.
  if (tangles_.count() > 0 || !misplaced_.inside.empty() || has_failed) {
    tangles_.find(points_, Tangles::Moment::end);
    misplaced_.crossing = tangles_.slots();
  }
  if (!has_moved) return false;
  verification_.find_late(scene, narrow_, candidates_, team);
  for (const Failure& late : verification_.failures())
    late_depth_ = std::max(late_depth_, late.depth);
  return true;
}

/// What was not expected to touch is near from now on, so that what puts the cloth right until the
/// step is over keeps it apart. What went through each other unnoticed was taken to be on the other
/// side: now it is known on which it was.
void SurfaceContacts::expect_failures(const BodyClock& clock, ContactParticles& particles) {
  bool any = false;
  for (const Failure& failure : verification_.failures()) {
    const Pair& pair = candidates_[failure.list].pairs[failure.pair];
    NearPairs& near = near_[failure.list];
    const std::size_t known = near.find(pair);
    const bool is_known = known < near.list.size();
    const bool is_late = failure.depth > 0;
    if (is_known && is_late) continue;
    const auto four = candidates_[failure.list].points(failure.pair);
    FourPoints before;
    for (std::size_t k = 0; k < 4; ++k) before[k] = points_.start(four[k]);
    const Vector normal =
        direction_apart(points_.meshes()[pair.mesh], pair, nearest(pair.kind, before));
    if (is_known) {
      near.set_normal(known, normal);
      near.states[known].is_under = false;
    } else {
      near.add(pair, four, normal, points_.meshes()[pair.mesh].thickness, false);
      any = true;
    }
  }
  if (!any) return;
  response_.begin(scene(particles, clock), near_);
  points_.place_vertices_asked(clock);
}

/// Of what could not be kept apart: the particle is inside from now on.
void SurfaceContacts::misplace(const Pair& pair) {
  if (pair.kind != PairKind::particle_triangle || points_.meshes()[pair.mesh].mesh().two_sided)
    return;
  std::vector<std::uint32_t>& inside = misplaced_.inside;
  if (!misplaced_.is_inside(pair.of_cloth))
    inside.insert(std::ranges::lower_bound(inside, pair.of_cloth), pair.of_cloth);
}

int SurfaceContacts::count_touching() const {
  int count = 0;
  for (const NearPairs& near : near_)
    count += static_cast<int>(std::ranges::count_if(near.states, &NearState::is_touching));
  return count;
}

void SurfaceContacts::read_touching(const ContactParticles& particles,
                                    std::vector<MeshTouch>& touches) const {
  const auto at = [&](std::uint32_t point) {
    return points_.is_of_cloth(point) ? particles.position(point) : points_.to(point);
  };
  for (const NearPairs& near : near_) {
    for (std::size_t i = 0; i < near.list.size(); ++i) {
      if (!near.states[i].is_touching) continue;
      const Pair& pair = near.list.pairs[i];
      const auto four = near.list.points(i);
      const reference::Nearest found =
          nearest(pair.kind, {at(four[0]), at(four[1]), at(four[2]), at(four[3])});
      MeshTouch touch{.body = points_.meshes()[pair.mesh].body, .push = near.states[i].push};
      touch.normal = towards_cloth(pair.kind) * near.normal(i);
      double most = -1;
      for (std::size_t k = 0; k < 4; ++k) {
        const double weight = std::abs(found.weight[k]);
        if (!points_.is_of_cloth(four[k])) {
          touch.point = touch.point + weight * at(four[k]);
        } else if (weight > most) {
          most = weight;
          touch.slot = four[k];
        }
      }
      touches.push_back(touch);
    }
  }
}

std::size_t SurfaceContacts::bytes() const {
  std::size_t bytes = points_.bytes() + search_.bytes() + narrow_.bytes() + response_.bytes() +
                      misplaced_.bytes() + tangles_.bytes() + bytes_of(impulses_.of_body);
  for (const PairList& list : candidates_) bytes += list.bytes();
  for (const NearPairs& near : near_)
    bytes += near.list.bytes() + bytes_of(near.sides) + bytes_of(near.states);
  return bytes;
}

}  // namespace weft
