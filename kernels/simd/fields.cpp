#include "kernels/simd/fields.h"

#include <algorithm>

namespace weft::simd {
namespace {

using kernels::Vector;

double number(float v) { return static_cast<double>(v); }

/// A particle of a block where it stands in memory.
struct Place {
  std::size_t at, next;  // of x, and from there to y

  Place(const BodySolve& h, std::size_t pair, std::size_t lane)
      : at(h.blocks[h.pairs[pair].block].place + (h.woven ? lane : 4 * lane)),
        next(h.woven ? kernels::kLanes : 1) {}
  Vector read(const float* from) const {
    return {number(from[at]), number(from[at + next]), number(from[at + 2 * next])};
  }
  void add(float* to, Vector v) const {
    std::size_t i = at;
    for (const double component : {v.x, v.y, v.z}) {
      to[i] = static_cast<float>(number(to[i]) + component);
      i += next;
    }
  }
  void put(float* to, Vector v) const {
    std::size_t i = at;
    for (const double component : {v.x, v.y, v.z}) {
      to[i] = static_cast<float>(component);
      i += next;
    }
  }
};

}  // namespace

reference::ContactSums sums_at(const BodyContactSums& lanes, std::size_t lane) {
  return {
      number(lanes.pushed[lane]),   number(lanes.held[lane]),
      number(lanes.stopped[lane]),  number(lanes.slowed[lane]),
      number(lanes.came_out[lane]), {number(lanes.thinned_by[lane]), number(lanes.retreat[lane])}};
}

void put_sums(BodyContactSums& lanes, std::size_t lane, const reference::ContactSums& sums,
              const reference::BodyMotion& body, const reference::ContactResult& result, Vector v,
              double momentum) {
  lanes.pushed[lane] = static_cast<float>(sums.pushed);
  lanes.held[lane] = static_cast<float>(sums.held);
  lanes.stopped[lane] = static_cast<float>(sums.stopped);
  lanes.slowed[lane] = static_cast<float>(sums.slowed);
  lanes.came_out[lane] = static_cast<float>(sums.came_out);
  const Vector impulse = momentum * (result.v - v);
  const Vector moment = cross(result.x - body.to.centre, impulse);
  const auto add = [&](LaneVectors& sum, Vector by) {
    sum.x[lane] += static_cast<float>(by.x);
    sum.y[lane] += static_cast<float>(by.y);
    sum.z[lane] += static_cast<float>(by.z);
  };
  add(lanes.linear, impulse);
  add(lanes.angular, moment);
  lanes.friction[lane] += static_cast<float>(momentum * result.friction);
}

void solve_field_pair(const BodySolve& h, std::size_t pair) {
  const BodyBlock& block = h.blocks[h.pairs[pair].block];
  const reference::BodyMotion& body = *h.frames[h.pairs[pair].body].motion;
  const Flight& flight = h.flight;
  std::uint32_t touching = 0, far = 0;
  for (std::size_t lane = 0; lane < kernels::kLanes; ++lane) {
    if (!(block.mass[lane] > 0)) continue;
    const Place place(h, pair, lane);
    const Vector base = place.read(h.base), u = place.read(flight.u);
    const Vector start = base + place.read(flight.u_before), x = base + u;
    const double radius = number(block.radius[lane]);
    const reference::Touch touch = find_touch(body, start, x, radius);
    if (!touch.is_near) continue;
    const Vector v = place.read(flight.v) +
                     number(h.rate) * (place.read(flight.led_to) - place.read(flight.predicted));
    reference::ContactSums sums = sums_at(h.sums[pair], lane);
    const reference::ContactResult result = solve_contact(body, touch, start, x, v, radius, sums);
    if (!result.is_touching) continue;
    put_sums(h.sums[pair], lane, sums, body, result, v,
             number(block.mass[lane]) * number(h.momentum_share));
    const Vector by = result.x - x, came_out = result.start - start;
    place.put(flight.u, u + by);
    place.add(flight.u_before, came_out);
    if (flight.is_mended()) place.add(flight.led_to, came_out);
    place.put(flight.predicted, place.read(flight.led_to));
    place.put(flight.v, result.v);
    touching |= 1u << lane;
    if (dot(by, by) > number(block.far[lane])) far |= 1u << lane;
  }
  h.touching[pair] = static_cast<std::uint16_t>(touching);
  h.moved[pair] = static_cast<std::uint16_t>(far);
  h.quick[pair] = 0;
}

float depth_of_field_pair(const BodySolve& h, std::size_t pair) {
  const BodyBlock& block = h.blocks[h.pairs[pair].block];
  const reference::BodyMotion& body = *h.frames[h.pairs[pair].body].motion;
  double deepest = 0;
  for (std::size_t lane = 0; lane < kernels::kLanes; ++lane) {
    if (!(block.mass[lane] > 0)) continue;
    const Place place(h, pair, lane);
    const Vector base = place.read(h.base);
    const double depth = depth_of(body, base + place.read(h.flight.u_before),
                                  base + place.read(h.flight.u), number(block.radius[lane]));
    deepest = std::max(deepest, depth - number(h.spared[pair * kernels::kLanes + lane]));
  }
  return static_cast<float>(deepest);
}

}  // namespace weft::simd
