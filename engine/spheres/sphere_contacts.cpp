#include "engine/spheres/sphere_contacts.h"

#include <algorithm>

#include "engine/bytes_of.h"

namespace weft {
namespace {

constexpr double kMargin = 0.05;  // of the sphere's radius

/// Calls visit(sphere, particle, r1 + r2) for every pair nearer than reach(r1) + r2, where r1 is
/// the sphere's radius.
template <class Reach, class Visit>
void for_each_pair(const Model& m, const simd::Table& kernels, kernels::VectorsView x,
                   SphereContacts& contacts, Reach&& reach, Visit&& visit) {
  std::uint32_t* const found = contacts.found.data();
  contacts.boxes.enclose(m, kernels, {x});
  for (const std::uint32_t s : m.spheres) {
    const double extra = reach(m.radius[s]);
    std::size_t near = 0;
    contacts.boxes.visit_near(
        m, kernels, x[s], x[s], extra, [&](std::size_t first, std::size_t last) {
          near += kernels.find_near(x, m.radius.data(), x[s], extra, first, last, found + near);
        });
    for (std::size_t i = 0; i < near; ++i) {
      if (may_touch(m, s, found[i])) visit(s, found[i], m.radius[s] + m.radius[found[i]]);
    }
  }
}

bool listed(const SphereContacts& contacts, std::uint32_t s, std::uint32_t p) {
  for (auto k = contacts.first[p]; k != kNoIndex; k = contacts.next[k]) {
    if (contacts.sphere[k] == s) return true;
  }
  return false;
}

/// Room in all lists before anything is in one: they stay of one length if memory runs out.
void make_room(SphereContacts& contacts) {
  if (contacts.count() < contacts.capacity()) return;
  const std::size_t room = std::max<std::size_t>(64, 2 * std::size_t{contacts.count()});
  contacts.distance.reserve(room);
  contacts.next.reserve(room);
  contacts.particle.reserve(room);
  contacts.sphere.reserve(room);
}

}  // namespace

void SphereContacts::clear() {
  for (const std::uint32_t p : particle) first[p] = kNoIndex;
  sphere.clear();
  particle.clear();
  distance.clear();
  next.clear();
}

void SphereContacts::add(SpherePair pair, double radii) {
  make_room(*this);
  next.push_back(first[pair.particle]);
  first[pair.particle] = count();
  sphere.push_back(pair.sphere);
  particle.push_back(pair.particle);
  distance.push_back(radii);
  met[pair.sphere] = met[pair.particle] = 1;
}

bool may_touch(const Model& m, std::uint32_t sphere, std::uint32_t particle) {
  if (particle == sphere || !m.is_particle(particle)) return false;
  if (m.inverse_mass[sphere] + m.inverse_mass[particle] == 0) return false;
  return !(particle < sphere && m.is_sphere[particle]) && !m.joined_to_sphere(sphere, particle);
}

std::size_t SphereContacts::bytes() const {
  return bytes_of(sphere) + bytes_of(particle) + bytes_of(distance) + bytes_of(first) +
         bytes_of(next) + bytes_of(met) + bytes_of(found) + boxes.bytes();
}

SphereContacts make_sphere_contacts(const Model& model) {
  SphereContacts contacts;
  if (!model.has_spheres()) return contacts;
  contacts.first.assign(model.slots(), kNoIndex);
  contacts.met.resize(model.slots());
  contacts.found.resize(model.slots());
  contacts.boxes = SlotBoxes(model);
  return contacts;
}

void find_contacts(const Model& m, const simd::Table& kernels, kernels::VectorsView x,
                   SphereContacts& contacts) {
  contacts.clear();
  for_each_pair(
      m, kernels, x, contacts, [](double radius) { return (1 + kMargin) * radius; },
      [&](std::uint32_t s, std::uint32_t p, double distance) {
        contacts.add({s, p}, distance);
      });
}

double reach_of(const Model& m, SpherePair pair) {
  return m.radius[pair.particle] + (1 + kMargin) * m.radius[pair.sphere];
}

void find_pairs(const Model& m, const simd::Table& kernels, kernels::VectorsView x, double margin,
                SphereContacts& contacts, std::vector<SpherePair>& pairs) {
  pairs.clear();
  for_each_pair(
      m, kernels, x, contacts,
      [margin](double radius) { return (1 + kMargin) * radius + 2 * margin; },
      [&](std::uint32_t s, std::uint32_t p, double) {
        pairs.push_back({s, p});
      });
}

bool touches_nothing(const Model& m, const SphereContacts& contacts, std::uint32_t slot) {
  return m.has_spheres() && m.is_sphere[slot] && !contacts.met[slot] && !m.is_sphere_joined(slot);
}

std::size_t add_missed_contacts(const Model& m, const simd::Table& kernels, kernels::VectorsView x,
                                double tolerance, SphereContacts& contacts) {
  const std::uint32_t before = contacts.count();
  for_each_pair(
      m, kernels, x, contacts, [&](double radius) { return std::max(0.0, radius - tolerance); },
      [&](std::uint32_t s, std::uint32_t p, double distance) {
        const bool deep = distance - length(x[s] - x[p]) > tolerance;
        if (deep && !listed(contacts, s, p)) contacts.add({s, p}, distance);
      });
  return contacts.count() - before;
}

double max_penetration(const Model& m, const simd::Table& kernels, kernels::VectorsView x,
                       SphereContacts& contacts) {
  double deepest = 0;
  for_each_pair(
      m, kernels, x, contacts, [](double radius) { return radius; },
      [&](std::uint32_t s, std::uint32_t p, double distance) {
        deepest = std::max(deepest, distance - length(x[s] - x[p]));
      });
  return deepest;
}

}  // namespace weft
