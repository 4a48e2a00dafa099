/// Structs of the C interface and the arrays that they point to, as an input says.
#pragma once

#include <weft/weft_c.h>

#include <cstdint>
#include <deque>
#include <vector>

#include "tests/fuzz/drawing.h"

namespace weft::fuzz {

/// Arrays that live as long as it; each has exactly the length that was asked for.
class Arrays {
 public:
  explicit Arrays(Drawing& drawing) : drawing_(drawing) {}
  /// Now and then there is none.
  const double* numbers(std::size_t count, double usual);
  const std::uint32_t* indices(std::size_t count, std::size_t things);
  const std::uint8_t* bytes(std::size_t count);
  /// Mostly there is none.
  const double* optional_numbers(std::size_t count, double usual);
  const std::uint8_t* optional_bytes(std::size_t count);
  /// These.
  const double* given(std::vector<double> numbers);
  const std::uint32_t* given_indices(std::vector<std::uint32_t> indices);
  Drawing& drawing() { return drawing_; }

 private:
  Drawing& drawing_;
  std::deque<std::vector<double>> numbers_;
  std::deque<std::vector<std::uint32_t>> indices_;
  std::deque<std::vector<std::uint8_t>> bytes_;
};

weft_scene draw_scene(Arrays& arrays);
weft_settings draw_settings(Drawing& drawing);
weft_changes draw_changes(Arrays& arrays, std::size_t particles);
/// Of the material where the mesh has one.
weft_mesh draw_mesh(Arrays& arrays, weft_material& material);

}  // namespace weft::fuzz
