#include "engine/contact/points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

namespace {

/// The origin changes seldom.
Vector rounded(Vector v) {
  const auto round = [](double x) {
    return tuning::kContactGrid * std::round(x / tuning::kContactGrid);
  };
  return {round(v.x), round(v.y), round(v.z)};
}

/// A box around two places, from the origin, and all within `reach` of the way between them.
Box box_around(Vector a, Vector b, double reach) {
  const auto low = [&](double x, double y) { return static_cast<float>(std::min(x, y) - reach); };
  const auto high = [&](double x, double y) { return static_cast<float>(std::max(x, y) + reach); };
  return {{low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)},
          {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)}};
}

/// The next power of two that is not less.
float next_power(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return std::ldexp(1.f, exponent);
}

/// m, of floats at a distance from the origin: some of their last digits.
float rounding_at(double distance) { return 0x1p-21f * next_power(distance); }

bool is_same(const reference::Placement& a, const reference::Placement& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.centre == b.centre;
}

}  // namespace

void ContactPoints::begin(const BodyClock& clock) {
  has_tubes_ = false;
  speeds_ = {};
  const bool have_other_numbers = ContactSurfaces::begin(clock);
  if (empty()) return;
  particles_.clear();
  for (std::uint32_t slot = 0; slot < slots(); ++slot)
    if (model().is_particle(slot)) particles_.push_back(slot);
  forget_active();
  if (have_other_numbers || start_.capacity() == 0) make_room();
}

/// Only vertices that are looked at cost something.
void ContactPoints::make_room() {
  for (auto* vectors : {&start_, &end_}) vectors->make_room(count());
  for (auto* quads : {&start_quads_, &way_quads_}) quads->make_room(4 * count());
  box_.make_room(count());
  tube_.make_room(count());
  lane_tubes_.make_room(count());
  for (auto* numbers : {&laid_, &placed_}) numbers->make_room(count() - slots());
  is_active_.make_room(count() - slots());
}

void ContactPoints::look_ahead(const ContactParticles& cloth, const BodyClock& clock) {
  for (const std::uint32_t slot : particles_) {
    start_[slot] = cloth.start(slot);
    end_[slot] = cloth.position(slot) - start_[slot];
  }
  speeds_ =
      speeds_of_step(model(), {start_.data(), slots()}, {end_.data(), slots()}, of_bodies(), clock);
}

void ContactPoints::begin_interval(const ContactParticles& cloth, const BodyClock& clock,
                                   int substeps) {
  const double before = std::exchange(from_, clock.share_after(0));
  to_ = clock.share_after(substeps);
  if (from_ < laid_from_ || to_ > until_) has_tubes_ = false;
  const double time = clock.stands() ? 0 : clock.time();
  drift_ = ((to_ - from_) * time) * speeds_.drift;
  const Vector drifted = ((from_ - before) * time) * speeds_.drift;
  Vector sum{};
  double travelled = 0;
  for (const std::uint32_t slot : particles_) {
    const Vector x = cloth.position(slot);
    const Vector start = clock.stands() ? x : cloth.start(slot),
                 by = start - start_[slot] - drifted;
    travelled = std::max(travelled, dot(by, by));
    start_[slot] = start;
    end_[slot] = start_[slot] + substeps * (x - start_[slot]);
    sum = sum + start_[slot];
  }
  const Vector origin = rounded((1 / std::max(1.0, static_cast<double>(particles_.size()))) * sum);
  bool are_floats_same = origin == origin_;
  has_tubes_ = has_tubes_ && are_floats_same;
  origin_ = origin;
  double farthest = 0;
  for (const std::uint32_t slot : particles_) {
    const Vector from = start_[slot] - origin_;
    farthest = std::max(farthest, dot(from, from));
    write_start_and_way(slot);
  }
  const float rounding = rounding_at(std::sqrt(farthest));
  are_floats_same = are_floats_same && rounding == rounding_;
  rounding_ = rounding;
  way_of_bodies_ = (to_ - from_) * time * speeds_.of_bodies;
  way_of_near_ = (to_ - from_) * time * speeds_.of_near;
  const double of_other = (from_ - before) * time * speeds_.of_bodies;
  travelled_ = std::sqrt(travelled);
  travelled_ += touches_itself() ? std::max(travelled_, of_other) : of_other;
  find_reach();
  if (!has_tubes_) until_ = tubes_end(clock.share_after(clock.substeps_left()));
  time_left_ = (until_ - from_) * time;
  const double beside_itself = this->beside_itself();
  for (const std::uint32_t slot : particles_) {
    write_box(slot, reach_[slot] + beside_itself);
    way_quads_[4 * slot + 3] = static_cast<float>(reach_[slot]);
  }
  if (touches_itself())
    surfaces()[kClothSurface].normals.begin(this->cloth(), start_.data(), false);
  for (ContactSurface& surface : of_bodies()) {
    const PoseTravel& travel = clock.bodies()[surface.body].travel;
    const auto before = std::exchange(surface.begins, travel.at(from_));
    const auto end_before = std::exchange(surface.ends, travel.at(to_));
    const bool has_moved = !surface.is_rigid || !is_same(before, surface.begins);
    surface.stands = surface.is_rigid && travel.turn() == Vector{} && travel.way() == Vector{};
    surface.normals.begin(*surface.triangles, &start_[surface.first_point], !has_moved);
    if (has_moved || surface.placing == 0 || !are_floats_same || !is_same(end_before, surface.ends))
      surface.placing = ++placings_;
    if (!has_tubes_) see_from(surface, travel);
  }
  for (const std::uint32_t point : active_) place_vertex(point);
}

