/// The immutable part of a cloth: who is joined to whom and how. Shared by any number of Cloths.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/reference/relax.h"
#include "kernels/vectors.h"

namespace weft {

/// The active constraints in solver order: distance without hubs, distance at hubs, ropes (see
/// kernels/reference/relaxation.h); within each range colour by colour, within a colour as
/// described.
struct ConstraintStore {
  std::size_t plain = 0;      // [0, plain): distance, no hub
  std::size_t bilateral = 0;  // [plain, bilateral): distance at a hub
  std::vector<std::uint32_t> a, b;
  kernels::AlignedVector<double> rest_length;
  kernels::AlignedVector<double> effective_mass;  // 1 / (w_a + w_b), kg
  std::vector<std::uint32_t> colour;
  std::vector<std::uint32_t> described;  // index in the description
  std::size_t size() const { return a.size(); }
};

/// A compressed list of lists: list i is items[begin[i]] ... items[begin[i + 1] - 1].
struct Lists {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> items;
  std::span<const std::uint32_t> operator[](std::size_t i) const {
    return {items.data() + begin[i], items.data() + begin[i + 1]};
  }
};

class Model {
 public:
  explicit Model(const SceneDescription& description);  // must be valid

  std::size_t particles = 0;
  kernels::Vectors initial_position, initial_velocity;
  kernels::AlignedVector<double> mass, inverse_mass;  // inverse_mass 0: fixed
  kernels::Vector gravity{};

  ConstraintStore constraints;
  std::size_t inert_constraints = 0;
  std::uint32_t colours = 0;

  Lists adjacent;                 // constraints at each particle
  std::vector<std::uint8_t> hub;  // per particle
  std::vector<std::uint32_t> hubs;

  Lists rows;  // per plain constraint: those that share a particle with it
  std::vector<std::uint32_t> row_later;  // first entry of the row beyond the constraint itself
  std::vector<double> row_weight;        // s w_p of each entry
  std::vector<std::uint8_t> plain_colour;

  std::vector<std::uint32_t> block_first, block_of;  // blocks of plain constraints of one colour
  Lists block_neighbours;

  std::vector<std::uint32_t> spheres;
  std::vector<double> radius;  // empty without spheres

  bool has_contacts() const { return !spheres.empty(); }
  reference::Topology topology() const;
  std::size_t bytes() const;

 private:
  void store_particles(const SceneDescription& description);
  void store_constraints(const SceneDescription& description);
  void append_constraint(const Constraint& c, std::uint32_t colour, std::uint32_t described);
  void find_hubs(const SceneDescription& description);
  void list_adjacent();
  void build_rows();
  void build_blocks();
  void list_block_neighbours();
};

}  // namespace weft
