/// The tunic, worn by a body of capsules that begins to walk after a second, 1 m/s.
#include "tools/scenes/built_in.h"
#include "tools/scenes/wearer.h"

namespace weft::scenes::built_in {

BuiltIn mannequin() {
  return {.summary = "a tunic of cotton on a body that walks",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<dressed_wearer>};
}

}  // namespace weft::scenes::built_in
