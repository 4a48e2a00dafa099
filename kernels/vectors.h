/// Structure-of-arrays storage for 3-vectors, and the views of it that kernels take.
#pragma once

#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

namespace weft::kernels {

inline constexpr std::size_t kAlignment = 64;  // a cache line, and the widest vector register
/// Components beyond are as good as infinite: 12 kMost^2, the largest squared distance, is not.
inline constexpr double kMost = 1e150;
static_assert(__FINITE_MATH_ONLY__ == 0, "what is not finite must be recognised");

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{kAlignment}));
  }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{kAlignment}); }
  bool operator==(const AlignedAllocator&) const { return true; }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/// A 3-vector in registers.
struct Vector {
  double x, y, z;
  bool operator==(const Vector&) const = default;
};

inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vector a) { return std::sqrt(dot(a, a)); }
/// d over its length. Particles that coincide have no direction; any unit vector separates them.
inline Vector direction(Vector d, double length) {
  return length > 0 ? (1 / length) * d : Vector{0, 1, 0};
}

/// n vectors as three arrays. A view: owns nothing.
struct VectorsView {
  double* x = nullptr;
  double* y = nullptr;
  double* z = nullptr;

  Vector operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vector v) const {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
  void add(std::size_t i, Vector v) const {
    x[i] += v.x;
    y[i] += v.y;
    z[i] += v.z;
  }
};

/// n vectors as three arrays, owned.
struct Vectors {
  AlignedVector<double> x, y, z;

  Vectors() = default;
  explicit Vectors(std::size_t n) : x(n), y(n), z(n) {}
  std::size_t size() const { return x.size(); }
  void resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    z.resize(n);
  }
  Vector operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vector v) { view().set(i, v); }
  VectorsView view() { return {x.data(), y.data(), z.data()}; }
  std::size_t bytes() const { return 3 * x.capacity() * sizeof(double); }
};

}  // namespace weft::kernels
