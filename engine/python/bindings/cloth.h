/// The class Cloth, in two parts.
#pragma once

#include <pybind11/pybind11.h>

#include "held.h"

namespace weft::python {

using ClothClass = pybind11::class_<HeldCloth>;

/// The calls that move a cloth from outside: pins, anchors, bodies, changes.
void add_cloth_motion(pybind11::module_& m, ClothClass& cloth);

/// Steps in the arena, or in this thread if there is none.
template <class Work>
auto in_arena(Arena* arena, const Work& work) {
  return arena ? arena->arena.execute(work) : work();
}

}  // namespace weft::python
