#include "tools/program/run/vtk_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "tools/program/measure/fabric_laws.h"

namespace weft::tools {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

std::vector<std::array<std::uint32_t, 3>> triangles_in(const SceneSource& source) {
  if (source.description.membrane.empty()) return triangles_of(particle_faces(source.mesh));
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const MembraneElement& element : source.description.membrane)
    triangles.push_back(element.particles);
  return triangles;
}

std::vector<double> numbers_of(const std::vector<Vec3>& vectors) {
  std::vector<double> numbers;
  for (const auto& [x, y, z] : vectors) numbers.insert(numbers.end(), {x, y, z});
  return numbers;
}

/// Lists with a number for each cell, NaN until it is set.
struct CellNumbers {
  explicit CellNumbers(std::size_t cells) {
    for (const char* name : {"strain", "tension", "warp_strain", "weft_strain", "warp_tension",
                             "weft_tension", "shear"})
      arrays.push_back({name, 1, std::vector<double>(cells, kUndefined)});
  }
  std::vector<VtuArray> arrays;

  void set(std::size_t cell, const Constraint& c, Vec3 a, Vec3 b) {
    double longer = std::hypot(b.x - a.x, b.y - a.y, b.z - a.z) - c.rest_length;
    if (c.kind == ConstraintKind::rope) longer = std::max(longer, 0.0);
    arrays[0].values[cell] = longer / c.rest_length;
    if (c.compliance > 0) arrays[1].values[cell] = longer / c.compliance;
  }
  void set(std::size_t cell, const MembraneElement& element, const std::vector<Vec3>& at) {
    const auto& [a, b, c] = element.particles;
    const FabricStrain strain = fabric_strain(element, at[a], at[b], at[c]);
    const auto felt = [&](double along) {
      return element.kind == ConstraintKind::rope ? std::max(along, 0.0) : along;
    };
    arrays[2].values[cell] = strain.warp;
    arrays[3].values[cell] = strain.weft;
    arrays[4].values[cell] = element.warp * felt(strain.warp);
    arrays[5].values[cell] = element.weft * felt(strain.weft);
    arrays[6].values[cell] = strain.shear;
  }
};

}  // namespace

VtkSeries::VtkSeries(const std::string& path, const SceneSource& source, PendingFile list)
    : stem_(std::filesystem::path(path).replace_extension().string()),
      source_(&source),
      list_(std::move(list)),
      stretch_(source.description, source.mesh.cells) {}

Result<VtkSeries> VtkSeries::open(const std::string& path, const SceneSource& source) {
  auto list = PendingFile::open(path);
  if (!list) return Error{list.error()};
  VtkSeries series(path, source, std::move(list).value());
  const SceneDescription& scene = source.description;
  series.add_sample(scene.positions, scene.velocities, 0);
  if (!series.written_) return Error{series.written_.error()};
  return series;
}

void VtkSeries::add_frame(const Cloth& cloth, double elapsed) {
  std::vector<Vec3> velocities(cloth.particle_count());
  if (auto read = cloth.read_velocities(velocities); !read) written_ = read;
  std::vector<Vec3> positions = particle_positions(cloth);
  for (auto* vectors : {&positions, &velocities})
    vectors->resize(source_->description.positions.size());  // a torn cloth has more
  add_sample(positions, velocities, elapsed);
}

void VtkSeries::add_sample(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                           double elapsed) {
  if (!written_) return;
  const std::string name = fmt::format("{}_{:04}.vtu", stem_, files_.size());
  files_.emplace_back(elapsed, std::filesystem::path(name).filename().string());
  written_ = write_file(name, vtu_bytes(grid_at(positions, velocities)));
}

VtuGrid VtkSeries::grid_at(const std::vector<Vec3>& positions,
                           const std::vector<Vec3>& velocities) const {
  const SceneDescription& scene = source_->description;
  VtuGrid grid;
  grid.points = positions;
  grid.triangles = triangles_in(*source_);
  for (const Constraint& c : scene.constraints) grid.lines.push_back({c.a, c.b});
  std::vector<Vec3> moving = velocities;
  moving.resize(positions.size());  // a scene at rest has none
  grid.of_points = {{"velocity", 3, numbers_of(moving)}, {"stretch", 1, stretch_(positions)}};
  CellNumbers numbers(grid.triangles.size() + grid.lines.size());
  for (std::size_t i = 0; i < scene.membrane.size(); ++i)
    numbers.set(i, scene.membrane[i], positions);
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    const Constraint& c = scene.constraints[i];
    numbers.set(grid.triangles.size() + i, c, positions[c.a], positions[c.b]);
  }
  grid.of_cells = std::move(numbers.arrays);
  return grid;
}

Result<void> VtkSeries::finish() {
  if (!written_) return written_;
  list_.write(pvd_text(files_));
  return list_.commit();
}

}  // namespace weft::tools
