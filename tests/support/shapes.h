/// A shape of each kind, for tests that treat all of them alike.
#pragma once

#include <weft/body.h>

#include <vector>

namespace weft::test {

/// About as wide as `size` (m), around the origin, in the order of ShapeDescription. A mesh has
/// four vertices.
std::vector<ShapeDescription> shapes_of_size(double size);
/// The same without meshes.
std::vector<ShapeDescription> closed_forms_of_size(double size);

}  // namespace weft::test
