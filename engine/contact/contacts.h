/// Contacts of the cloth with itself: constraints with multipliers, in lanes (the law stands in
/// kernels/reference/contacts.h).
///
/// Pairs that may touch in an interval are in blocks by colours. No point is twice in a colour, so
/// threads may do its blocks in any order. Pairs stay there until the frame ends or candidates are
/// renewed; the next interval adds pairs that are near by then. When a substep begins normals are
/// frozen, and multipliers of the last substep act again (warm start). After each sweep, rounds
/// visit pairs that touch.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/contact/contact_memory.h"
#include "engine/contact/features.h"
#include "engine/contact/known_multipliers.h"
#include "engine/contact/particles.h"
#include "engine/contact/points.h"
#include "engine/parallel/team.h"
#include "kernels/simd/contact_data.h"
#include "kernels/simd/table.h"

namespace weft {

/// A pair that may touch in an interval.
struct NearContact {
  Pair pair{};
  std::array<std::uint32_t, 4> points{};
  kernels::Vector normal{};  // from the second feature to the first
  double thickness = 0;      // m
  double distance = 0;       // m
};
/// The changes of an interval. A contact is named by how many were found before it since contacts
/// were last found anew.
struct NearContacts {
  bool anew = false;  // all others are forgotten
  std::vector<NearContact> found;
  std::vector<std::uint32_t> gone;  // names: they are found again if they are near
  /// Features of contacts that stay touch each other: places do not tell their normal.
  struct Touching {
    std::uint32_t name = 0;
    kernels::Vector normal{};
  };
  std::vector<Touching> touching;

  void clear() {
    found.clear();
    gone.clear();
    touching.clear();
  }
};

class Contacts {
 public:
  explicit Contacts(const simd::Table& table) : kernels_(*table.contacts) {}

  /// Begins a frame: multipliers begin with these, or with none.
  void begin(const ContactMemory* memory);
  /// Finds those of an interval. Found are contacts in any order that depends on the state alone.
  void find(const ContactPoints& points, const NearContacts& near);
  bool empty() const { return blocks_.empty(); }
  /// Where a substep of h is predicted. stands: positions are projected, and pairs that are near
  /// come out at once.
  void begin_substep(const ContactPoints& points, ContactParticles& particles, double h,
                     bool stands, Team& team);
  /// After a sweep come rounds, each of which visits all touching pairs. Between them bodies may
  /// move particles, too.
  void begin_rounds(ContactParticles& particles, Team& team);
  void round(ContactParticles& particles, Team& team);
  /// moved(slot, by): by how much (m) contacts have moved it.
  template <class Moved>
  void end_rounds(Moved&& moved) const;
  /// Solves the contacts at the slot. Returns whether something was moved.
  bool solve_at(ContactParticles& particles, std::uint32_t slot);
  /// The past of points that contacts have pushed is changed as their velocities were.
  void end_substep(ContactParticles& particles, Team& team);
  /// Writes the multipliers that the next frame begins with.
  void remember(ContactMemory& memory);
  int count_touching() const;
  /// Since this was last asked, in visits of a constraint.
  double take_visits() { return std::exchange(visits_, 0); }
  std::size_t bytes() const;

