#include "tools/scenes/cloth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

namespace weft::scenes {
namespace {

constexpr double kRigidMass = 1;  // kg, shared equally

// ------------------------------------------------------------------------------- rigid edges

/// Adds constraints, except where both ends are fixed.
class Joiner {
 public:
  explicit Joiner(SceneDescription& scene)
      : scene_(scene), is_fixed_(scene.positions.size(), false) {
    for (const std::uint32_t particle : scene.fixed) is_fixed_[particle] = true;
  }
  void join(std::uint32_t a, std::uint32_t b, double rest_length, ConstraintKind kind) {
    if (!is_fixed_[a] || !is_fixed_[b]) scene_.constraints.push_back({a, b, rest_length, kind});
  }

 private:
  SceneDescription& scene_;
  std::vector<bool> is_fixed_;
};

void join_neighbours(const Grid& grid, ConstraintKind kind, Joiner& joiner) {
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    joiner.join(a, b, grid.spacing(), kind);
  };
  for (int i = 0; i < grid.size; ++i) {
    for (int j = 0; j < grid.size; ++j) {
      if (i + 1 < grid.size) join(grid.number(i, j), grid.number(i + 1, j));
      if (j + 1 < grid.size) join(grid.number(i, j), grid.number(i, j + 1));
    }
  }
}

void join_diagonals(const Grid& grid, Joiner& joiner) {
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    joiner.join(a, b, std::numbers::sqrt2 * grid.spacing(), ConstraintKind::rope);
  };
  for (int i = 0; i + 1 < grid.size; ++i) {
    for (int j = 0; j + 1 < grid.size; ++j) {
      join(grid.number(i, j), grid.number(i + 1, j + 1));
      join(grid.number(i + 1, j), grid.number(i, j + 1));
    }
  }
}

