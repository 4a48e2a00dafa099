/// What a triangle of fabric feels where its corners are, from the definition of its laws.
#pragma once

#include <weft/weft.h>

namespace weft::tools {

struct FabricStrain {
  double warp = 0;   ///< longer by this share
  double weft = 0;   ///< likewise
  double shear = 0;  ///< the cosine of the angle between both
};
/// a, b, c: where the element's corners are.
FabricStrain fabric_strain(const MembraneElement& element, Vec3 a, Vec3 b, Vec3 c);
double rest_area(const MembraneElement& element);  ///< m^2

}  // namespace weft::tools
