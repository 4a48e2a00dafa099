/// Sheets as mesh descriptions: what their vertices and faces are.
#pragma once

#include <weft/mesh.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/random.h"

namespace weft::test {

/// How a cell of a sheet is filled: by itself, or cut along one of its diagonals.
enum class Cut { none, first, second };

/// Rows by columns of vertices, (row, column) numbered row * columns + column. The first diagonal
/// runs from (row, column) to (row + 1, column + 1).
MeshDescription sheet(std::uint32_t rows, std::uint32_t columns,
                      const std::function<Vec3(double row, double column)>& place,
                      const std::function<Cut(std::uint32_t row, std::uint32_t column)>& cut);

/// In the plane z = 0, with spacings of 1.
MeshDescription quads(std::uint32_t size);
MeshDescription right_triangles(std::uint32_t size);
MeshDescription equilateral_triangles(std::uint32_t size);
/// The same with vertices moved by up to `jitter` along each axis.
MeshDescription irregular_triangles(std::uint32_t size, double jitter, Random& random);

/// Soft and heavy enough for round numbers.
Material plain_material();

MeshCloth made(const MeshDescription& mesh);
std::string refusal(const MeshDescription& mesh);

/// J, of all springs and triangles of fabric, or all bending elements, at these positions.
double membrane_energy(const SceneDescription& scene, const std::vector<Vec3>& positions);
double bending_energy(const SceneDescription& scene, const std::vector<Vec3>& positions);

/// m^2, what the masses say.
double area_of(const SceneDescription& scene, const Material& material);

}  // namespace weft::test
