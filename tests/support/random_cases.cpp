#include "tests/support/random_cases.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tests/support/meshes.h"
#include "tests/support/vectors.h"

namespace weft::test {
namespace {

template <class T, std::size_t kCount>
T one_of(const std::array<T, kCount>& choices, Random& random) {
  return choices[random.below(kCount)];
}

bool by_chance(double share, Random& random) { return random.between(0, 1) < share; }

double decades(double low, double high, Random& random) {
  return std::pow(10, random.between(low, high));
}

// ----------------------------------------------------------------------------------------- meshes

Mesh holed_grid(Random& random) {
  Mesh mesh = grid(2 + random.below(6), 2 + random.below(6));
  const double holes = random.between(0, 0.3);
  std::erase_if(mesh.links, [&](const Link&) { return by_chance(holes, random); });
  return mesh;
}

/// Every particle hangs at one before it.
Mesh tree(std::uint32_t particles, Random& random) {
  Mesh mesh;
  mesh.positions.push_back({0, 0, 0});
  for (std::uint32_t i = 1; i < particles; ++i) {
    const std::uint32_t parent = i - 1 - random.below(std::min(i, 4u));
    const Vec3 to = random.in_box(1) + Vec3{0, -0.5, 0};
    mesh.positions.push_back(mesh.positions[parent] + (0.2 + length(to)) * to);
    mesh.links.push_back({parent, i, ConstraintKind::distance});
  }
  return mesh;
}

/// One particle joined to all others.
Mesh star(std::uint32_t rays, Random& random) {
  Mesh mesh;
  mesh.positions.push_back({0, 0, 0});
  for (std::uint32_t i = 1; i <= rays; ++i) {
    mesh.positions.push_back(random.in_box(1));
    mesh.links.push_back({0, i, ConstraintKind::distance});
  }
  return mesh;
}

Mesh draw_mesh(std::string& shape, Random& random) {
  switch (random.below(9)) {
    case 0:
      return shape = "chain", chain(1 + random.below(20));
    case 1:
      return shape = "grid with holes", holed_grid(random);
    case 2:
      return shape = "triangles", triangles(2 + random.below(5), 2 + random.below(5), 0.3,
                                            random.between(0, 0.5), random);
    case 3: {
      const std::uint32_t particles = 2 + random.below(30);
      return shape = "graph", random_graph(particles, random.below(2 * particles), 8, random);
    }
    case 4:
      return shape = "tree", tree(1 + random.below(30), random);
    case 5:
      return shape = "star", star(1 + random.below(by_chance(0.1, random) ? 80 : 12), random);
    case 6:
      return shape = "tube", tube(1 + random.below(4), 3 + random.below(6));
    case 7: {
      Mesh mesh = grid(2 + random.below(4), 2 + random.below(4));
      const auto rows = static_cast<std::uint32_t>(mesh.positions.back().x) + 1;
      const auto columns = static_cast<std::uint32_t>(mesh.positions.back().z) + 1;
      add_diagonals(mesh, rows, columns, ConstraintKind::rope);
      if (by_chance(0.5, random)) add_bending(mesh, rows, columns, ConstraintKind::rope);
      return shape = "roped grid", mesh;
    }
    default: {
      std::string left, right;
      const Mesh one = draw_mesh(left, random);
      const Mesh two = draw_mesh(right, random);
      shape = left + " and " + right;
      return both(one, two);
    }
  }
}

/// A sheet that is worth two threads.
Mesh large_mesh(std::string& shape, Random& random) {
  if (by_chance(0.5, random)) return shape = "large grid", grid(46, 45 + random.below(20));
  return shape = "large triangles", triangles(46, 46, 0.3, 0.02, random);
}

// ----------------------------------------------------------------------------------------- scenes

struct Ranges {
  double mass_decades = 0;  // to either side of a mass
  double misfit = 0;        // rest lengths are off by up to this part
  double reach = 0;         // how far a step may carry a particle, in shortest edges
};

double shortest(const SceneDescription& scene) {
  double least = 1e300;
  for (const Constraint& c : scene.constraints) least = std::min(least, c.rest_length);
  return scene.constraints.empty() ? 1 : least;
}

/// Of the given size in m per unit of the mesh.
SceneDescription scene_of(const Mesh& mesh, double size, const Ranges& ranges, Random& random) {
  SceneDescription scene;
  const double mass = decades(-3, 1, random);
  for (const Vec3& p : mesh.positions) {
    scene.positions.push_back(size * p);
    scene.masses.push_back(mass * decades(-ranges.mass_decades, ranges.mass_decades, random));
  }
  for (const Link& link : mesh.links) {
    const double apart = distance(scene.positions[link.a], scene.positions[link.b]);
    const double misfit = random.between(-ranges.misfit, ranges.misfit);
    scene.constraints.push_back({link.a, link.b, (1 + misfit) * apart, link.kind});
  }
  return scene;
}

/// One corner at the origin of the fabric, the sides to the others as long as their constraints and
/// at any angle, turned.
MembraneElement element_of(std::uint32_t at, const Constraint& one, const Constraint& two,
                           Random& random) {
  const auto stiffness = [&] { return random.below(6) == 0 ? 0 : decades(-1, 8, random); };
  MembraneElement e{.particles = {at, one.a == at ? one.b : one.a, two.a == at ? two.b : two.a},
                    .warp = stiffness(),
                    .weft = stiffness(),
                    .shear = stiffness()};
  const double turn = random.between(0, 6.2), angle = turn + random.between(0.4, 2.6);
  e.rest[1] = {one.rest_length * std::cos(turn), one.rest_length * std::sin(turn)};
  e.rest[2] = {two.rest_length * std::cos(angle), two.rest_length * std::sin(angle)};
  if (random.below(3) == 0) e.kind = ConstraintKind::rope;
  return e;
}

/// Between two constraints that meet, by chance.
void add_fabric(SceneDescription& scene, Random& random) {
  std::vector<std::vector<std::uint32_t>> at(scene.positions.size());
  for (std::uint32_t i = 0; i < scene.constraints.size(); ++i) {
    at[scene.constraints[i].a].push_back(i);
    at[scene.constraints[i].b].push_back(i);
  }
  for (std::uint32_t particle = 0; particle < at.size(); ++particle) {
    const auto count = static_cast<std::uint32_t>(at[particle].size());
    for (std::uint32_t k = 0; count > 1 && k < 2; ++k) {
      const std::uint32_t one = random.below(count);
      const std::uint32_t two = (one + 1 + random.below(count - 1)) % count;
      const MembraneElement e = element_of(particle, scene.constraints[at[particle][one]],
                                           scene.constraints[at[particle][two]], random);
      if (e.particles[1] != e.particles[2]) scene.membrane.push_back(e);
    }
  }
}

/// Hinges between triangles of fabric that share an edge, some folded at rest, which yield.
void add_hinges(SceneDescription& scene, Random& random) {
  const auto far_corner = [](const MembraneElement& e, std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t p : e.particles)
      if (p != a && p != b) return p;
    return kNoIndex;
  };
  const double unit = shortest(scene);
  for (std::size_t i = 0; i < scene.membrane.size(); ++i) {
    const std::size_t j = random.below(static_cast<std::uint32_t>(scene.membrane.size()));
    std::vector<std::uint32_t> shared;
    for (const std::uint32_t p : scene.membrane[i].particles)
      if (std::ranges::count(scene.membrane[j].particles, p) > 0) shared.push_back(p);
    if (i == j || shared.size() != 2) continue;
    const std::uint32_t one = far_corner(scene.membrane[i], shared[0], shared[1]);
    const std::uint32_t two = far_corner(scene.membrane[j], shared[0], shared[1]);
    const double share = random.between(0, 2);
    BendingElement e{.particles = {shared[0], shared[1], one, two},
                     .weights = {share - 2, -share, 1, 1},
                     .compliance = decades(-4, 4, random)};
    if (by_chance(0.3, random)) e.fold = random.between(-1, 1) * unit;
    e.arm = random.between(0.6, 2) * unit;
    e.yield = decades(-3, 0.5, random) * unit;
    if (by_chance(0.5, random)) e.hardening = decades(-2, 1, random);
    scene.bending.push_back(e);
    if (by_chance(0.5, random)) scene.bending.push_back(e);
  }
}

void draw_motion(RandomCase& c, const Ranges& ranges, Random& random) {
  const double way = ranges.reach * shortest(c.scene);
  c.dt = decades(-4, -1.5, random);
  c.scene.gravity = random.below(4) == 0 ? Vec3{} : (way / (c.dt * c.dt)) * random.in_box(0.5);
  if (random.below(3) > 0) {
    for (std::size_t i = 0; i < c.scene.positions.size(); ++i) {
      c.scene.velocities.push_back(random.in_box(way / c.dt));
    }
  }
  if (random.below(3) == 0) {
    for (const double mass : c.scene.masses) {
      c.forces.push_back(random.in_box(mass * way / (c.dt * c.dt)));
    }
  }
}

void fix_some(SceneDescription& scene, double share, Random& random) {
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    if (by_chance(share, random)) scene.fixed.push_back(i);
  }
}

