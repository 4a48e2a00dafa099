/// Pairs of features of two surfaces, a point and a triangle or two edges, drawn by chance: usual
/// ones, and all that are degenerate. Their distance by a way of its own.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "kernels/vectors.h"

namespace weft::test {

/// usual: of any shape, about as far apart as they are large.
/// touching: nearer to each other by a thousandth.
/// needle: a triangle whose height, or two edges whose angle, is small.
/// flat: a triangle without area, edges that are parallel.
/// lost: corners that coincide, a triangle or an edge that is a point.
/// met: features that meet, or share a corner.
enum class Form : std::uint8_t { usual, touching, needle, flat, lost, met };
inline constexpr std::array kForms{Form::usual, Form::touching, Form::needle,
                                   Form::flat,  Form::lost,     Form::met};
std::string text(Form form);

struct FeaturePair {
  bool edges = false;
  Form form = Form::usual;
  std::uint32_t seed = 0;
  std::array<kernels::Vector, 4> point{};  // a and the triangle b c d, or the edges a b and c d
};

/// Of a size of 1.
FeaturePair feature_pair(bool edges, Form form, std::uint32_t seed);

/// The least of the distances of their corners, edges and planes, whichever are beside each other.
double distance_of(const FeaturePair& pair);

}  // namespace weft::test