void ContactPoints::see_from(ContactSurface& surface, const PoseTravel& travel) const {
  surface.seen = {.begins = surface.begins,
                  .ends = travel.at(until_),
                  .turn = (until_ - from_) * length(travel.turn()),
                  .way = (until_ - from_) * length(travel.way()),
                  .beyond = surface.thickness + 3 * static_cast<double>(rounding_)};
  for (reference::Placement* at : {&surface.seen.begins, &surface.seen.ends})
    at->centre = at->centre - origin_;
}

void ContactPoints::write_start_and_way(std::size_t point) {
  write(start_quads_, point, start_[point] - origin_);
  write(way_quads_, point, end_[point] - start_[point]);
}

void ContactPoints::activate(std::uint16_t surface, std::uint32_t triangle) {
  ContactSurface& s = surfaces()[surface];
  if (std::exchange(s.active[triangle], layings_) == layings_) return;
  for (const std::uint32_t corner : s.triangles->triangles[triangle]) {
    activate_vertex(s.first_point + corner);
    for (const std::uint32_t other : s.triangles->neighbours[corner])
      activate_vertex(s.first_point + other);
  }
}

void ContactPoints::forget_active() {
  for (const std::uint32_t point : active_) is_active_[point - slots()] = 0;
  active_.clear();
  rounding_of_vertices_ = 0;
}

void ContactPoints::activate_vertex(std::uint32_t point) {
  if (std::exchange(is_active_[point - slots()], std::uint8_t{1}) != 0) return;
  active_.push_back(point);
  place_vertex(point);
  const float rounding = rounding_at(length(start_[point] - origin_));
  rounding_of_vertices_ = std::max(rounding_of_vertices_, rounding);
}

/// In the present interval.
void ContactPoints::place_vertex(std::uint32_t point) {
  const ContactSurface& surface = surface_of(point);
  if (std::exchange(placed_[point - slots()], surface.placing) == surface.placing) return;
  const std::size_t i = point - surface.first_point;
  const Vector from = surface.from[i], way = surface.to[i] - from;
  start_[point] = surface.begins.placed(from + from_ * way);
  end_[point] = surface.ends.placed(from + to_ * way);
  write_start_and_way(point);
  way_quads_[4 * std::size_t{point} + 3] = 0;
  const float rounding = std::max(rounding_, rounding_at(length(start_[point] - origin_)));
  write_box(point, surface.thickness + static_cast<double>(rounding));
}

void ContactPoints::find_reach() {
  ways_.resize(slots());
  reach_.resize(slots());
  largest_way_ = 0;
  for (const std::uint32_t slot : particles_) {
    ways_[slot] = reach_[slot] = length(way(slot) - drift_);
    largest_way_ = std::max(largest_way_, ways_[slot]);
  }
  for (const auto& [a, b] : cloth().edges) {
    reach_[a] = std::max(reach_[a], ways_[b]);
    reach_[b] = std::max(reach_[b], ways_[a]);
  }
  largest_reach_ = 0;
  const double spare = to_ > from_ ? tuning::kContactSpare : tuning::kContactWideSpare;
  for (const std::uint32_t slot : particles_) {
    reach_[slot] = strays(slot, tuning::kContactReach * std::max(reach_[slot], way_of_near_)) +
                   spare * largest_thickness();
    largest_reach_ = std::max(largest_reach_, reach_[slot]);
  }
}

double ContactPoints::strays(std::uint32_t slot, double by) const {
  return std::min(by, tuning::kContactStray * shortest_edge(slot));
}

/// Tubes that reach over several cells meet many others, and those of cloth that flutters are soon
/// left. So they end when particles have come, in the mean, as far as an edge is long.
double ContactPoints::tubes_end(double end) const {
  double edges = 0, ways = 0;
  for (const std::uint32_t slot : particles_) {
    if (shortest_edge(slot) == std::numeric_limits<double>::infinity()) continue;
    edges += shortest_edge(slot);
    ways += ways_[slot];
  }
  const double interval = to_ - from_;
  return ways > 0 ? std::min(end, from_ + interval * std::max(1.0, edges / ways)) : end;
}

void ContactPoints::write_box(std::size_t point, double reach) {
  box_[point] = box_around(start_[point] - origin_, end_[point] - origin_, reach);
}

