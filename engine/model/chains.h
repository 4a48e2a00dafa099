/// Whether the constraints of a model are chains and trees.
#pragma once

namespace weft {

class Model;

/// Whether few constraints close a loop: chains, trees, bridges (a third do; of a grid half do).
bool closes_few_loops(const Model& model);
/// By more than one fixed particle: it may be too short.
bool is_held_twice(const Model& model);

}  // namespace weft