 private:
  static constexpr std::size_t kColours = 64;
  struct Colour {
    std::uint32_t first = 0, last = 0;  // blocks
    bool are_edges = false;             // or points beside triangles
  };
  /// A contact of a point that may push, in a list.
  struct Link {
    std::uint32_t slot = 0, contact = 0, next = 0;
  };
  enum class Known : std::uint8_t { no, beside, of_contact };  // a point of the cloth
  void clear();
  Multiplier multiplier(std::size_t contact) const;
  void set_multiplier(std::size_t contact, const Multiplier& to);
  void restore_multipliers();
  void gather_known();
  void retire(std::size_t contact);
  void find_known(std::span<const NearContact> near);
  std::size_t put_in_order(std::span<const NearContact> near);
  void know_points(const ContactPoints& points, std::span<const NearContact> near);
  void know(std::uint32_t slot, Known as);
  void colour(const ContactPoints& points, std::span<const NearContact> near, std::size_t first,
              std::size_t last, bool are_edges);
  void put_blocks(const ContactPoints& points, std::span<const NearContact> near,
                  std::span<const std::uint32_t> contacts, bool are_edges);
  void put(const ContactPoints& points, const NearContact& contact, std::size_t block,
           std::size_t lane);
  void set_normal(std::size_t contact, kernels::Vector normal);
  void leave_free(std::size_t block, std::size_t lane);
  void link_active();
  bool visit(ContactParticles& particles, std::size_t i);
  enum class Active : std::uint8_t { push, touch };
  void find_active(Active which, Team& team);
  void place(const ContactPoints& points, kernels::Vector x, std::uint32_t slot);
  void offset_slack_of_threads();
  void read_moves(const ContactParticles& particles);
  void write_moves(ContactParticles& particles);
  void visit_active(Team& team);
  void save_multipliers();
  void start_active();
  simd::ContactSolve solving() { return {blocks_.data(), moves_.data()}; }
  kernels::Vector move(std::size_t slot) const {
    return {double{moves_[4 * slot]}, double{moves_[4 * slot + 1]}, double{moves_[4 * slot + 2]}};
  }
  void set_move(std::size_t slot, kernels::Vector to) {
    moves_[4 * slot] = static_cast<float>(to.x);
    moves_[4 * slot + 1] = static_cast<float>(to.y);
    moves_[4 * slot + 2] = static_cast<float>(to.z);
  }
  double weight(std::size_t slot) const { return double{moves_[4 * slot + 3]}; }  // 1/kg

  const simd::ContactKernels& kernels_;
  kernels::AlignedVector<simd::ContactBlock> blocks_;
  std::vector<std::uint64_t> keys_;        // per block and lane; kNoKey: unused
  std::vector<std::uint32_t> of_threads_;  // blocks and lanes, likewise
  std::vector<Colour> colours_;
  std::vector<std::uint32_t> place_of_;  // per name: block and lane
  std::vector<std::uint32_t> points_;    // that contacts have
  std::vector<std::uint32_t> beside_;    // that faces beside contacts have
  // Per slot, of these:
  std::vector<Known> known_as_;
  std::vector<kernels::Vector> from_;             // where moves begin
  kernels::AlignedVector<float> places_, moves_;  // quads, and some for lanes that are not used
  std::vector<double> moved_by_;                  // m: in rounds
  std::vector<std::uint8_t> is_beside_body_;
  std::vector<std::uint32_t> first_link_;

  static constexpr std::uint16_t kMayAllBeActive = 0xffff;  // active_
  std::vector<std::uint16_t> active_;                       // per block, a bit per lane
  double active_count_ = 0;                                 // contacts
  std::vector<std::uint32_t> active_blocks_;
  std::vector<Colour> active_colours_;  // ranges of active_blocks_
  std::vector<Link> links_;
  bool are_linked_ = false;        // of the active blocks
  ContactMemory memory_;           // while nothing was found in this frame
  KnownMultipliers known_;         // scratch
  bool are_saved_ = false;         // positions are mended: these multipliers are no forces
  std::vector<Multiplier> saved_;  // per block and lane
  std::vector<const Multiplier*> known_at_;         // scratch: per near contact; null: none
  std::vector<std::uint8_t> bins_;                  // likewise
  std::vector<std::uint32_t> order_;                // scratch: of near contacts
  std::vector<std::uint64_t> taken_;                // scratch: colours, per slot
  std::vector<std::uint32_t> waiting_, by_colour_;  // scratch: near contacts
  std::vector<std::uint8_t> colour_of_;             // likewise, per contact that waits
  double give_ = 0;        // s^2: (b h)^2 of the substep that multipliers are of
  bool is_begun_ = false;  // a substep
  double visits_ = 0;
};

template <class Moved>
void Contacts::end_rounds(Moved&& moved) const {
  for (const std::uint32_t slot : points_)
    if (moved_by_[slot] > 0) moved(slot, moved_by_[slot]);
}

}  // namespace weft
