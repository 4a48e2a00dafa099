/// The effect of the impulses of a substep on velocities: those of the position loop brought D / h
/// (D: by how much they moved a particle), those of the velocity loop the rest.
#pragma once

namespace weft::kernels {

/// Sums over the free particles, twice an energy each.
struct ImpulseEnergy {
  double first = 0;   // m |D / h|^2
  double second = 0;  // m |dv|^2, dv of the velocity loop
  double gain = 0;    // m |v'|^2 - m |v|^2 - 2 m a . (x' - x)
  double energy = 0;  // m |v'|^2

  void add(const ImpulseEnergy& other) {
    first += other.first;
    second += other.second;
    gain += other.gain;
    energy += other.energy;
  }
};

}  // namespace weft::kernels
