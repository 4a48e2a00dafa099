/// Refused fields of a body, in one line each.
#pragma once

#include <weft/body.h>
#include <weft/result.h>

namespace weft {

Result<void> validate(const Body& body);
Result<void> validate(const Pose& pose);

}  // namespace weft