/// One or two spheres of their own, clear of everything, that fly towards it.
void add_spheres(RandomCase& c, Random& random) {
  SceneDescription& scene = c.scene;
  const double unit = shortest(scene);
  Vec3 middle, top = scene.positions[0];
  for (const Vec3& p : scene.positions) {
    middle = middle + (1.0 / static_cast<double>(scene.positions.size())) * p;
    if (p.y > top.y) top = p;
  }
  scene.radii.assign(scene.positions.size(), by_chance(0.5, random) ? 0.1 * unit : 0);
  double height = top.y;
  const std::uint32_t count = 1 + random.below(2);
  for (std::uint32_t k = 0; k < count; ++k) {
    const double radius = random.between(0.3, 2) * unit;
    height += 1.01 * radius + 0.11 * unit;
    scene.spheres.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    scene.positions.push_back({middle.x, height, middle.z});
    scene.masses.push_back(scene.masses[0] * decades(-1, 2, random));
    scene.radii.push_back(radius);
    scene.velocities.resize(scene.positions.size() - 1);
    scene.velocities.push_back({0, -random.between(0, 1) * unit / c.dt, 0});
    if (!c.forces.empty()) c.forces.push_back({});
    if (by_chance(0.3, random)) scene.fixed.push_back(scene.spheres.back());
    height += 1.01 * radius;
  }
}

