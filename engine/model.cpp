#include "engine/model.h"

#include <algorithm>
#include <numeric>

#include "engine/colouring.h"
#include "engine/validate.h"

namespace weft {
namespace {

template <class T>
std::size_t bytes_of(const T& vector) {
  return vector.capacity() * sizeof(vector[0]);
}

/// The three ranges of solver order.
int range_of(const Constraint& c, const std::vector<std::uint8_t>& hub) {
  if (c.kind == ConstraintKind::rope) return 2;
  return hub[c.a] || hub[c.b] ? 1 : 0;
}

}  // namespace

Model::Model(const SceneDescription& description) {
  store_particles(description);
  find_hubs(description);
  store_constraints(description);
  list_adjacent();
  build_rows();
  build_blocks();
  list_block_neighbours();
}

void Model::store_particles(const SceneDescription& d) {
  particles = d.positions.size();
  initial_position.resize(particles);
  initial_velocity.resize(particles);
  mass.assign(d.masses.begin(), d.masses.end());
  inverse_mass.resize(particles);
  for (std::size_t i = 0; i < particles; ++i) {
    initial_position.set(i, {d.positions[i].x, d.positions[i].y, d.positions[i].z});
    if (!d.velocities.empty()) {
      initial_velocity.set(i, {d.velocities[i].x, d.velocities[i].y, d.velocities[i].z});
    }
    inverse_mass[i] = 1 / mass[i];
  }
  for (const std::uint32_t i : d.fixed) {
    inverse_mass[i] = 0;
    initial_velocity.set(i, {0, 0, 0});
  }
  gravity = {d.gravity.x, d.gravity.y, d.gravity.z};
  spheres = d.spheres;
  radius = d.radii;
}

void Model::find_hubs(const SceneDescription& d) {
  std::vector<std::uint32_t> degree(particles);
  for (const Constraint& c : d.constraints) {
    ++degree[c.a];
    ++degree[c.b];
  }
  hub.resize(particles);
  for (std::size_t i = 0; i < particles; ++i) hub[i] = degree[i] > reference::kHubDegree;
  for (const std::uint32_t s : spheres) hub[s] = 1;
  for (std::uint32_t i = 0; i < particles; ++i) {
    if (hub[i]) hubs.push_back(i);
  }
}

void Model::store_constraints(const SceneDescription& d) {
  struct Active {
    int range;
    std::uint32_t colour, described;
    auto operator<=>(const Active&) const = default;
  };
  std::vector<Active> active;
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < d.constraints.size(); ++i) {
    const Constraint& c = d.constraints[i];
    if (inverse_mass[c.a] + inverse_mass[c.b] == 0) continue;
    active.push_back({range_of(c, hub), 0, i});
    pairs.push_back({c.a, c.b});
  }
  const Colouring colouring = colour_pairs(pairs, particles);
  colours = colouring.count;
  for (std::size_t k = 0; k < active.size(); ++k) active[k].colour = colouring.colour[k];
  std::ranges::sort(active);
  for (const Active& a : active)
    append_constraint(d.constraints[a.described], a.colour, a.described);
  const auto in_ranges = [&](int last) {
    return static_cast<std::size_t>(
        std::ranges::count_if(active, [&](const Active& a) { return a.range <= last; }));
  };
  constraints.plain = in_ranges(0);
  constraints.bilateral = in_ranges(1);
  inert_constraints = d.constraints.size() - active.size();
  // A plain constraint has at most 2 (kHubDegree - 1) neighbours: its colour fits a bit of a mask.
  static_assert(2 * reference::kHubDegree <= 64);
  plain_colour.assign(constraints.colour.begin(),
                      constraints.colour.begin() + static_cast<std::ptrdiff_t>(constraints.plain));
}

void Model::append_constraint(const Constraint& c, std::uint32_t colour, std::uint32_t described) {
  constraints.a.push_back(c.a);
  constraints.b.push_back(c.b);
  constraints.rest_length.push_back(c.rest_length);
  constraints.effective_mass.push_back(1 / (inverse_mass[c.a] + inverse_mass[c.b]));
  constraints.colour.push_back(colour);
  constraints.described.push_back(described);
}

void Model::list_adjacent() {
  const ConstraintStore& s = constraints;
  adjacent.begin.assign(particles + 1, 0);
  for (std::size_t c = 0; c < s.size(); ++c) {
    ++adjacent.begin[s.a[c] + 1];
    ++adjacent.begin[s.b[c] + 1];
  }
  std::partial_sum(adjacent.begin.begin(), adjacent.begin.end(), adjacent.begin.begin());
  adjacent.items.resize(adjacent.begin.back());
  std::vector<std::uint32_t> next(adjacent.begin.begin(), adjacent.begin.end() - 1);
  for (std::uint32_t c = 0; c < s.size(); ++c) {
    adjacent.items[next[s.a[c]]++] = c;
    adjacent.items[next[s.b[c]]++] = c;
  }
}

