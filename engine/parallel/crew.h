/// Threads that do many pieces of work together, large and small ones.
///
/// Every thread of a crew does the same: it takes the next piece that no thread has taken, large
/// ones first, and leads it, as the leader of a Team. When none is left it joins the team of a
/// large one that is under way, and then another, until all teams are full.
///
/// So it does not matter which thread comes first, nor whether others come at all: a single thread
/// does everything. No thread waits for one that has not come.
#pragma once

#include <weft/jobs.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "engine/parallel/arena.h"
#include "engine/parallel/team.h"

namespace weft {

/// The pieces.
class Pieces {
 public:
  virtual ~Pieces() = default;
  virtual std::size_t count() const = 0;
  /// How many threads it is worth, at least one. The same whenever it is asked.
  virtual int threads(std::size_t piece) const = 0;
  /// Whether it is to be done. Asked before work begins, and by the thread that takes the piece.
  virtual bool is_due(std::size_t piece) const = 0;
  /// The shared state of a large piece, for its team.
  virtual Team::SharedState& shared(std::size_t piece) = 0;
  /// Once for each piece, in any thread.
  virtual void lead(std::size_t piece, Team& team) noexcept = 0;
};

class Crew {
 public:
  /// Does all pieces. If the job system is the caller's arena, `arena` is the run shared with it:
  /// without one the calling thread works alone.
  static void work(Pieces& pieces, const JobSystem& jobs, const std::shared_ptr<ArenaRun>& arena);

 private:
  Crew(Pieces& pieces, int threads);
  int worth_of(std::size_t piece) const;
  void take_part();
  bool take(std::size_t& piece);
  void lead(std::size_t piece, std::atomic<Team::SharedState*>& open);
  void help_others();
  bool help_one();

  Pieces& pieces_;
  const int threads_;  // that there may be
  int wanted_ = 0;     // that there is work for
  const FloatControl rounding_;
  std::atomic<std::size_t> next_{0};      // of the large pieces; from count() on of the small ones
  std::atomic<std::size_t> unopened_{0};  // large pieces whose team has not been open yet
  std::atomic<std::size_t> comers_{0};
  std::array<std::atomic<Team::SharedState*>, Team::kMaxSize + 1> open_{};  // one of each comer
};

/// How many threads a job system has for its caller, from 1 to Team::kMaxSize.
int threads_of(const JobSystem& jobs);

/// work(team), led by any thread of the job system, in a team of up to so many.
template <class Work>
void in_team(int threads, Team::SharedState& shared, const JobSystem& jobs,
             const std::shared_ptr<ArenaRun>& arena, Work&& work) {
  struct OnePiece : Pieces {
    OnePiece(int of, Team::SharedState& to_share, Work& to_do)
        : threads_(of), shared_(to_share), work_(to_do) {}
    std::size_t count() const override { return 1; }
    int threads(std::size_t) const override { return threads_; }
    bool is_due(std::size_t) const override { return true; }
    Team::SharedState& shared(std::size_t) override { return shared_; }
    void lead(std::size_t, Team& team) noexcept override { work_(team); }
    int threads_;
    Team::SharedState& shared_;
    Work& work_;
  } piece(threads, shared, work);
  Crew::work(piece, jobs, arena);
}

}  // namespace weft
