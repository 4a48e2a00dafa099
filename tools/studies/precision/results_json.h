/// The JSON of `weft precision`: all runs, peers apart, the cheapest settings, cost against size.
#pragma once

#include "tools/program/files/json_output.h"
#include "tools/studies/precision/results.h"

namespace weft::tools::precision {

Json to_json(const Study& study);

}  // namespace weft::tools::precision
