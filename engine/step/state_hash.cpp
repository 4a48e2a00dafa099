#include "engine/step/state_hash.h"

#include <bit>

namespace weft {
namespace {

void hash_bits(std::uint64_t& hash, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int byte = 0; byte < 8; ++byte) {
    hash ^= (bits >> (8 * byte)) & 0xff;
    hash *= 0x100000001b3u;
  }
}

void hash_bits(std::uint64_t& hash, const Model& model, const kernels::Vectors& vectors) {
  for (const std::uint32_t slot : model.ordering.slot_of) {
    hash_bits(hash, vectors.x[slot]);
    hash_bits(hash, vectors.y[slot]);
    hash_bits(hash, vectors.z[slot]);
  }
}

}  // namespace

std::uint64_t state_hash(const State& state) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  hash_bits(hash, *state.model, state.position);
  hash_bits(hash, *state.model, state.velocity);
  return hash;
}

}  // namespace weft
