/// A front and a back of irregular triangles, body and sleeves of one piece, sewn along shoulders,
/// sleeves and sides (garments.cpp has the pattern, 0.9 m wide and 0.7 long). Vertices are about
/// 1/(N-1) m apart. It hangs from 8 cm of each shoulder. It has self-contact.
#include "tools/scenes/built_in.h"
#include "tools/scenes/garments.h"

namespace weft::scenes::built_in {

BuiltIn tunic() {
  return {.summary = "a sewn tunic of cotton hangs from two pegs",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<hung_tunic>};
}

}  // namespace weft::scenes::built_in
