/// The constraints that small steps solve along yarns. All others are blocks of their own.
///
/// A yarn pays where it carries a load that single constraints would pass on one by one. So chains
/// of few links are left out, and so are springs that others relieve: across the yarns of a woven
/// cloth run the diagonals of its cells, which are many times as soft. In a sheet of rigid edges
/// either all belong to yarns or, where chains are short on average, none does.
#pragma once

#include <cstdint>
#include <vector>

namespace weft {

class Model;

/// Distance constraints that are not at hubs, in the order of the model.
std::vector<std::uint32_t> constraints_of_yarns(const Model& model);

}  // namespace weft
