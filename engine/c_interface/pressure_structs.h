/// Pressures of C and of C++.
#pragma once

#include <weft/scene.h>
#include <weft/weft_c.h>

#include <cstddef>
#include <vector>

namespace weft::c_interface {

/// Its triangles are those of `part`, which must outlive it.
weft_pressure pressure_of(const Pressure& part);
/// An array of structs, each as large as the first one says.
Result<std::vector<Pressure>> read_pressures(std::size_t count, const weft_pressure* pressures);

}  // namespace weft::c_interface
