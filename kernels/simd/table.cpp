#include "kernels/simd/table.h"

#include <limits>

namespace weft::simd {

void complete(std::span<YarnRow> rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    YarnRow& row = rows[k];
    const YarnRow& next = rows[k + 1 < rows.size() ? k + 1 : k];
    for (std::size_t lane = 0; lane < kernels::kLanes; ++lane) {
      const float rest = row.rest[lane];
      row.joined[lane] = rest > 0 ? row.inverse_mass[lane] + next.inverse_mass[lane] : 0;
      row.scale[lane] = rest > 0 ? rest * rest : std::numeric_limits<float>::max();
    }
  }
}

const Table& table(Isa isa) {
  switch (isa) {
    case Isa::avx512:
      return kAvx512Table;
    case Isa::avx2:
      return kAvx2Table;
    case Isa::sse2:
      break;
  }
  return kSse2Table;
}

}  // namespace weft::simd
