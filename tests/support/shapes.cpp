#include "tests/support/shapes.h"

#include <variant>

namespace weft::test {

std::vector<ShapeDescription> shapes_of_size(double size) {
  const TriangleMesh plate{
      .vertices = {{-size, 0, -size}, {-size, 0, size}, {size, 0, size}, {size, 0, -size}},
      .triangles = {{0, 1, 2}, {0, 2, 3}},
      .two_sided = true};
  std::vector<ShapeDescription> shapes{
      Plane{.normal = {0, 1, 0.1}, .offset = -0.3 * size},
      Ball{.radius = size},
      Capsule{{-size, 0, 0}, {size, 0, 0}, 0.4 * size, 0.3 * size},
      box({size, size, size}),
      plate,
      HeightField{2, 3, size, 0.5 * size, {0, 0.1 * size, -0.2 * size, 0.2 * size, 0, 0.3 * size}},
      Torus{.axis = {0, 1, 0.2}, .major = size, .minor = 0.3 * size},
  };
  return shapes;
}

std::vector<ShapeDescription> closed_forms_of_size(double size) {
  std::vector<ShapeDescription> shapes = shapes_of_size(size);
  std::erase_if(shapes, [](const ShapeDescription& shape) {
    return std::holds_alternative<TriangleMesh>(shape);
  });
  return shapes;
}

}  // namespace weft::test
