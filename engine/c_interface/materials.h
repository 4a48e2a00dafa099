/// Materials of C.
#pragma once

#include <weft/mesh.h>
#include <weft/weft_c.h>

namespace weft::c_interface {

Result<Material> read_material(const weft_material* material);

}  // namespace weft::c_interface