void shuffle_constraints(SceneDescription& scene, Random& random) {
  std::vector<Constraint> shuffled;
  for (const std::uint32_t i : random.permutation(scene.constraints.size())) {
    shuffled.push_back(scene.constraints[i]);
    if (random.below(2) == 0) std::swap(shuffled.back().a, shuffled.back().b);
  }
  scene.constraints = shuffled;
}

void move_away(SceneDescription& scene, Vec3 by) {
  for (Vec3& p : scene.positions) p = p + by;
}

/// What scenes should not be, and are: all particles in one point or on a line, scrambled, faster
/// than numbers go.
void spoil(RandomCase& c, Random& random) {
  SceneDescription& scene = c.scene;
  const std::uint32_t particles = static_cast<std::uint32_t>(scene.positions.size());
  const std::uint32_t victim = random.below(particles);
  switch (random.below(5)) {
    case 0:
      c.shape += ", in one point";
      scene.positions.assign(particles, Vec3(scene.positions[victim]));
      return;
    case 1:
      c.shape += ", on a line";
      for (Vec3& p : scene.positions) p = {p.x, 0, 0};
      return;
    case 2: {
      c.shape += ", scrambled";
      const std::vector<Vec3> before = scene.positions;
      const std::vector<std::uint32_t> order = random.permutation(particles);
      for (std::uint32_t i = 0; i < particles; ++i) scene.positions[i] = before[order[i]];
      return;
    }
    case 3:
      c.shape += ", one particle very fast";
      scene.velocities.resize(particles);
      scene.velocities[victim] = decades(3, 308, random) * random.in_box(0.5);
      return;
    default:
      c.shape += ", one particle pulled very hard";
      c.forces.resize(particles);
      c.forces[victim] = decades(3, 308, random) * random.in_box(0.5);
  }
}

// --------------------------------------------------------------------------------------- settings

Settings draw_settings(Random& random) {
  Settings s;
  s.tolerance = decades(-5, -1, random);
  s.substeps = random.below(4) == 0 ? 2 + static_cast<int>(random.below(3)) : 1;
  s.iterations = random.below(12) == 0 ? 1 + static_cast<int>(random.below(20)) : 0;
  s.measuring.renew_after = one_of(std::array{0, 1, 3, 32}, random);
  s.max_iterations = one_of(std::array{3, 300, 1000, 1000}, random);
  s.contact_tolerance = decades(-6, -3, random);
  s.velocity_tolerance = decades(-4, -1, random);
  s.solver = one_of(std::array{Solver::gauss_seidel, Solver::gauss_seidel, Solver::direct}, random);
  s.backend = one_of(std::array{Backend::reference, Backend::simd, Backend::simd}, random);
  s.measuring.directions = one_of(std::array{Directions::each, Directions::frozen}, random);
  s.measuring.anticipate = random.below(2) == 0;
  s.measuring.skip = random.below(2) == 0;
  s.velocity_correction = random.below(3) == 0;
  return s;
}

