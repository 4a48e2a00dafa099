/// What threads that work together ask of a processor beyond C++.
#pragma once

#include <cstdint>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace weft {

/// Tells the processor that this thread waits in a loop.
inline void pause() {
#if defined(__x86_64__)
  _mm_pause();
#else
  asm volatile("isb" ::: "memory");  // waits some tens of cycles; yield does not
#endif
}

/// MXCSR, or FPCR of aarch64: how a thread rounds and treats denormal numbers.
using FloatControl = std::uint64_t;

inline FloatControl float_control() {
#if defined(__x86_64__)
  return _mm_getcsr();
#else
  FloatControl control;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  return control;
#endif
}

inline void set_float_control(FloatControl control) {
#if defined(__x86_64__)
  _mm_setcsr(static_cast<std::uint32_t>(control));
#else
  asm volatile("msr fpcr, %0" ::"r"(control));
#endif
}

}  // namespace weft
