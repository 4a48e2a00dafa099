/// The memory of a model, by its parts.
#include "engine/bytes_of.h"
#include "engine/model/model.h"

namespace weft {
namespace {

std::size_t bytes_of_bits(const std::vector<bool>& bits) { return bits.capacity() / 8; }

}  // namespace

std::size_t MembraneStore::bytes() const {
  return bytes_of(slots) + bytes_of(rest) + bytes_of(element) + bytes_of(described) +
         bytes_of(strength);
}

std::size_t BendingStore::bytes() const {
  return bytes_of(slots) + bytes_of(weights) + bytes_of(rest) + bytes_of(compliance) +
         bytes_of(fold) + bytes_of(yielding) + bytes_of(described);
}

std::size_t SeamStore::bytes() const {
  return bytes_of(a) + bytes_of(b) + bytes_of(time) + bytes_of(force) + bytes_of(strength);
}

std::size_t SliderStore::bytes() const {
  return bytes_of(slot) + bytes_of(first) + bytes_of(last) + bytes_of(friction) + bytes_of(rail);
}

std::size_t AnchorStore::bytes() const {
  return bytes_of(slot) + bytes_of(limits) + bytes_of(described) + bytes_of(pins) + bytes_of(at);
}

std::size_t ConstraintStore::bytes() const {
  return bytes_of(a) + bytes_of(b) + bytes_of(rest_length) + bytes_of(effective_mass) +
         bytes_of(compliance) + bytes_of(colour) + bytes_of(described) + bytes_of(slot) +
         bytes_of(hub_distances) + bytes_of(hub_ropes) + bytes_of_bits(turned) + bytes_of(strength);
}

std::size_t InertStore::bytes() const {
  return bytes_of(constraints) + bytes_of(membrane) + bytes_of(bending);
}

std::size_t Model::bytes() const {
  return initial_position.bytes() + initial_velocity.bytes() + bytes_of(mass) +
         bytes_of(inverse_mass) + bytes_of(radius) + bytes_of(hub) + bytes_of(hubs) +
         bytes_of(pins) + bytes_of(holds) + bytes_of(spheres) + bytes_of(is_sphere) +
         bytes_of(joined_) + bytes_of(tethers) + ordering.bytes() + constraints.bytes() +
         membrane.bytes() + bending.bytes() + inert.bytes() + anchors.bytes() + seams.bytes() +
         sliders.bytes() + bytes_of(split_from) + bytes_of(surface) + bytes_of(air.triangles) +
         air.at.bytes() + reference_.bytes() + simd_.bytes() + chunk_neighbours_.bytes() +
         pulls_.bytes() + direct_.bytes() + yarns_.bytes() + small_steps_.bytes() +
         bending_fronts_.bytes() + touched_surface_.bytes();
}

}  // namespace weft
