#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/mesh/bending.h"
#include "engine/mesh/calibration.h"
#include "engine/mesh/delaunay.h"
#include "engine/mesh/edges.h"
#include "engine/mesh/faces.h"
#include "engine/mesh/grid_recognition.h"
#include "engine/mesh/masses.h"
#include "engine/mesh/membrane.h"
#include "engine/mesh/mesh_input.h"
#include "engine/mesh/pieces.h"
#include "engine/mesh/rays.h"
#include "engine/mesh/welding.h"
#include "engine/validation.h"

namespace weft {
namespace mesh {
namespace {

std::vector<std::uint32_t> pinned(const MeshDescription& mesh, const Welded& welded) {
  std::set<std::uint32_t> particles;
  for (const std::uint32_t vertex : mesh.pins) particles.insert(welded.particle_of_vertex[vertex]);
  return {particles.begin(), particles.end()};
}

/// Those that are drawn together; vertices that are one particle, or in no face, need no thread.
std::vector<Seam> seams_of(const MeshDescription& mesh, const Welded& welded) {
  std::vector<Seam> seams;
  if (mesh.seam_time == 0) return seams;
  for (const auto& [one, other] : mesh.seams) {
    const std::uint32_t a = welded.particle_of_vertex[one], b = welded.particle_of_vertex[other];
    if (a != b && a != kNoIndex && b != kNoIndex)
      seams.push_back({a, b, mesh.seam_time, mesh.seam_force});
  }
  return seams;
}

MeshCounts count_all(const MeshDescription& mesh, const Welded& welded,
                     const std::vector<Face>& faces, const Edges& edges) {
  MeshCounts counts;
  for (const Face& face : faces) ++(face.is_quad() ? counts.quads : counts.triangles);
  for (const std::uint32_t particle : welded.particle_of_vertex) {
    counts.unused_vertices += particle == kNoIndex;
  }
  counts.welded_vertices = mesh.positions.size() - counts.unused_vertices - welded.positions.size();
  for (const Edge& edge : edges.all()) counts.non_manifold_edges += edge.faces.size() > 2;
  return counts;
}

void count_pieces(const SceneDescription& scene, MeshCounts& counts) {
  const Pieces pieces = pieces_of(scene);
  counts.pieces = pieces.count;
  counts.loose_pieces = pieces.loose();
  counts.suggested_weld = joining_distance(scene, pieces);
}

/// By so much weights are multiplied. Their size does not depend on that of the mesh then, but is
/// that of 1, -2, 1: d is a length.
double scale_of(const Stencil& stencil) {
  double size = 0;
  for (const double weight : stencil.weights) size += std::abs(weight);
  return 4 / size;
}

BendingElement element_of(const Stencil& stencil, double stiffness) {
  const double scale = scale_of(stencil);
  BendingElement element{.particles = stencil.particles,
                         .weights = stencil.weights,
                         .rest = scale * stencil.rest,
                         .compliance = scale * scale / stiffness,
                         .fold = scale * stencil.fold};
  for (double& weight : element.weights) weight *= scale;
  return element;
}

/// Rays have no side, and so cannot yield: where the material does the elements of edges and quads
/// do without them.
class BendingOfMaterial {
 public:
  BendingOfMaterial(const std::vector<Face>& faces, const MeshDescription& mesh,
                    std::size_t particles)
      : faces_(well_shaped(faces, mesh.weld_distance, std::numeric_limits<double>::infinity())),
        yields_(yields(*mesh.material)) {
    const Edges edges(faces_);
    stencils_ = bending_stencils(faces_, edges, mesh.weld_distance, yields_);
    calibrated_ = calibrate(faces_, edges, stencils_, mesh.weld_distance, particles);
    if (calibrated_.uneven.empty() || yields_) return;
    add_rays(faces_, edges, mesh.weld_distance, calibrated_.uneven, particles, stencils_);
    calibrated_ = calibrate(faces_, edges, stencils_, mesh.weld_distance, particles);
  }

  static bool yields(const Material& m) {
    return std::isfinite(m.bending_yield) || m.bending_friction > 0;
  }
  /// Elements of this stiffness, N m, which yield beyond this curvature, 1/m.
  void add(double stiffness, double yield, double hardening,
           std::vector<BendingElement>& to) const {
    if (!(stiffness > 0)) return;
    const std::vector<double> areas =
        std::isfinite(yield) ? areas_of(stencils_, faces_) : std::vector<double>();
    for (std::size_t i = 0; i < calibrated_.weights.size(); ++i) {
      const double weight = calibrated_.weights[i];
      BendingElement& element =
          to.emplace_back(element_of(stencils_.stencils[i], stiffness * weight));
      if (!std::isfinite(yield) || !(areas[i] > 0)) continue;
      element.arm = scale_of(stencils_.stencils[i]);
      element.yield = element.arm * yield * std::sqrt(areas[i] / weight);
      element.hardening = hardening;
    }
  }