void Model::build_rows() {
  const ConstraintStore& s = constraints;
  rows.begin.push_back(0);
  std::vector<std::pair<std::uint32_t, double>> row;
  for (std::uint32_t c = 0; c < s.plain; ++c) {
    row.clear();
    for (const std::uint32_t p : {s.a[c], s.b[c]}) {
      for (const std::uint32_t j : adjacent[p]) {
        const bool same_end = (s.a[j] == p) == (s.a[c] == p);
        if (j != c) row.emplace_back(j, same_end ? inverse_mass[p] : -inverse_mass[p]);
      }
    }
    std::sort(row.begin(), row.end());
    row_later.push_back(rows.begin.back());
    for (const auto& [j, weight] : row) {
      rows.items.push_back(j);
      row_weight.push_back(weight);
      if (j < c) ++row_later.back();
    }
    rows.begin.push_back(static_cast<std::uint32_t>(rows.items.size()));
  }
}

void Model::build_blocks() {
  for (std::uint32_t c = 0; c < constraints.plain; ++c) {
    const bool full = !block_first.empty() && c - block_first.back() == reference::kBlock;
    if (c == 0 || full || plain_colour[c] != plain_colour[c - 1]) block_first.push_back(c);
    block_of.push_back(static_cast<std::uint32_t>(block_first.size() - 1));
  }
  block_first.push_back(static_cast<std::uint32_t>(constraints.plain));
}

void Model::list_block_neighbours() {
  std::vector<std::uint32_t> blocks;
  block_neighbours.begin.push_back(0);
  for (std::size_t block = 0; block + 1 < block_first.size(); ++block) {
    blocks.clear();
    for (std::size_t c = block_first[block]; c < block_first[block + 1]; ++c) {
      for (const std::uint32_t j : rows[c]) {
        if (j < constraints.plain) blocks.push_back(block_of[j]);
      }
    }
    std::ranges::sort(blocks);
    const auto rest = std::ranges::unique(blocks);
    blocks.erase(rest.begin(), rest.end());
    block_neighbours.items.insert(block_neighbours.items.end(), blocks.begin(), blocks.end());
    block_neighbours.begin.push_back(static_cast<std::uint32_t>(block_neighbours.items.size()));
  }
}

reference::Topology Model::topology() const {
  reference::Topology t;
  t.row_begin = rows.begin.data();
  t.row_later = row_later.data();
  t.row_constraint = rows.items.data();
  t.row_weight = row_weight.data();
  t.blocks = block_first.size() - 1;
  t.block_first = block_first.data();
  t.block_of = block_of.data();
  t.block_begin = block_neighbours.begin.data();
  t.block_neighbour = block_neighbours.items.data();
  t.adjacent_begin = adjacent.begin.data();
  t.adjacent_constraint = adjacent.items.data();
  t.hub = hub.data();
  t.colour = plain_colour.data();
  return t;
}

std::size_t Model::bytes() const {
  const ConstraintStore& s = constraints;
  return initial_position.bytes() + initial_velocity.bytes() + bytes_of(mass) +
         bytes_of(inverse_mass) + bytes_of(s.a) + bytes_of(s.b) + bytes_of(s.rest_length) +
         bytes_of(s.effective_mass) + bytes_of(s.colour) + bytes_of(s.described) +
         bytes_of(adjacent.begin) + bytes_of(adjacent.items) + bytes_of(hub) + bytes_of(hubs) +
         bytes_of(rows.begin) + bytes_of(rows.items) + bytes_of(row_later) + bytes_of(row_weight) +
         bytes_of(block_first) + bytes_of(block_of) + bytes_of(block_neighbours.begin) +
         bytes_of(block_neighbours.items) + bytes_of(plain_colour) + bytes_of(spheres) +
         bytes_of(radius);
}

Result<std::shared_ptr<const Model>> build_model(const SceneDescription& description) {
  if (auto valid = validate(description); !valid) return Error{valid.error()};
  return std::shared_ptr<const Model>(std::make_shared<Model>(description));
}

ModelInfo describe(const Model& model) {
  const ConstraintStore& s = model.constraints;
  return {.particles = model.particles,
          .constraints = s.size(),
          .inert_constraints = model.inert_constraints,
          .ropes = s.size() - s.bilateral,
          .spheres = model.spheres.size(),
          .colours = model.colours,
          .bytes = model.bytes()};
}

}  // namespace weft
