/// What an accepted input does when it is run.
#pragma once

#include <weft/weft.h>

namespace weft::fuzz {

/// Of short steps, so that what is tried is how a step begins and ends and not how it converges.
Settings brief_settings();

/// Steps twice. A step is refused in one line, or says truly whether it has changed the state,
/// which is finite then.
void step_twice(Cloth& cloth);

}  // namespace weft::fuzz