double distance(Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

void join_faces(const Layout& layout, ConstraintKind kind, bool has_diagonals, Joiner& joiner) {
  const std::vector<Vec3>& at = layout.rest.empty() ? layout.start : layout.rest;
  const auto join = [&](std::uint32_t a, std::uint32_t b, ConstraintKind its) {
    joiner.join(a, b, distance(at[a], at[b]), its);
  };
  for (const auto& [a, b] : edges_of(layout.faces)) join(a, b, kind);
  if (!has_diagonals) return;
  for (const Face& face : layout.faces) {
    if (face.size() != 4) continue;
    join(face[0], face[2], ConstraintKind::rope);
    join(face[1], face[3], ConstraintKind::rope);
  }
}

/// Every vertex is a particle, those of no face too.
Scene rigid(const Layout& layout, const Options& options) {
  Scene scene;
  SceneDescription& description = scene.description;
  description.positions = layout.start;
  const std::size_t count = layout.start.size();
  description.masses.assign(count, kRigidMass / static_cast<double>(count));
  description.fixed = layout.pins;
  Joiner joiner(description);
  const auto kind = options.ropes ? ConstraintKind::rope : ConstraintKind::distance;
  if (layout.grid) {
    join_neighbours(*layout.grid, kind, joiner);
    if (options.diagonals) join_diagonals(*layout.grid, joiner);
  } else {
    join_faces(layout, kind, options.diagonals, joiner);
  }
  description.surface = tools::triangles_of(layout.faces);
  scene.mesh.particle_of_vertex.resize(count);
  std::iota(scene.mesh.particle_of_vertex.begin(), scene.mesh.particle_of_vertex.end(), 0u);
  return scene;
}

// -------------------------------------------------------------------------------- a material

Ropes ropes_of(const Options& options) {
  if (options.ropes) return Ropes::all;
  return options.diagonals ? Ropes::diagonals : Ropes::none;
}

/// Each particle begins in the middle between its vertices.
void start_from(const std::vector<Vec3>& start, const std::vector<std::uint32_t>& particles,
                SceneDescription& description) {
  const std::size_t count = description.positions.size();
  std::vector<double> vertices(count);
  for (const std::uint32_t particle : particles) {
    if (particle != kNoIndex) ++vertices[particle];
  }
  description.positions.assign(count, {});
  for (std::size_t vertex = 0; vertex < start.size(); ++vertex) {
    if (particles[vertex] == kNoIndex) continue;
    const double share = 1 / vertices[particles[vertex]];
    Vec3& position = description.positions[particles[vertex]];
    position.x += share * start[vertex].x;
    position.y += share * start[vertex].y;
    position.z += share * start[vertex].z;
  }
}

/// Vertices of no face become no particles.
Result<Scene> of_material(const Layout& layout, const Options& options) {
  MeshDescription mesh =
      tools::describe_mesh(layout.rest.empty() ? layout.start : layout.rest, layout.faces);
  mesh.material = options.material;
  if (layout.yield && std::isinf(mesh.material->bending_yield))
    mesh.material->bending_yield = *layout.yield;
  mesh.ropes = ropes_of(options);
  mesh.seams = layout.seams;
  auto made = cloth_from_mesh(mesh);
  if (!made) return Error{made.error()};
  Scene scene{std::move(made.value().scene), {}};
  scene.mesh.particle_of_vertex = std::move(made.value().particle_of_vertex);
  scene.mesh.cells = std::move(made.value().cells);
  start_from(layout.start, scene.mesh.particle_of_vertex, scene.description);
  std::set<std::uint32_t> pinned;
  for (const std::uint32_t pin : layout.pins) {
    const std::uint32_t particle = scene.mesh.particle_of_vertex[pin];
    if (particle != kNoIndex && pinned.insert(particle).second)
      scene.description.fixed.push_back(particle);
  }
  scene.description.air.wind = layout.wind;
  return scene;
}

/// Vertices that are sewn together move as the first of them.
std::vector<tools::PinMove> moves_of(const Layout& layout,
                                     const std::vector<std::uint32_t>& particle_of_vertex) {
  std::vector<tools::PinMove> moves = layout.moves;
  std::set<std::uint32_t> moved;
  for (tools::PinMove& move : moves) {
    std::vector<std::uint32_t> particles;
    for (const std::uint32_t vertex : move.particles) {
      const std::uint32_t particle = particle_of_vertex[vertex];
      if (moved.insert(particle).second) particles.push_back(particle);
    }
    move.particles = std::move(particles);
  }
  return moves;
}

/// The cloth's own particles have radius 0.
void add_sphere(const Ball& ball, SceneDescription& description) {
  const auto number = static_cast<std::uint32_t>(description.positions.size());
  description.radii.assign(description.positions.size(), 0.0);
  description.positions.push_back(ball.centre);
  description.masses.push_back(ball.mass);
  description.radii.push_back(ball.radius);
  description.spheres.push_back(number);
  if (ball.is_fixed) description.fixed.push_back(number);
}

void add_rod(const Rod& rod, const std::vector<std::uint32_t>& particle_of_vertex,
             SceneDescription& description) {
  for (const Vec3 end : {rod.from, rod.to}) {
    const auto number = static_cast<std::uint32_t>(description.positions.size());
    description.positions.push_back(end);
    description.masses.push_back(1);
    description.fixed.push_back(number);
    description.rail_particles.push_back(number);
  }
  for (const std::uint32_t ring : rod.rings)
    description.sliders.push_back({particle_of_vertex[ring], 0, 1, rod.friction});
}

}  // namespace

Result<Scene> cloth_of(const Layout& layout, const Options& options) {
  auto made = options.material ? of_material(layout, options) : rigid(layout, options);
  if (!made) return made;
  Scene& scene = made.value();
  scene.mesh.vertices = layout.start;
  scene.mesh.faces = layout.faces;
  scene.bodies = layout.bodies;
  scene.moves = moves_of(layout, scene.mesh.particle_of_vertex);
  scene.description.self_contact.on = layout.touches_itself;
  if (layout.rod) add_rod(*layout.rod, scene.mesh.particle_of_vertex, scene.description);
  if (layout.sphere) add_sphere(*layout.sphere, scene.description);
  return made;
}

}  // namespace weft::scenes
