/// Requests of threads that work together to a processor, beyond C++.
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
#elif defined(__aarch64__)
  asm volatile("isb" ::: "memory");  // waits some tens of cycles; yield does not
#endif
}

/// MXCSR, or FPCR of aarch64: how a thread rounds and treats denormal numbers. WebAssembly has one
/// way, and does not wait in a loop: it has one thread here.
using FloatControl = std::uint64_t;

inline FloatControl float_control() {
#if defined(__x86_64__)
  return _mm_getcsr();
#elif defined(__aarch64__)
  FloatControl control;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  return control;
#else
  return 0;
#endif
}

inline void set_float_control([[maybe_unused]] FloatControl control) {
#if defined(__x86_64__)
  _mm_setcsr(static_cast<std::uint32_t>(control));
#elif defined(__aarch64__)
  asm volatile("msr fpcr, %0" ::"r"(control));
#endif
}

}  // namespace weft