/// Where there are any.
void draw_products(Settings& s, Random& random) {
  const bool may =
      s.backend == Backend::simd && s.solver == Solver::gauss_seidel && s.measuring.anticipate;
  s.measuring.anticipate_products = may && random.below(2) == 0;
}

std::uint32_t environment(const char* variable, std::uint32_t otherwise) {
  const char* const value = std::getenv(variable);
  if (value == nullptr) return otherwise;
  const std::string_view digits = value;
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), number);
  const bool good = error == std::errc() && end == digits.end();
  REQUIRE_MESSAGE(good, variable, " must be a number: ", value);
  return number;
}

}  // namespace

RandomCase random_case(std::uint32_t seed) {
  Random random(seed);
  RandomCase c;
  c.seed = seed;
  const bool large = random.below(250) == 0;
  const double size = decades(-2, 2, random);
  Ranges ranges;
  ranges.mass_decades = one_of(std::array{0.0, 0.3, 1.0, 3.0, 9.0}, random);
  ranges.misfit = one_of(std::array{0.0, 0.0, 0.05, 0.3}, random);
  ranges.reach = one_of(std::array{0.01, 0.1, 0.5, 3.0}, random);
  const Mesh mesh = large ? large_mesh(c.shape, random) : draw_mesh(c.shape, random);
  c.scene = scene_of(mesh, size, ranges, random);
  draw_motion(c, ranges, random);
  fix_some(c.scene, one_of(std::array{0.0, 0.02, 0.1, 0.1, 0.3, 1.0}, random), random);
  if (random.below(4) == 0) add_spheres(c, random);
  shuffle_constraints(c.scene, random);
  if (random.below(8) == 0) spoil(c, random);
  if (random.below(3) == 0) move_away(c.scene, random.in_box(1000 * size));
  c.settings = draw_settings(random);
  if (large) c.settings.max_iterations = 20;
  c.steps = large ? 1 : 1 + static_cast<int>(random.below(4));
  c.moves_pins = random.below(4) == 0;
  c.settings.scheme = one_of(std::array{Scheme::paper, Scheme::paper, Scheme::rattle}, random);
  const std::uint32_t newer = random.below(4);
  if (newer == 0) c.settings.solver = Solver::automatic;
  if (newer == 1 && c.settings.backend == Backend::simd) c.settings.solver = Solver::yarn;
  if (random.below(3) == 0 && c.settings.backend == Backend::simd) {
    c.settings.solver = Solver::small_steps;
    c.settings.scheme = one_of(std::array{Scheme::implicit, Scheme::bdf2}, random);
    c.settings.velocity_correction = false;
    if (random.below(2) == 0) c.settings.substeps = kAutomaticSubsteps;
  }
  draw_products(c.settings, random);
  return c;
}

RandomCase softened_case(std::uint32_t seed) {
  RandomCase c = random_case(seed);
  Random random(seed);
  for (Constraint& link : c.scene.constraints) {
    if (random.below(3) > 0) link.compliance = std::pow(10, random.between(-12, 1));
  }
  if (random.below(3) == 0) c.scene.damping.stretch = std::pow(10, random.between(-4, 0));
  c.settings.velocity_correction = c.settings.measuring.anticipate_products = false;
  if (c.settings.scheme == Scheme::rattle) c.settings.scheme = Scheme::paper;
  return c;
}

RandomCase fabric_case(std::uint32_t seed) {
  Random random(seed + 1'000'003);
  RandomCase c = random.below(2) == 0 ? random_case(seed) : softened_case(seed);
  c.shape += " with fabric";
  add_fabric(c.scene, random);
  if (Random yielding(seed + 2'000'003); yielding.below(3) == 0) {
    c.shape += " that yields";
    add_hinges(c.scene, yielding);
  }
  if (random.below(2) == 0) c.scene.constraints.clear();
  if (random.below(3) == 0) c.scene.damping.stretch = decades(-4, 0, random);
  c.settings.solver = random.below(4) == 0 ? Solver::automatic : Solver::small_steps;
  c.settings.scheme = one_of(std::array{Scheme::implicit, Scheme::bdf2}, random);
  if (c.settings.solver == Solver::automatic) c.settings.scheme = Scheme::automatic;
  c.settings.velocity_correction = c.settings.measuring.anticipate_products = false;
  if (random.below(2) == 0) c.settings.substeps = kAutomaticSubsteps;
  return c;
}

