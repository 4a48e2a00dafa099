/// A front and a back that make up a cone, 0.45 m long, sewn along its sides; its waist is fixed.
/// Vertices are about 1/(N-1) m apart.
#include "tools/scenes/built_in.h"
#include "tools/scenes/garments.h"

namespace weft::scenes::built_in {

BuiltIn skirt() {
  return {.summary = "a flared skirt of cotton falls from its waist",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<fitted_skirt>};
}

}  // namespace weft::scenes::built_in
