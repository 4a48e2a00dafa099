/// Teams of the threads of an arena.
#pragma once

#include <tbb/task_arena.h>

#include <memory>

#include "engine/parallel/crew.h"

namespace weft::test {

/// In an arena of so many slots.
template <class Work>
void in_arena(int slots, Work&& work) {
  tbb::task_arena arena(slots);
  arena.execute(work);
}

/// work(team), by up to so many threads of the arena that this thread is in.
template <class Work>
void in_team_of_arena(int threads, Work&& work) {
  Team::SharedState shared;
  in_team(threads, shared, {}, std::make_shared<ArenaRun>(), work);
}

/// The same in an arena of its own, of as many slots.
template <class Work>
void in_team_of(int threads, Work&& work) {
  in_arena(threads, [&] { in_team_of_arena(threads, work); });
}

}  // namespace weft::test
