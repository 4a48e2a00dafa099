/// An outside peer on the same scene: the soft body of Bullet, if it was there at build time
/// (Debian: libbullet-dev). bullet.cpp or bullet_absent.cpp is compiled, as CMake finds.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/studies/precision/task.h"

namespace weft::tools::precision {

/// Version and number format; empty: not built in.
std::string bullet_version();

/// Where its search ends: as tight as weft's own tolerances.
inline constexpr double kBulletTightest = 1e-5;

/// Its substeps and iterations, from those that keep a strain of 10 % to those that reach
/// kBulletTightest, the limit of time or 2000 iterations. Empty if not built in.
std::vector<Point> sweep_bullet(const Task& task, const Effort& effort, bool quick,
                                const std::function<void(const std::string&)>& watch);

}  // namespace weft::tools::precision
