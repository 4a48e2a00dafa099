#include "engine/spheres/nearby_pairs.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/erase_repeated.h"

namespace weft {

void NearbySpherePairs::find(const Model& model, const simd::Table& kernels, kernels::VectorsView x,
                             double margin, SphereContacts& contacts) {
  forget();
  find_pairs(model, kernels, x, margin, contacts, pairs_);
  slots_.clear();
  for (const SpherePair& pair : pairs_) slots_.insert(slots_.end(), {pair.sphere, pair.particle});
  std::ranges::sort(slots_);
  erase_repeated(slots_);
  spare_ = margin;
}

void NearbySpherePairs::list_contacts(const Model& model, kernels::VectorsView x,
                                      SphereContacts& contacts) const {
  contacts.clear();
  for (const SpherePair& pair : pairs_) {
    const kernels::Vector d = x[pair.particle] - x[pair.sphere];
    const double reach = reach_of(model, pair);
    if (dot(d, d) < reach * reach)
      contacts.add(pair, model.radius[pair.sphere] + model.radius[pair.particle]);
  }
}

std::size_t NearbySpherePairs::bytes() const { return bytes_of(pairs_) + bytes_of(slots_); }

}  // namespace weft
