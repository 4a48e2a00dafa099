/// What every ordering must keep to.
#pragma once

#include <span>
#include <string>

#include "engine/ordering/ordering.h"

namespace weft::test {

/// The first rule that the ordering breaks, in words; empty if it keeps to all of them.
std::string fault_of(const Ordering& ordering, std::span<const Link> links, std::size_t particles);

}  // namespace weft::test
