/// The bodies of a cloth: their places, their motions, and the loads of the cloth on them.
#pragma once

#include <weft/body.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/bodies/body_shape.h"
#include "engine/bodies/free_body.h"
#include "engine/bodies/pose.h"
#include "engine/saving/fields.h"
#include "engine/turn.h"

namespace weft {

/// A body that is there in a step.
struct TravellingBody {
  std::uint32_t id = 0;
  std::shared_ptr<const BodyShape> shape;
  PoseTravel travel;
  const MeshShape* mesh = nullptr;                // null: particles touch its closed form
  std::span<const kernels::Vector> from{}, to{};  // of a mesh: its vertices, in its coordinates
  double thickness = 0;                           // around its closed form, or its mesh
  double friction = 0;                            // with the cloth
};

/// The momentum that a body gave to the cloth, and its moment about the body's centre.
struct BodyImpulse {
  std::uint32_t id = 0;
  kernels::Vector linear{}, angular{};
  kernels::Vector centre{};  // where the step ends
};

class Bodies {
 public:
  /// Returns its id.
  std::uint32_t add(const Body& body);
  bool has(std::uint32_t id) const { return id < bodies_.size() && bodies_[id].shape != nullptr; }
  void remove(std::uint32_t id);
  /// Whether this changes something, as do those below.
  bool move(std::uint32_t id, const Pose& pose);
  bool place(std::uint32_t id, const Pose& pose);
  bool move_vertices(std::uint32_t id, std::span<const Vec3> to);
  bool place_vertices(std::uint32_t id, std::span<const Vec3> at);
  bool switch_on(std::uint32_t id, bool on);
  bool has_mass(std::uint32_t id) const { return bodies_[id].mass.mass > 0; }
  Pose pose(std::uint32_t id) const { return bodies_[id].from; }
  // The three below are for one with a mass.
  BodyVelocity velocity(std::uint32_t id) const;
  bool set_velocity(std::uint32_t id, const BodyVelocity& velocity);
  bool set_force(std::uint32_t id, Vec3 force, Vec3 moment);
  /// The number of vertices of a mesh, else 0.
  std::size_t vertices(std::uint32_t id) const;

  /// Those that are there; valid until one is changed. gaps: of the cloth.
  std::span<const TravellingBody> travelling(double friction_of_cloth, const Gaps& gaps);
  /// Those that are there and move by themselves, as above.
  std::span<const FreeBody> free(double friction_of_cloth);
  /// Where these have come to.
  void take(std::span<const FreeBody> free);
  /// m/s: no point of a body that moves by itself is faster.
  double fastest() const;
  /// Returns J, their kinetic energy.
  double bring_to_rest();
  /// They are taken along.
  void carry(const Turn& turned, kernels::Vector about, kernels::Vector to);
  /// The particles of the cloth are others: it is not known which of them touch.
  void forget_touching();
  /// Whether the gaps of the cloth tell how one of them is touched.
  bool ask_for_gaps() const;
  /// Whether there is one, on or off.
  bool any() const;
  /// Whether one of them is under way, or was in the last step, or there are other ones.
  bool moving() const;
  /// Whether one is there that was not in the last step, or was put elsewhere.
  bool are_others() const { return are_others_; }
  /// A step of dt was done.
  void arrive(std::span<const BodyImpulse> impulses, double dt);
  BodyLoad load(std::uint32_t id) const { return bodies_[id].load; }
  std::size_t bytes() const;
  friend void visit_fields(Is<Bodies> auto& part, auto& archive) {
    auto& [bodies, are_others, travelling, free] = part;  // the last two: made in each step
    archive(bodies, are_others);
  }
  /// Whether those that were read are bodies.
  bool are_valid() const;
  /// Whether there ever was one.
  bool were_any() const { return !bodies_.empty(); }

 private:
  struct Entry {
    std::shared_ptr<const BodyShape> shape;  // null: removed
    Pose from{}, to{};
    std::vector<kernels::Vector> vertices_from{}, vertices_to{};  // empty: those of the shape
    double thickness = 0, friction = 0;
    bool is_on = true, moves = false, deforms = false, moved = false;
    BodyLoad load{};
    BodyMass mass{};         // 0: it does not move by itself
    Vec3 force{}, moment{};  // by the caller
    FreeMotion motion{};     // with a mass

    /// Whether it is there and moves by itself.
    bool is_free() const { return shape != nullptr && is_on && mass.mass > 0; }

    friend void visit_fields(Is<Entry> auto& entry, auto& archive) {
      auto& [shape, from, to, vertices_from, vertices_to, thickness, friction, is_on, moves,
             deforms, moved, load, mass, force, moment, motion] = entry;
      archive(shape, from, to, vertices_from, vertices_to, thickness, friction, is_on, moves,
              deforms, moved, load, mass, force, moment, motion);
    }
  };
  static const MeshShape* mesh_of(const Entry& entry, const Gaps& gaps);
  static void put(Entry& entry, const Pose& pose);

  std::vector<Entry> bodies_;  // by id
  bool are_others_ = false;    // than in the last step
  std::vector<TravellingBody> travelling_;
  std::vector<FreeBody> free_;
};

}  // namespace weft
