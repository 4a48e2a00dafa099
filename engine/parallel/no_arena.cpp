#include "engine/parallel/arena.h"

/// In place of arena.cpp where the library is built without oneTBB: there is no arena.
namespace weft {

int threads_of_arena() { return 1; }

void ArenaRun::run(const std::shared_ptr<ArenaRun>&, Job job, int) { job(); }

}  // namespace weft
