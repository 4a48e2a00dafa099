#include "engine/solvers/direct/direct_system.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/solvers/direct/direct_layout.h"

namespace weft {

DirectSystem::DirectSystem(const Model& model, const Settings& settings)
    : model(model), layout(model.direct()), settings(settings) {
  const std::size_t rows = layout.rows();
  nx.resize(rows);
  ny.resize(rows);
  nz.resize(rows);
  lambda.resize(rows);
  total.resize(model.constraints.size());
  if (model.has_spheres()) touch_of.assign(model.slots(), kNoIndex);
  ties.reserve(layout.links.size());
}

void DirectSystem::start(const SphereContacts& contacts, bool fresh, const SpringLaws* its_laws) {
  laws = its_laws;
  if (laws != nullptr) turned = true;  // softness depends on h
  if (fresh) total.clear();
  total.resize(model.constraints.size() + contacts.count());
}

double DirectSystem::target(std::uint32_t index) const {
  if (laws == nullptr) return model.constraints.rest_length[index];
  return laws->target[index] + laws->softness[index] * total[index];
}

double DirectSystem::softness(std::uint32_t index) const {
  return laws != nullptr && index < model.constraints.size() ? laws->softness[index] : 0;
}

double DirectSystem::tolerance(std::uint32_t index) const {
  const ConstraintStore& s = model.constraints;
  if (laws != nullptr && index < s.size()) return laws->tolerance[index];
  return index < s.size() ? settings.tolerance * s.rest_length[index] : settings.contact_tolerance;
}

int DirectSystem::side(std::uint32_t index) const {
  const ConstraintStore& s = model.constraints;
  if (index < s.bilateral) return 0;
  return index < s.size() ? 1 : -1;
}

double DirectSystem::clamped(std::uint32_t index, double impulse) {
  const int s = side(index);
  const double allowed = s == 0 ? impulse : s * std::max(s * impulse, -s * total[index]);
  total[index] += allowed;
  return allowed;
}

std::size_t DirectSystem::bytes() const {
  return bytes_of(nx) + bytes_of(ny) + bytes_of(nz) + bytes_of(lambda) + bytes_of(total) +
         bytes_of(touches) + bytes_of(touch_of) + bytes_of(ties) + bytes_of(seconds);
}

}  // namespace weft