 private:
  std::vector<Face> faces_;
  bool yields_;
  Stencils stencils_;
  Calibrated calibrated_;
};

/// Friction is a spring that yields beside the elastic one, without hardening.
std::vector<BendingElement> bending_of(const std::vector<Face>& faces, std::size_t particles,
                                       const MeshDescription& mesh) {
  const Material& m = *mesh.material;
  if (!(m.bending > 0 || m.bending_friction > 0)) return {};
  const BendingOfMaterial bending(faces, mesh, particles);
  std::vector<BendingElement> elements;
  bending.add(m.bending, m.bending_yield, m.bending_hardening, elements);
  bending.add(m.bending_friction / m.bending_slip, m.bending_slip, 0, elements);
  return elements;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<Face>& faces) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const Face& face : faces) {
    const auto& p = face.particles;
    if (!face.is_quad()) {
      triangles.push_back({p[0], p[1], p[2]});
      continue;
    }
    for (const auto& [i, j, k] : cut(face)) triangles.push_back({p[i], p[j], p[k]});
  }
  return triangles;
}

Air air_of(const SceneDescription& scene, const Material& material) {
  Air air;
  if (!(material.drag > 0 || material.lift > 0 || material.ram > 0)) return air;
  air.drag = material.drag;
  air.lift = material.lift;
  air.ram = material.ram;
  air.triangles = scene.surface;
  return air;
}

/// A particle that is only in faces without area and in lines without length has no mass.
Result<void> check_masses(const MeshDescription& mesh, const Welded& welded,
                          const std::vector<double>& masses) {
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    const std::uint32_t particle = welded.particle_of_vertex[vertex];
    if (particle == kNoIndex || masses[particle] > 0) continue;
    return refuse(
        element("positions", vertex),
        "a material gives no mass to what is in no face with an area and no line with a length",
        text(mesh.positions[vertex]));
  }
  return {};
}

Result<void> add_material(const MeshDescription& mesh, const Welded& welded,
                          const std::vector<Face>& faces, const Edges& edges, MeshCloth& cloth) {
  const Material& material = *mesh.material;
  SceneDescription& scene = cloth.scene;
  Fabric fabric = fabric_of(mesh, welded, faces, edges);
  scene.masses = masses_of(faces, material.density, scene.positions.size());
  add_masses(fabric.threads, mesh.thread_density, scene.masses);
  if (auto r = check_masses(mesh, welded, scene.masses); !r) return r;
  scene.constraints = std::move(fabric.springs);
  scene.constraints.insert(scene.constraints.end(), fabric.threads.begin(), fabric.threads.end());
  scene.membrane = std::move(fabric.membrane);
  if (std::isfinite(material.strength)) scene.surface = triangles_of(fabric.parts);
  cloth.cells = std::move(fabric.cells);
  cloth.counts.thread_lines = fabric.threads.size();
  cloth.counts.recognised_quads -= fabric.cut_again;
  cloth.counts.quads -= fabric.cut_again;
  cloth.counts.triangles += 2 * fabric.cut_again;
  scene.bending = bending_of(faces, scene.positions.size(), mesh);
  scene.damping = {material.damping_stretch, material.damping_bending, material.damping_motion};
  scene.air = air_of(scene, material);
  if (material.thickness > 0) scene.self_contact.thickness = material.thickness;
  scene.self_contact.friction = material.friction;
  return {};
}

void add_rigid_edges(const MeshDescription& mesh, const Welded& welded, SceneDescription& scene) {
  const std::size_t count = scene.positions.size();
  scene.masses.assign(count, mesh.mass / static_cast<double>(count));
  scene.constraints = rigid_constraints(mesh, welded);
}

}  // namespace
}  // namespace mesh

Result<MeshCloth> cloth_from_mesh(const MeshDescription& mesh) {
  if (auto r = mesh::check_input(mesh); !r) return Error{r.error()};
  mesh::Welded welded = mesh::weld(mesh);
  mesh::Faces found = mesh::faces_of(mesh, welded.particle_of_vertex);
  const std::size_t recognised = mesh::recognise_grids(found.faces, mesh.weld_distance);
  const mesh::Edges edges(found.faces);

  MeshCloth cloth;
  cloth.counts = mesh::count_all(mesh, welded, found.faces, edges);
  cloth.counts.recognised_quads = recognised;
  cloth.counts.degenerate_faces = found.degenerate;
  cloth.counts.double_faces = found.doubles;
  SceneDescription& scene = cloth.scene;
  scene.positions = welded.positions;
  scene.fixed = mesh::pinned(mesh, welded);
  scene.seams = mesh::seams_of(mesh, welded);
  scene.surface = mesh::triangles_of(found.faces);
  if (!mesh.material) {
    mesh::add_rigid_edges(mesh, welded, scene);
  } else if (auto r = mesh::add_material(mesh, welded, found.faces, edges, cloth); !r) {
    return Error{r.error()};
  }
  if (scene.constraints.empty() && scene.membrane.empty()) {
    return Error{"every edge of the mesh has length 0"};
  }
  mesh::count_pieces(scene, cloth.counts);
  cloth.particle_of_vertex = std::move(welded.particle_of_vertex);
  return cloth;
}

}  // namespace weft
