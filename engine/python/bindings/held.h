/// The hold of Python on weft's objects, and the rules of their use.
#pragma once

#include <oneapi/tbb/task_arena.h>
#include <weft/body.h>
#include <weft/cloth.h>
#include <weft/surface.h>

#include <atomic>
#include <memory>
#include <utility>

#include "errors.h"

namespace weft::python {

struct HeldModel {
  std::shared_ptr<const Model> model;
};
struct HeldShape {
  std::shared_ptr<const BodyShape> shape;
};

/// Threads that steps may use.
struct Arena {
  explicit Arena(int threads) : arena(threads) {}
  oneapi::tbb::task_arena arena;
};

/// One thread at a time: while one uses it, another one is refused.
template <class T>
struct Exclusive {
  explicit Exclusive(T taken) : value(std::move(taken)) {}
  T value;
  mutable std::atomic_flag in_use = ATOMIC_FLAG_INIT;
};
using HeldCloth = Exclusive<Cloth>;
using HeldSurface = Exclusive<Surface>;

/// The use of one, from here to the end of the scope.
template <class T>
class Use {
 public:
  Use(const Exclusive<T>& held, const char* what) : held_(&held) {
    if (held.in_use.test_and_set(std::memory_order_acquire)) {
      held_ = nullptr;
      refuse(std::string(what) + ": another thread uses it");
    }
  }
  Use(Use&& from) noexcept : held_(std::exchange(from.held_, nullptr)) {}
  Use& operator=(Use&&) = delete;
  ~Use() {
    if (held_) held_->in_use.clear(std::memory_order_release);
  }

 private:
  const Exclusive<T>* held_;
};

inline Use<Cloth> use(const HeldCloth& cloth) { return {cloth, "cloth"}; }
inline Use<Surface> use(const HeldSurface& surface) { return {surface, "surface"}; }

}  // namespace weft::python