RandomCase gentle_case(std::uint32_t seed) {
  Random random(seed);
  RandomCase c;
  c.seed = seed;
  Ranges ranges;
  ranges.mass_decades = random.between(0, 0.5);
  ranges.misfit = one_of(std::array{0.0, 0.001}, random);
  ranges.reach = one_of(std::array{0.001, 0.01, 0.05}, random);
  Mesh mesh = draw_mesh(c.shape, random);
  for (Link& link : mesh.links) link.kind = ConstraintKind::distance;
  c.scene = scene_of(mesh, decades(-2, 2, random), ranges, random);
  draw_motion(c, ranges, random);
  fix_some(c.scene, one_of(std::array{0.0, 0.02, 0.1}, random), random);
  shuffle_constraints(c.scene, random);
  c.settings = draw_settings(random);
  c.settings.tolerance = 1e-9;
  c.settings.velocity_tolerance = 1e-6 * shortest(c.scene) / c.dt;
  c.settings.substeps = 1;
  c.settings.iterations = 0;
  c.settings.max_iterations = 1'000'000;
  if (random.below(4) == 0) {
    c.settings.backend = Backend::simd;
    c.settings.solver = Solver::yarn;
    c.settings.tolerance = 1e-6;  // beyond what its floats see, steps are done in halves
    c.settings.velocity_tolerance *= 1000;
  }
  draw_products(c.settings, random);
  return c;
}

RandomCase roped_case(std::uint32_t seed) {
  Random random(seed);
  RandomCase c;
  c.seed = seed;
  Ranges ranges;
  ranges.mass_decades = one_of(std::array{0.0, 0.3, 1.0}, random);
  ranges.reach = one_of(std::array{0.001, 0.01, 0.1}, random);
  Mesh mesh = draw_mesh(c.shape, random);
  for (Link& link : mesh.links) link.kind = ConstraintKind::rope;
  c.scene = scene_of(mesh, decades(-2, 2, random), ranges, random);
  draw_motion(c, ranges, random);
  c.forces.clear();
  if (random.below(2) == 0) {
    c.scene.fixed = {random.below(static_cast<std::uint32_t>(mesh.positions.size()))};
  }
  shuffle_constraints(c.scene, random);
  c.settings = draw_settings(random);
  c.settings.tolerance = decades(-7, -1, random);
  c.settings.substeps = 1;
  c.settings.iterations = 0;
  c.settings.max_iterations = 3000;
  c.settings.velocity_correction = false;
  c.steps = 8;
  draw_products(c.settings, random);
  return c;
}

double RandomCase::frame(int k) const {
  if (k == 0 || !frames_vary()) return dt;
  return Random(seed + 7919 * static_cast<std::uint32_t>(k)).between(4. / 33, 1) * dt;
}

std::string text(const RandomCase& c) {
  const SceneDescription& d = c.scene;
  const Settings& s = c.settings;
  std::ostringstream out;
  out << "WEFT_SEED=" << c.seed << " WEFT_CASES=1: " << c.shape << ", " << d.positions.size()
      << " particles, " << d.constraints.size() << " constraints, " << d.membrane.size()
      << " triangles, " << d.fixed.size() << " fixed, " << d.spheres.size() << " spheres; dt "
      << c.dt << (c.frames_vary() ? " at most; " : "; ") << name(s.solver) << ", " << name(s.scheme)
      << ", " << name(s.backend) << ", " << name(s.measuring.directions)
      << (s.measuring.anticipate ? ", anticipate" : "")
      << (s.measuring.anticipate_products ? " through products" : "")
      << (s.measuring.skip ? ", skip" : "")
      << (s.velocity_correction ? ", velocity correction" : "") << ", tolerance " << s.tolerance
      << ", contacts " << s.contact_tolerance << ", velocities " << s.velocity_tolerance
      << ", substeps " << s.substeps << ", iterations " << s.iterations << " of at most "
      << s.max_iterations << ", renewed after " << s.measuring.renew_after;
  return out.str();
}

Seeds seeds(std::uint32_t count) {
  return {environment("WEFT_SEED", 1), environment("WEFT_CASES", count)};
}

}  // namespace weft::test
