#include "tools/studies/precision/bullet.h"

namespace weft::tools::precision {

std::string bullet_version() { return {}; }

std::vector<Point> sweep_bullet(const Task&, const Effort&, bool,
                                const std::function<void(const std::string&)>&) {
  return {};
}

}  // namespace weft::tools::precision
