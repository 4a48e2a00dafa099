/// What `weft precision` measured, as tables.
#pragma once

#include <string>

#include "tools/studies/precision/results.h"

namespace weft::tools::precision {

std::string points_csv(const Study& study);
std::string sizes_csv(const SizeStudy& study);

/// The cheapest ms per frame to each bound, for a page of documentation.
std::string to_markdown(const Study& study);

/// For a reader: the cheapest way to each bound, the orders, cost against size, and what failed.
std::string to_text(const Study& study);

}  // namespace weft::tools::precision
