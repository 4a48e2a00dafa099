#include "kernels/simd/table.h"

#include <limits>

namespace weft::simd {

void derive_joints(std::span<YarnRow> rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    YarnRow& row = rows[k];
    for (std::size_t lane = 0; lane < kernels::kLanes; ++lane) {
      const float rest = row.rest[lane];
      const bool joins = rest > 0 && k + 1 < rows.size();
      row.joined[lane] = joins ? row.inverse_mass[lane] + rows[k + 1].inverse_mass[lane] : 0;
      row.square[lane] = joins ? rest * rest : std::numeric_limits<float>::max();
    }
  }
}

}  // namespace weft::simd