/// m, for the sake of what it does not go on to do as in this interval.
double ContactPoints::beyond_for_itself(std::uint32_t slot, double length_of_way) const {
  if (!touches_itself()) return 0;
  const double of_speeding = tuning::kTubeAcceleration / 2 * time_left_ * time_left_;
  return std::min(
      {tuning::kTubeOfEdge * shortest_edge(slot), tuning::kTubeOfWay * length_of_way, of_speeding});
}

/// It holds until the step ends if the point goes on as in this interval.
Tube ContactPoints::tube_around(std::uint32_t slot) const {
  const Vector x = start_[slot] - origin_, way = end_[slot] - start_[slot];
  const double intervals = to_ > from_ ? 1 / (to_ - from_) : 0;
  const double by =
      tuning::kContactReach * length(way - drift_) + (tuning::kContactWideReach - 1) * reach_[slot];
  const double reach = reach_[slot] + strays(slot, by) +
                       (to_ > from_ ? tuning::kContactWideSpare : tuning::kContactStandingSpare) *
                           largest_thickness() +
                       beside_itself() +
                       beyond_for_itself(slot, intervals * (until_ - from_) * length(way));
  const Vector begins = x - (intervals * (from_ - laid_from_)) * way,
               ends = x + (intervals * (until_ - from_)) * way;
  return {box_around(begins, begins, reach), box_around(ends, ends, reach)};
}

void ContactPoints::lay_tubes() {
  laid_from_ = from_;
  for (const std::uint32_t slot : particles_) set_tube(slot, tube_around(slot));
  ++layings_;
  forget_active();
  if (touches_itself()) surfaces()[kClothSurface].may_cross.assign(cloth().triangles.size(), 0);
  for (ContactSurface& surface : of_bodies()) surface.may_cross.assign(cloth().triangles.size(), 0);
  has_tubes_ = true;
}

/// A vertex stays within an eighth of the square of a turn, and what it does beside, of the line
/// between its ends.
void ContactPoints::lay_vertex(std::uint32_t point) {
  const ContactSurface& surface = surface_of(point);
  const std::size_t i = point - surface.first_point;
  const Vector way = surface.to[i] - surface.from[i];
  const Vector a = surface.from[i] + laid_from_ * way, b = surface.from[i] + until_ * way;
  const SeenFromBody& seen = surface.seen;
  const double far = std::max(length(a), length(b));
  const double beyond = (seen.turn * far + 2 * length(b - a)) * seen.turn / 8 +
                        static_cast<double>(rounding_at(far + length(seen.begins.centre)));
  const Vector begins = seen.begins.placed(a), ends = seen.ends.placed(b);
  set_tube(point, {box_around(begins, begins, seen.beyond + beyond),
                   box_around(ends, ends, seen.beyond + beyond)});
  laid_[point - slots()] = layings_;
}

void ContactPoints::measure_moves(const ContactParticles& cloth) {
  for (const std::uint32_t slot : particles_) {
    set_end(slot, cloth.position(slot));
  }
}

float ContactPoints::largest_move() const {
  double largest = 0;
  for (const std::uint32_t slot : particles_) {
    const Vector by = way(slot) - drift_;
    largest = std::max(largest, dot(by, by));
  }
  const double of_cloth = std::sqrt(largest);
  return static_cast<float>(
      of_cloth + (touches_itself() ? std::max(of_cloth, way_of_bodies_) : way_of_bodies_));
}

bool ContactPoints::holds_end(std::uint32_t point) const { return holds(point, end_[point]); }

bool ContactPoints::hold(const ContactParticles& cloth) const {
  for (const std::uint32_t slot : particles_) {
    if (!holds(slot, cloth.position(slot))) return false;
  }
  return true;
}

bool ContactPoints::holds(std::uint32_t point, Vector place) const {
  const Vector x = place - origin_;
  const auto holds = [&](double at, std::size_t k) {
    return at >= static_cast<double>(box_[point].low[k]) &&
           at <= static_cast<double>(box_[point].high[k]);
  };
  return holds(x.x, 0) && holds(x.y, 1) && holds(x.z, 2);
}

void ContactPoints::take_way_in(std::uint32_t point) {
  box_[point].add(box_around(start_[point] - origin_, end_[point] - origin_, largest_thickness()));
}

void ContactPoints::set_end(std::uint32_t point, Vector x) {
  end_[point] = x;
  write(way_quads_, point, x - start_[point]);
}

std::size_t ContactPoints::bytes() const {
  return ContactSurfaces::bytes() + bytes_of(particles_) + bytes_of(start_) + bytes_of(end_) +
         bytes_of(reach_) + bytes_of(ways_) + bytes_of(box_) + bytes_of(tube_) +
         bytes_of(lane_tubes_) + bytes_of(start_quads_) + bytes_of(way_quads_) + bytes_of(laid_) +
         bytes_of(placed_) + bytes_of(active_) + bytes_of(is_active_);
}

}  // namespace weft
